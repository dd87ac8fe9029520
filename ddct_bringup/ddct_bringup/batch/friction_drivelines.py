# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Drivelines of many runs with dry friction."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ddct_bringup.batch.motions import Forcing, Motions
from ddct_bringup.batch.stacks import stacked
from ddct_plant.base.timebase import time_of_step
from ddct_plant.friction.driveline import FrictionDriveline, phase_of
from ddct_plant.friction.engagements import ON_COMING, WHEEL
from ddct_plant.models.driveline import DrivelineOutputs, PhaseEvent
from ddct_plant.models.initial_state import InitialState
from ddct_plant.scenario.plant import engagements
from ddct_plant.scenario.scenario import Scenario

_LOCKED, _SLIPPING, _OPEN = phase_of(0, 0.0), phase_of(1, 1.0), phase_of(1, 0.0)
RunEvents = dict[int, tuple[PhaseEvent, ...]]
"""Events of a clutch in a period, in the order of time, by the index of their run."""


class FrictionDrivelines:
    """Drivelines of R runs with one clutch, the counterpart of `FrictionDriveline`."""

    def __init__(self, scenarios: Sequence[Scenario], initial: Sequence[InitialState]) -> None:
        """Start in the initial states; raise ParameterError as `EngagedGears` does."""
        self._parameters = stacked([scenario.driveline for scenario in scenarios])
        self._wheel_radius: Any = np.array([each.vehicle.wheel_radius_m for each in scenarios])
        engaged = [engagements(scenario)[0] for scenario in scenarios]
        starts = [
            FrictionDriveline(gears, scenario.vehicle, state)
            for gears, scenario, state in zip(engaged, scenarios, initial, strict=True)
        ]
        self._motions = Motions(
            [gears.integrator for gears in engaged], [each.now for each in starts]
        )
        self._phase = np.array([each.outputs().clutch_phase for each in starts])
        torques = [(each.engine_torque, each.load_torque) for each in initial]
        self._inputs = np.array(torques)
        self._steps = 0

    @property
    def failed(self) -> np.ndarray:
        """Runs that could not be integrated, (R,)."""
        return self._motions.failed

    def outputs(self) -> Any:
        """Return `DrivelineOutputs` at the present step, each value (R,), without events."""
        now = self._motions
        state: Any = now.state.T
        engine_torque, load_torque = self._inputs.T
        torques: Any = (
            engine_torque,
            now.friction[:, ON_COMING],
            load_torque + now.friction[:, WHEEL],
        )
        phase: Any = self._phase
        work: Any = now.work[:, ON_COMING]
        found: Any = DrivelineOutputs.of_state(
            self._parameters,
            self._wheel_radius,
            state,
            torques,
            clutch_phase=phase,
            friction_work=work,
        )
        slip = np.where(now.signs[:, ON_COMING] == 0, 0.0, found.slip_speed)
        accel = np.where(now.signs[:, WHEEL] == 0, 0.0, found.vehicle_accel)
        return found._replace(slip_speed=slip, vehicle_accel=accel)

    @property
    def phase_events(self) -> dict[str, RunEvents]:
        """Events in the last period, by the name of their signal."""
        return {'phase_events': events_of(self._motions, ON_COMING, self._steps)}

    def step(
        self,
        running: np.ndarray,
        engine_torque: np.ndarray,
        load_torque: np.ndarray,
        holding_torque: np.ndarray,
        kinetic_torque: np.ndarray,
        static_torque: np.ndarray,
    ) -> None:
        """
        Advance the runs of a mask (R,) by 10 ms, with the arguments of `FrictionDriveline.step`.

        The torques are (R,), those of the clutches (R, 11), all in N m.
        """
        self._inputs = np.stack([engine_torque, load_torque], axis=-1)
        holding = holding_torque[:, np.newaxis]
        kinetic = np.hstack([kinetic_torque, holding])
        static = kinetic
        if static_torque is not kinetic_torque:
            static = np.hstack([static_torque, holding])
        self._motions.advance(Forcing(self._inputs, kinetic, static), running)
        self._phase = phases_of(self._motions.signs[:, ON_COMING], kinetic_torque[:, -1])
        self._steps += 1


def events_of(motions: Motions, element: int, step: int) -> RunEvents:
    """Return the events of an element in the period before a step, by the index of their run."""
    start_s = time_of_step(step - 1)
    return {
        run: tuple(
            PhaseEvent(start_s + event.time_s, event.kind, event.slip_acceleration)
            for event in events
            if event.element == element
        )
        for run, events in motions.events.items()
    }


def phases_of(signs: np.ndarray, capacities: np.ndarray) -> np.ndarray:
    """Return the indices in PHASES as `phase_of` does, (R,)."""
    slipping = np.where(capacities != 0.0, _SLIPPING, _OPEN)
    return np.where(signs == 0, _LOCKED, slipping)
