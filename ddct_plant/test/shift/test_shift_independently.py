# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Whole shifts in closed loop against an integration by another method, with tight tolerances."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
import scipy
from samples import sampled
from shifts import Law, Sample, run, shift_settings

from ddct_plant.base.timebase import PERIOD_S, SUBSTEP_S, SUBSTEPS
from ddct_plant.models.actuator import Actuator
from ddct_plant.models.driveline import DrivelineOutputs
from ddct_plant.models.load import HoldingTorque, RoadLoad, air_and_slope
from ddct_plant.plant import Plant, PlantReply
from ddct_plant.scenario.initial_state import initial_request, initial_state
from ddct_plant.scenario.plant import OPEN_BELOW
from ddct_plant.scenario.rules.shift import gears_of
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.shift.roles import OFF_GOING

TOLERANCE = 1e-12
State = Sequence[float] | np.ndarray
"""The states as numbers of Python, or as the integrator passes them."""
Pair = tuple[float, float]
"""A number of the on-coming and of the off-going clutch."""
NEAR = 1e-9
"""Slip in rad/s that counts as zero at an event."""


class Independent:
    """
    A shift by the Dormand-Prince method of order 8, with the equations at the gear output.

    States: w_m, w_g, w_r, theta_sr, tie-up work. Each clutch slips with a sign, or sticks, and
    then a torque that keeps its slip's acceleration zero replaces its capacity. The wheels roll
    forward.
    """

    def __init__(self, settings: RunSettings) -> None:
        scenario = settings.scenario
        start = initial_state(settings)
        self.parameters = scenario.driveline
        gears = scenario.driveline.gear, gears_of(scenario).off_going
        self.ratios = [gear.total_ratio for gear in gears]
        self.squares = sum(ratio**2 for ratio in self.ratios)
        self.gear_inertia = self.parameters.shaft_inertia * self.squares
        self.state = np.array(
            [start.engine_speed, start.wheel_speed, start.wheel_speed, start.twist, 0.0]
        )
        self.signs = [1, 0]
        self.load = 0.0
        self.capacities = [[0.0] * (SUBSTEPS + 1)] * 2

    def slip(self, i: int, state: State) -> float:
        return state[0] - self.ratios[i] * state[1]

    def limit(self, i: int, time: float) -> float:
        """Return the capacity of a clutch, which is linear between the nodes of the period."""
        piece = min(int(time / SUBSTEP_S), SUBSTEPS - 1)
        before, after = self.capacities[i][piece : piece + 2]
        return before + (time / SUBSTEP_S - piece) * (after - before)

    def torques(self, time: float, state: State, engine: float, load: float) -> Pair:
        """Return the torques of both clutches at a time in the period."""
        on, off = (sign and sign * self.limit(i, time) for i, sign in enumerate(self.signs))
        if 0 not in self.signs:
            return on, off
        stuck = self.signs.index(0)
        free = self.slope_of(state, (on, off), engine, load)
        ratio = self.ratios[stuck]
        mobility = 1.0 / self.parameters.engine_inertia + ratio**2 / self.gear_inertia
        torque = (free[0] - ratio * free[1]) / mobility
        return (torque, off) if stuck == 0 else (on, torque)

    def slope_of(self, state: State, torques: Pair, engine: float, load: float) -> list[float]:
        # In numbers of Python: arrays of two or four take several times as long.
        p = self.parameters
        speed, gear, wheel, twist, _ = state
        shaft = p.halfshaft_damping * (gear - wheel) + p.halfshaft_stiffness * twist
        driving = self.ratios[0] * torques[0] + self.ratios[1] * torques[1]
        return [
            (engine - p.engine_damping * speed - sum(torques)) / p.engine_inertia,
            (driving - shaft - p.shaft_damping * self.squares * gear) / self.gear_inertia,
            (shaft - load) / p.vehicle_inertia,
            gear - wheel,
            self.tie_up_power(gear, torques),
        ]

    def tie_up_power(self, gear: float, torques: Pair) -> float:
        """Return what the smaller of two opposing torques takes from the wheels."""
        if torques[0] * torques[1] >= 0.0:
            return 0.0
        return min(map(abs, torques)) * abs(gear * (self.ratios[1] - self.ratios[0]))

    def advance(self, engine: float, load: float) -> None:
        """Integrate 10 ms, piece by piece between the nodes of the capacities."""
        for piece in range(SUBSTEPS):
            now, end = piece * SUBSTEP_S, (piece + 1) * SUBSTEP_S
            while now < end:
                now = self._to_event(now, end, engine, load)

    def _to_event(self, now: float, end: float, engine: float, load: float) -> float:
        def slope(time: float, state: np.ndarray) -> list[float]:
            now = state.tolist()
            return self.slope_of(now, self.torques(time, now, engine, load), engine, load)

        def guard(i: int) -> Any:
            def slipping(time: float, state: np.ndarray) -> float:
                return self.signs[i] * self.slip(i, state)

            def sticking(time: float, state: np.ndarray) -> float:
                return self.limit(i, time) - abs(self.torques(time, state, engine, load)[i])

            found: Any = slipping if self.signs[i] else sticking
            found.terminal, found.direction = True, -1.0
            return found

        done = scipy.integrate.solve_ivp(
            slope,
            (now, end),
            self.state,
            'DOP853',
            events=[guard(0), guard(1)],
            rtol=TOLERANCE,
            atol=TOLERANCE,
        )
        assert done.success
        self.state = done.y[:, -1]
        if done.status == 1:
            which = 0 if done.t_events[0].size else 1
            self._choose(which, float(done.t[-1]), engine, load)
            return float(done.t[-1])
        return end

    def _choose(self, which: int, time: float, engine: float, load: float) -> None:
        """Choose the mode of an element at the end of its present one."""
        if self.signs[which] == 0:
            torque = self.torques(time, self.state, engine, load)[which]
            self.signs[which] = 1 if torque > 0.0 else -1
            return
        before = self.signs[which]
        assert abs(self.slip(which, self.state)) < NEAR
        self.signs[which] = 0
        torque = self.torques(time, self.state, engine, load)[which]
        if abs(torque) > self.limit(which, time):
            self.signs[which] = -before


