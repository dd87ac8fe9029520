# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The driveline of a shift, stepped exactly: two clutches, two gears, friction at the wheels."""

from collections.abc import Sequence
from typing import NamedTuple

from ddct_plant.hybrid.interval_map import Interval
from ddct_plant.models.driveline import OPEN, DrivelineOutputs, PhaseEvent, driveline_outputs
from ddct_plant.models.driveline_model import STATES_AND_ANGLES
from ddct_plant.models.parameters import VehicleParameters
from ddct_plant.models.stick_slip_driveline import PHASE_NUMBERS, phase_events, phase_of
from ddct_plant.shift.engagements import (
    OFF_GOING,
    ON_COMING,
    SHIFT_STATES,
    WHEEL,
    EngagedGears,
    both_engaged,
    off_going_engaged,
    on_coming_engaged,
)
from ddct_plant.shift.gear_pair import GearPair
from ddct_plant.shift.start import ShiftStart
from ddct_plant.shift.tie_up import TieUp

_ENGINE, _SHAFT, _OTHER, _OTHER_ANGLE = SHIFT_STATES.places(
    'engine_speed', 'shaft_speed', 'off_going_speed', 'off_going_angle'
)
_OF_DRIVELINE = slice(0, len(STATES_AND_ANGLES))


class OffGoingOutputs(NamedTuple):
    """Signals of the off-going clutch and its shaft at a tick."""

    shaft_angle: float
    """Angle of the off-going primary shaft in rad, from 0."""
    shaft_speed: float
    """Speed w_p1 of the off-going primary shaft in rad/s."""
    transmitted_torque: float
    """Transmitted torque C_1 in N m, left limit; negative where it takes torque from the
    wheels."""
    slip_speed: float
    """Slip speed w_m - w_p1 in rad/s."""
    clutch_phase: float
    """Index of the phase in `PHASES`."""
    friction_work: float
    """Exact friction work in J of the last period."""
    phase_events: tuple[PhaseEvent, ...]
    """Events at slip zero in the last period, in the order of time."""


class ShiftOutputs(NamedTuple):
    """The signals of a tick of a shift."""

    driveline: DrivelineOutputs
    """Signals that every run has; shaft, slip and clutch are those of the on-coming side."""
    off_going: OffGoingOutputs
    """Signals of the off-going side."""
    wheel_friction_work: float
    """Exact work in J of rolling resistance and brake in the last period."""
    tie_up_work: float
    """Exact work in J of the clutches against each other in the last period, see `TieUp`."""


