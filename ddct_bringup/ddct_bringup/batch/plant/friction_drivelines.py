# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Drivelines of many runs with dry friction: one clutch or two, and the wheels."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ddct_bringup.batch.plant.motions import Motions, StackedForcing
from ddct_bringup.batch.plant.tie_ups import TieUps
from ddct_bringup.batch.stacks import stacked
from ddct_plant.base.timebase import time_of_step
from ddct_plant.friction.driveline import FrictionDriveline, phase_of
from ddct_plant.friction.engagements import (
    OFF_GOING,
    ON_COMING,
    SHIFT_STATES,
    WHEEL,
    EngagedGears,
)
from ddct_plant.models.driveline import DrivelineOutputs, OffGoingOutputs, PhaseEvent
from ddct_plant.models.driveline_model import STATES_AND_ANGLES
from ddct_plant.models.initial_state import InitialState
from ddct_plant.scenario.plant import engagements
from ddct_plant.scenario.scenario import Scenario


class Engaged:
    """
    Gears that are engaged in R runs of one kind, the counterpart of `EngagedGears`.

    Each of the values is one of the states times a factor, and the other way round.
    """

    def __init__(self, engaged: Sequence[EngagedGears]) -> None:
        """Take the engaged gears of each run."""
        one, names = engaged[0], SHIFT_STATES if engaged[0].clutches > 1 else STATES_AND_ANGLES
        size = len(one.integrator.system.a)
        self._of_state = _places_and_factors([each.to_values for each in engaged], size)
        self._of_value = _places_and_factors([each.of_values for each in engaged], len(names))
        self._gear, self._turning = stacked([each.gear for each in engaged]), one.turning

    def values(self, state: np.ndarray) -> np.ndarray:
        """Return the values for states (R, n): of STATES_AND_ANGLES, in a shift SHIFT_STATES."""
        places, factors = self._of_state
        values: np.ndarray = state[:, places] * factors
        return values

    def states(self, values: np.ndarray) -> np.ndarray:
        """Return the states (R, n) for the values."""
        places, factors = self._of_value
        states: np.ndarray = values[:, places] * factors
        return states

    def gear_speed(self, values: np.ndarray) -> np.ndarray:
        """Return the speeds in rad/s of the driveshafts' inner ends, (R,)."""
        speed: np.ndarray = self._gear.wheel_speed(values[:, self._turning])
        return speed


def _places_and_factors(
    functions: Sequence[Callable[[list[float]], list[float]]], size: int
) -> tuple[np.ndarray, np.ndarray]:
    """
    Return which of `size` numbers each result of some functions is, (m,), and the factors (R, m).

    The functions are those of R runs, which choose the same numbers.
    """
    first = functions[0](np.arange(1.0, size + 1.0).tolist())
    ones = np.array([function([1.0] * size) for function in functions])
    places = np.rint(np.array(first) / ones[0]).astype(int) - 1
    return places, ones


_ENGINE, _SHAFT = STATES_AND_ANGLES.places('engine_speed', 'shaft_speed')
_OTHER, _OTHER_ANGLE = SHIFT_STATES.places('off_going_speed', 'off_going_angle')
_OF_DRIVELINE = slice(0, len(STATES_AND_ANGLES))
_LOCKED, _SLIPPING, _OPEN = phase_of(0, 0.0), phase_of(1, 1.0), phase_of(1, 0.0)
RunEvents = dict[int, tuple[PhaseEvent, ...]]
"""Events of a clutch in a period, in the order of time, by the index of their run."""