def shift_by_the_other_method(settings: RunSettings) -> tuple[np.ndarray, np.ndarray]:
    """
    Return a shift in closed loop.

    They are the speeds of engine, gear output and wheels, (N + 1, 3), and the tie-up work until
    each step, (N + 1,).
    """
    scenario = settings.scenario
    other = Independent(settings)
    first = initial_request(settings.known, OFF_GOING)
    law = Law(settings, first)
    actuators = Actuator(0.0), Actuator(first)
    road = air_and_slope(scenario.load, scenario.vehicle)
    holding = HoldingTorque(RoadLoad(scenario.load, scenario.vehicle), scenario.brake)
    engine = scenario.demand.torque_n_m[0]
    states = [other.state]
    resisting = road.torque(other.state[2] * scenario.vehicle.wheel_radius_m) + holding.capacity(0)
    for step in range(scenario.steps):
        slip = 0.0 if other.signs[0] == 0 else float(other.slip(0, other.state))
        shaft = float(other.ratios[0] * other.state[1])
        sample = Sample(slip, float(other.state[0]), shaft, engine, resisting)
        requests = law.requests(step, sample)
        nodes = [each.update(x) for each, x in zip(actuators, requests, strict=True)]
        pressed = np.array(nodes)
        other.capacities = np.where(pressed > OPEN_BELOW, np.minimum(pressed, 350.0), 0.0).tolist()
        vehicle_speed = float(other.state[2]) * scenario.vehicle.wheel_radius_m
        resisting = road.torque(vehicle_speed) + holding.capacity(step * PERIOD_S)
        other.advance(engine, resisting)
        states.append(other.state)
    found = np.array(states)
    return found[:, :3], found[:, -1]


@pytest.mark.parametrize('name', sampled(['upshift', 'upshift_2_3'], every=2))
def test_a_whole_shift_and_its_tie_up_are_within_1e_9_of_another_integration(name):
    settings = shift_settings(name)
    found: list[list[float]] = []
    works: list[float] = []
    kinds: list[str] = []

    def tick(step: int, plant: Plant, outputs: DrivelineOutputs, reply: PlantReply) -> None:
        speeds = outputs.joint_speed
        gear = gears_of(settings.scenario).off_going.wheel_speed(outputs.off_going.shaft_speed)
        found.append([speeds.engine, gear, speeds.wheel])
        works.append(outputs.tie_up_work)
        kinds.extend(event.kind for event in outputs.phase_events)
        kinds.extend(f'off {event.kind}' for event in outputs.off_going.phase_events)

    run(settings, tick)
    expected, expected_work = shift_by_the_other_method(settings)
    assert {'lock', 'off release'} <= set(kinds)
    scale = np.abs(expected).max(axis=0)
    assert (np.abs(np.array(found) - expected) / scale).max() < 1e-9
    assert expected_work[-1] > 1.0
    assert np.abs(np.cumsum(works) - expected_work).max() < 1e-9