class ShiftDriveline:
    """
    Engine, two primary shafts, wheel and driveshaft, with three dry-friction elements.

    Each clutch transmits its kinetic capacity against its slip, and sticks at slip zero up to its
    static capacity; rolling resistance and brake act on w_r in the same way. Exact as
    `StickSlipDriveline` is. Both clutches stick together only at rest: that is tie-up, and the car
    has stopped or the engine has stalled. Gears are engaged and disengaged at given steps.
    """

    def __init__(
        self,
        gears: GearPair,
        vehicle: VehicleParameters,
        start: ShiftStart,
        preselection_step: int = 0,
        disengagement_step: int | None = None,
    ) -> None:
        """
        Start in the given state.

        The on-coming gear is engaged from `preselection_step` on, 0: before the run, and the
        off-going one until `disengagement_step`.
        """
        self._parameters = gears.on_coming
        self._wheel_radius = vehicle.wheel_radius_m
        both = both_engaged(gears)
        self._engaged: EngagedGears = off_going_engaged(gears) if preselection_step else both
        self._tie_up, self._tie_up_work = TieUp(self._engaged), 0.0
        self._changes: dict[int, EngagedGears] = {preselection_step: both}
        if disengagement_step is not None:
            self._changes[disengagement_step] = on_coming_engaged(gears)
        self._steps = 0
        values = start.values
        slips = [values[_ENGINE] - values[_SHAFT], values[_ENGINE] - values[_OTHER]]
        signs = tuple(map(_sign, (*slips, start.wheel_speed)))
        friction = [0.0, start.off_going_torque, start.wheel_torque]
        state = self._engaged.of_shift(values)
        self.now = Interval(state, signs, [], [0.0, 0.0, 0.0], friction)
        """Result of the last period: state of the engaged gears' system, mode, events, friction
        work of the three elements."""
        self.synchronising_work = 0.0
        """Kinetic energy in J that preselection has given the on-coming shaft."""
        self._torques = start.engine_torque, start.load_torque
        self._phases = [OPEN, phase_of(self.now.signs[OFF_GOING], start.off_going_torque)]

    @property
    def engine_speed(self) -> float:
        """Engine speed w_m in rad/s at the present step."""
        return self.now.state[_ENGINE]

    def outputs(self) -> ShiftOutputs:
        """Return the outputs at the present step; the wheel's effort includes its friction."""
        now = self.now
        values = self._engaged.to_shift(now.state)
        engine_torque, load_torque = self._torques
        on_coming_torque, off_going_torque, wheel_torque = now.friction
        on_coming_phase, off_going_phase = self._phases
        on_coming_sign, off_going_sign, wheel_sign = now.signs
        driveline = driveline_outputs(
            self._parameters,
            self._wheel_radius,
            values[_OF_DRIVELINE],
            (engine_torque, on_coming_torque, load_torque + wheel_torque),
            clutch_sticks=on_coming_sign == 0,
            wheels_stick=wheel_sign == 0,
            clutch_phase=PHASE_NUMBERS[on_coming_phase],
            friction_work=now.work[ON_COMING],
            phase_events=self._events(ON_COMING),
            gear_speed=self._engaged.gear_speed(values),
        )
        off_going = OffGoingOutputs(
            values[_OTHER_ANGLE],
            values[_OTHER],
            off_going_torque,
            values[_ENGINE] - values[_OTHER] if off_going_sign else 0.0,
            PHASE_NUMBERS[off_going_phase],
            now.work[OFF_GOING],
            self._events(OFF_GOING),
        )
        return ShiftOutputs(driveline, off_going, now.work[WHEEL], self._tie_up_work)

    def _events(self, element: int) -> tuple[PhaseEvent, ...]:
        events = self.now.events
        return phase_events(events, element, self._steps - 1) if events else ()

    def step(
        self,
        engine_torque: float,
        load_torque: float,
        kinetic_torque: Sequence[float],
        static_torque: Sequence[float],
        holding_torque: float,
        off_going_kinetic: Sequence[float],
        off_going_static: Sequence[float],
    ) -> None:
        """
        Advance by 10 ms with held C_m and C_load and the (11,) nodes of both clutches' capacities.

        The arguments are those of `StickSlipDriveline.step`, in N m, then the kinetic and the
        static capacity of the off-going clutch. Raise ParameterError for a negative capacity, or a
        static one below the kinetic one.
        """
        kinetic = static = [*kinetic_torque, *off_going_kinetic, holding_torque]
        if static_torque is not kinetic_torque or off_going_static is not off_going_kinetic:
            static = [*static_torque, *off_going_static, holding_torque]
        before, inputs = self.now, (engine_torque, load_torque)
        now = self.now = self._engaged.integrator.advance(
            before.state, before.signs, inputs, kinetic, static
        )
        self._tie_up_work = self._tie_up.work(before, now, inputs, kinetic, static)
        self._phases = [
            phase_of(now.signs[ON_COMING], kinetic_torque[-1]),
            phase_of(now.signs[OFF_GOING], off_going_kinetic[-1]),
        ]
        self._torques = engine_torque, load_torque
        self._steps += 1
        if self._steps in self._changes:
            self._engage(self._changes[self._steps])

    def _engage(self, new: EngagedGears) -> None:
        """Go over to other engaged gears at the present step."""
        now, before = self.now, self._engaged.to_shift(self.now.state)
        now.state = new.of_shift(before)
        self._engaged, self._tie_up = new, TieUp(new)
        after = new.to_shift(now.state)
        if after[_SHAFT] != before[_SHAFT]:
            now.signs = (_sign(after[_ENGINE] - after[_SHAFT]), *now.signs[OFF_GOING:])
            gained = after[_SHAFT] ** 2 - before[_SHAFT] ** 2
            self.synchronising_work = self._parameters.shaft_inertia * gained / 2.0


def _sign(slip: float) -> int:
    return (slip > 0.0) - (slip < 0.0)
