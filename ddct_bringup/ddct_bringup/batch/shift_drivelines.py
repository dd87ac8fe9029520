# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Drivelines of many shifts: two clutches, and gears that are engaged at given steps."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ddct_bringup.batch.friction_drivelines import RunEvents, events_of, phases_of
from ddct_bringup.batch.motions import Forcing, Motions
from ddct_bringup.batch.stacks import by_run, distinct, product, stacked
from ddct_bringup.batch.tie_ups import TieUps
from ddct_plant.friction.driveline import FrictionDriveline
from ddct_plant.friction.engagements import (
    OFF_GOING,
    ON_COMING,
    SHIFT_STATES,
    WHEEL,
    EngagedGears,
)
from ddct_plant.models.driveline import DrivelineOutputs, OffGoingOutputs
from ddct_plant.models.driveline_model import STATES_AND_ANGLES
from ddct_plant.models.initial_state import InitialState
from ddct_plant.scenario.plant import engagements
from ddct_plant.scenario.scenario import Scenario

_ENGINE, _SHAFT = SHIFT_STATES.places('engine_speed', 'shaft_speed')
_OTHER, _OTHER_ANGLE = SHIFT_STATES.places('off_going_speed', 'off_going_angle')
_OF_DRIVELINE = slice(0, len(STATES_AND_ANGLES))


class ShiftDrivelines:
    """
    Drivelines of R shifts, the counterpart of `FrictionDriveline` with two clutches.

    Their gears are engaged and disengaged at the same steps.
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
        self._engaged = _Engaged(engaged)
        self._motions = Motions(
            [gears.integrator for gears in engaged], [each.now for each in starts]
        )
        outputs = [each.outputs() for each in starts]
        off_going = [each.off_going for each in outputs if each.off_going is not None]
        self._phases = np.array(
            [
                [each.clutch_phase for each in outputs],
                [each.clutch_phase for each in off_going],
            ]
        )
        self._inputs = np.array([(each.engine_torque, each.load_torque) for each in initial])
        self._tie_up_work: Any = np.zeros(len(scenarios))
        self._steps = 0

    @property
    def failed(self) -> np.ndarray:
        """Runs that could not be integrated, (R,)."""
        return self._motions.failed

    def outputs(self) -> Any:
        """Return `DrivelineOutputs` at the present step, each value (R,), without events."""
        now: Any = self._motions
        values: Any = self._engaged.values(now.state)
        engine_torque, load_torque = self._inputs.T
        friction, work = now.friction.T, now.work.T
        sticks = now.signs == 0
        torques: Any = engine_torque, friction[ON_COMING], load_torque + friction[WHEEL]
        phases: Any = self._phases
        gear_speed: Any = self._engaged.gear_speed(values)
        slip: Any = np.where(sticks[:, OFF_GOING], 0.0, values[:, _ENGINE] - values[:, _OTHER])
        off_going: Any = OffGoingOutputs(
            values[:, _OTHER_ANGLE],
            values[:, _OTHER],
            friction[OFF_GOING],
            slip,
            phases[OFF_GOING],
            work[OFF_GOING],
            (),
        )
        found: Any = DrivelineOutputs.of_state(
            self._parameters,
            self._wheel_radius,
            values[:, _OF_DRIVELINE].T,
            torques,
            clutch_phase=phases[ON_COMING],
            friction_work=work[ON_COMING],
            gear_speed=gear_speed,
            off_going=off_going,
            tie_up_work=self._tie_up_work,
        )
        slip = np.where(sticks[:, ON_COMING], 0.0, found.slip_speed)
        accel = np.where(sticks[:, WHEEL], 0.0, found.vehicle_accel)
        return found._replace(slip_speed=slip, vehicle_accel=accel)

    @property
    def phase_events(self) -> dict[str, RunEvents]:
        """Events in the last period, by the name of their signal."""
        return {
            'phase_events': events_of(self._motions, ON_COMING, self._steps),
            'off_going_phase_events': events_of(self._motions, OFF_GOING, self._steps),
        }

    def step(
        self,
        running: np.ndarray,
        engine_torque: np.ndarray,
        load_torque: np.ndarray,
        holding_torque: np.ndarray,
        kinetic_torque: np.ndarray,
        static_torque: np.ndarray,
        off_going_kinetic: np.ndarray,
        off_going_static: np.ndarray,
    ) -> None:
        """
        Advance the runs of a mask (R,) by 10 ms, with the arguments of `FrictionDriveline.step`.

        The torques are (R,), those of the clutches (R, 11), all in N m.
        """
        now, holding = self._motions, holding_torque[:, np.newaxis]
        self._inputs = np.stack([engine_torque, load_torque], axis=-1)
        kinetic = static = np.hstack([kinetic_torque, off_going_kinetic, holding])
        if static_torque is not kinetic_torque or off_going_static is not off_going_kinetic:
            static = np.hstack([static_torque, off_going_static, holding])
        forcing = Forcing(self._inputs, kinetic, static)
        before = now.state.copy(), now.signs.copy()
        now.advance(forcing, running)
        running = running & ~now.failed
        self._tie_up_work = self._engaged.tie_ups.work(*before, forcing, now.events, running)
        capacities = kinetic_torque[:, -1], off_going_kinetic[:, -1]
        self._phases = np.array(
            [phases_of(now.signs[:, place], each) for place, each in enumerate(capacities)]
        )
        self._steps += 1
        if self._steps in self._changes:
            self._engage(self._changes[self._steps])

    def _engage(self, new: Sequence[EngagedGears]) -> None:
        """Go over to other engaged gears at the present step."""
        before = self._engaged.values(self._motions.state)
        self._engaged = _Engaged(new)
        state = self._engaged.states(before)
        after = self._engaged.values(state)
        signs = self._motions.signs
        changed = after[:, _SHAFT] != before[:, _SHAFT]
        slips = np.sign(after[:, _ENGINE] - after[:, _SHAFT]).astype(int)
        signs[:, ON_COMING] = np.where(changed, slips, signs[:, ON_COMING])
        self._motions.take([gears.integrator for gears in new], state)


class _Engaged:
    """Gears that are engaged in R runs, with the values of SHIFT_STATES for their states."""

    def __init__(self, engaged: Sequence[EngagedGears]) -> None:
        first, places = distinct(map(id, engaged))
        ones = [engaged[index] for index in first]
        size = len(ones[0].integrator.system.a)
        self._to_values = by_run([_matrix(each.to_values, size) for each in ones], places)
        of_values = [_matrix(each.of_values, len(SHIFT_STATES)) for each in ones]
        self._of_values = by_run(of_values, places)
        self._gear, self._turning = stacked([each.gear for each in engaged]), ones[0].turning
        self.tie_ups = TieUps(engaged)
        """Tie-up work in a period of these gears."""

    def values(self, state: np.ndarray) -> np.ndarray:
        """Return the values (R, 9) for states (R, n)."""
        return product(self._to_values, state)

    def states(self, values: np.ndarray) -> np.ndarray:
        """Return the states (R, n) for the values (R, 9)."""
        return product(self._of_values, values)

    def gear_speed(self, values: np.ndarray) -> np.ndarray:
        """Return the speeds in rad/s of the driveshafts' inner ends, (R,)."""
        speed: np.ndarray = self._gear.wheel_speed(values[:, self._turning])
        return speed


def _matrix(of: Any, size: int) -> np.ndarray:
    """Return the matrix of a linear function of a list of `size` numbers."""
    return np.array([of(unit) for unit in np.eye(size).tolist()]).T