class FrictionDrivelines:
    """
    Drivelines of R runs, the counterpart of `FrictionDriveline`, all with one clutch or with two.

    Shifts have their gears engaged and disengaged at the same steps.
    """

    def __init__(self, scenarios: Sequence[Scenario], initial: Sequence[InitialState]) -> None:
        """Start in the initial states; raise ParameterError as `EngagedGears` does."""
        self._parameters = stacked([scenario.driveline for scenario in scenarios])
        self._wheel_radius: Any = np.array([each.vehicle.wheel_radius_m for each in scenarios])
        engaged, changes = zip(*map(engagements, scenarios), strict=True)
        self._changes = {step: [each[step] for each in changes] for step in changes[0]}
        starts = [
            FrictionDriveline(gears, scenario.vehicle, state)
            for gears, scenario, state in zip(engaged, scenarios, initial, strict=True)
        ]
        self._take(engaged)
        self._motions = Motions(
            [gears.integrator for gears in engaged],
            [each.now for each in starts],
            keep=self._tie_ups is not None,
        )
        outputs = [each.outputs() for each in starts]
        phases = [[each.clutch_phase for each in outputs]]
        if self._tie_ups:
            phases.append([each.off_going.clutch_phase for each in outputs if each.off_going])
        self._phases = np.array(phases)
        self._inputs = np.array([(each.engine_torque, each.load_torque) for each in initial])
        self._tie_up_work: Any = np.zeros(len(scenarios)) if self._tie_ups else None
        self._steps = 0

    def _take(self, engaged: Sequence[EngagedGears]) -> None:
        self._engaged = Engaged(engaged)
        self._tie_ups = TieUps(engaged) if engaged[0].clutches > 1 else None

    @property
    def failed(self) -> np.ndarray:
        """Runs that could not be integrated, (R,)."""
        return self._motions.failed

    def outputs(self) -> Any:
        """Return `DrivelineOutputs` at the present step, each value (R,), without events."""
        now: Any = self._motions
        values: Any = self._engaged.values(now.state)
        engine_torque, load_torque = self._inputs.T
        torques: Any = (
            engine_torque,
            now.friction[:, ON_COMING],
            load_torque + now.friction[:, WHEEL],
        )
        phase: Any = self._phases[ON_COMING]
        gear_speed: Any = self._engaged.gear_speed(values)
        found: Any = DrivelineOutputs.of_state(
            self._parameters,
            self._wheel_radius,
            values[:, _OF_DRIVELINE].T,
            torques,
            clutch_phase=phase,
            friction_work=now.work[:, ON_COMING],
            gear_speed=gear_speed,
            off_going=self._off_going(values) if self._tie_ups else None,
            tie_up_work=self._tie_up_work,
        )
        slip = np.where(now.signs[:, ON_COMING] == 0, 0.0, found.slip_speed)
        accel = np.where(now.signs[:, WHEEL] == 0, 0.0, found.vehicle_accel)
        return found._replace(slip_speed=slip, vehicle_accel=accel)

    def _off_going(self, values: Any) -> OffGoingOutputs:
        now: Any = self._motions
        slip: Any = values[:, _ENGINE] - values[:, _OTHER]
        slip = np.where(now.signs[:, OFF_GOING] == 0, 0.0, slip)
        phase: Any = self._phases[OFF_GOING]
        return OffGoingOutputs(
            values[:, _OTHER_ANGLE],
            values[:, _OTHER],
            now.friction[:, OFF_GOING],
            slip,
            phase,
            now.work[:, OFF_GOING],
            (),
        )

    @property
    def phase_events(self) -> dict[str, RunEvents]:
        """Events in the last period, by the name of their signal."""
        events = {'phase_events': events_of(self._motions, ON_COMING, self._steps)}
        if self._tie_ups:
            of_other = events_of(self._motions, OFF_GOING, self._steps)
            events['off_going_phase_events'] = of_other
        return events

    def step(
        self,
        running: np.ndarray,
        engine_torque: np.ndarray,
        load_torque: np.ndarray,
        holding_torque: np.ndarray,
        *capacities: np.ndarray,
    ) -> None:
        """
        Advance the runs of a mask (R,) by 10 ms, with the arguments of `FrictionDriveline.step`.

        The torques are (R,), the kinetic and static `capacities` of each clutch (R, 11), in N m.
        """
        now, holding = self._motions, holding_torque[:, np.newaxis]
        self._inputs = np.stack([engine_torque, load_torque], axis=-1)
        kinetics, statics = capacities[::2], capacities[1::2]
        kinetic = static = np.hstack([*kinetics, holding])
        if any(one is not other for one, other in zip(kinetics, statics, strict=True)):
            static = np.hstack([*statics, holding])
        forcing = StackedForcing(self._inputs, kinetic, static)
        before = now.state.copy(), now.signs.copy()
        now.advance(forcing, running)
        if self._tie_ups:
            going = running & ~now.failed
            self._tie_up_work = self._tie_ups.work(*before, forcing, now.eventful, going)
        self._phases = np.array(
            [phases_of(now.signs[:, place], each[:, -1]) for place, each in enumerate(kinetics)]
        )
        self._steps += 1
        if self._steps in self._changes:
            self._engage(self._changes[self._steps])

    def _engage(self, new: Sequence[EngagedGears]) -> None:
        """Go over to other engaged gears at the present step."""
        now, before = self._motions, self._engaged.values(self._motions.state)
        self._take(new)
        state = self._engaged.states(before)
        after = self._engaged.values(state)
        changed = after[:, _SHAFT] != before[:, _SHAFT]
        slips = np.sign(after[:, _ENGINE] - after[:, _SHAFT]).astype(int)
        now.signs[:, ON_COMING] = np.where(changed, slips, now.signs[:, ON_COMING])
        now.take([gears.integrator for gears in new], state)


def events_of(motions: Motions, element: int, step: int) -> RunEvents:
    """Return the events of an element in the period before a step, by the index of their run."""
    start_s = time_of_step(step - 1)
    return {
        run: tuple(
            PhaseEvent(start_s + event.time_s, event.kind, event.slip_acceleration)
            for event in period.events
            if event.element == element
        )
        for run, period in motions.eventful.items()
    }


def phases_of(signs: np.ndarray, capacities: np.ndarray) -> np.ndarray:
    """Return the indices in PHASES as `phase_of` does, (R,)."""
    slipping = np.where(capacities != 0.0, _SLIPPING, _OPEN)
    return np.where(signs == 0, _LOCKED, slipping)
