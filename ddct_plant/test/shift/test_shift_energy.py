# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The energy of a whole shift: what the engine gives is stored, lost in friction or in dampers."""

import itertools
from typing import Any

import numpy as np
import pytest
from samples import sampled
from shifts import SHIFTS, run, shift_settings

from ddct_plant.base.timebase import SUBSTEP_S, SUBSTEPS
from ddct_plant.friction.driveline import FrictionDriveline
from ddct_plant.hybrid.friction_system import Forcing, IntervalLayout
from ddct_plant.hybrid.interval_map import Event, Interval
from ddct_plant.models.driveline import DrivelineOutputs
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.plant import Plant, PlantReply

LAYOUT = IntervalLayout(2, 3, SUBSTEPS, (0, 1, 4))


def square_integrals(rows: np.ndarray, states: np.ndarray, part: float) -> np.ndarray:
    """Return the integrals over t from 0 to `part` of (row x(t))^2, x with powers `states`."""
    powers = rows @ states.T
    squares = np.array([np.convolve(each, each) for each in powers])
    exponents = np.arange(1, squares.shape[1] + 1)
    return squares @ (part**exponents / exponents)


def mode_after(signs: tuple[int, ...], event: Event, last: tuple[int, ...]) -> tuple[int, ...]:
    """
    Return the mode after an event.

    A release has the sign of its slip acceleration; where equal capacities make that zero, it has
    the sign at the end of the period, `last`.
    """
    acceleration = event.slip_acceleration
    released = int(np.sign(acceleration)) or last[event.element]
    new = {'lock': 0, 'reverse': -signs[event.element], 'release': released}
    changed = list(signs)
    changed[event.element] = new[event.kind]
    return tuple(changed)


class Ledger:
    """Energies of a run in J, summed period by period."""

    def __init__(self, parameters: DrivelineParameters) -> None:
        self._parameters = parameters
        self.engine = self.load = self.dampers = 0.0
        self.friction = np.zeros(3)

    def stored(self, outputs: DrivelineOutputs) -> float:
        """Return kinetic and elastic energy."""
        p = self._parameters
        inertias = np.array(
            [p.engine_inertia, p.shaft_inertia, p.vehicle_inertia, p.shaft_inertia]
        )
        speeds = np.array([*outputs.joint_speed[:3], outputs.off_going.shaft_speed])
        elastic = p.halfshaft_stiffness * outputs.twist**2
        return float(inertias @ speeds**2 + elastic) / 2.0

    def add(
        self,
        driveline: Any,
        before: Interval,
        engaged: Any,
        reply: PlantReply,
        angles: np.ndarray,
    ) -> None:
        """Add the period that `reply` drove, from the state `before` it."""
        after = driveline.now
        self.engine += reply.engine_torque * angles[0]
        self.load += reply.load_torque * angles[1]
        holding, kinetic, static, other_kinetic, other_static = reply.friction_torques
        self.friction += after.work
        capacities = [
            [*kinetic, *other_kinetic, holding],
            [*static, *other_static, holding],
        ]
        forcing = Forcing(LAYOUT, [reply.engine_torque, reply.load_torque], *capacities)
        self.dampers += self._dissipated(engaged, before, forcing, after)

    def _dissipated(
        self, engaged: Any, before: Interval, forcing: Forcing, after: Interval
    ) -> float:
        """Return the damper work of a period, from the polynomials between its events."""
        p, flows = self._parameters, engaged.integrator.flows
        size = len(before.state)
        shift = np.array([engaged.to_values(row) for row in np.eye(size)]).T
        gear = engaged.gear.wheel_speed(shift[engaged.turning])
        rows = np.array([shift[0], shift[1], shift[7], gear - shift[2]])
        dampers = [p.engine_damping, p.shaft_damping, p.shaft_damping, p.halfshaft_damping]
        state, signs, total = np.array(before.state), before.signs, 0.0
        times = [event.time_s / SUBSTEP_S for event in after.events]
        now, pending = 0.0, list(zip(times, after.events, strict=True))
        while now < SUBSTEPS:
            piece = int(now)
            end = min(piece + 1.0, pending[0][0]) if pending else piece + 1.0
            course = flows[signs].course(state, forcing.at(signs, piece, now - piece))
            lost = square_integrals(rows, course.states, end - now)
            total += SUBSTEP_S * float(np.dot(dampers, lost))
            state, now = course.at(end - now), end
            while pending and pending[0][0] <= now:
                signs = mode_after(signs, pending.pop(0)[1], after.signs)
        return total


@pytest.mark.parametrize(
    ('name', 'keys'),
    sampled(
        itertools.product(SHIFTS, [{}, {'preselection_s': 0.2, 'disengagement_s': 1.0}]), every=3
    ),
)
def test_the_engine_work_is_stored_or_lost_in_friction_dampers_and_load(name, keys):
    settings = shift_settings(name, **keys)
    ledger = Ledger(settings.scenario.driveline)
    stored: list[float] = []
    last: list[Any] = []

    def tick(step: int, plant: Plant, outputs: DrivelineOutputs, reply: PlantReply) -> None:
        angles = np.array(outputs.joint_position)[[0, 2]]
        driveline: Any = plant.driveline
        if last:
            before, engaged, earlier, start = last
            ledger.add(driveline, before, engaged, earlier, angles - start)
        last[:] = [driveline.now, driveline._engaged, reply, angles]
        stored.append(ledger.stored(outputs))

    plant = run(settings, tick)
    assert len(stored) == settings.scenario.steps + 1
    gained = stored[-1] - stored[0] - plant.driveline.synchronising_work
    lost = [*ledger.friction, ledger.dampers, ledger.load]
    terms = [ledger.engine, gained, *lost]
    assert ledger.friction[0] > 1000.0
    assert ledger.dampers > 1.0
    assert ledger.engine - gained - sum(lost) == pytest.approx(0.0, abs=1e-9 * max(terms))
    assert isinstance(plant.driveline, FrictionDriveline)
