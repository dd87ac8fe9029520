# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The driveline with dry friction, stepped exactly: one clutch or two, and the wheels."""

from collections.abc import Mapping, Sequence

from ddct_plant.base.timebase import time_of_step
from ddct_plant.friction.engagements import OFF_GOING, ON_COMING, WHEEL, EngagedGears
from ddct_plant.friction.tie_up import TieUp
from ddct_plant.hybrid.interval_map import Interval
from ddct_plant.models.driveline import (
    PHASES,
    DrivelineOutputs,
    OffGoingOutputs,
    PhaseEvent,
)
from ddct_plant.models.driveline_model import STATES_AND_ANGLES
from ddct_plant.models.initial_state import InitialState
from ddct_plant.models.parameters import VehicleParameters

_ENGINE, _SHAFT = STATES_AND_ANGLES.places('engine_speed', 'shaft_speed')
_OF_DRIVELINE = slice(0, len(STATES_AND_ANGLES))
_OTHER, _OTHER_ANGLE = len(STATES_AND_ANGLES), len(STATES_AND_ANGLES) + 1
_OPEN, _SLIPPING, _LOCKED = map(float, range(len(PHASES)))


class FrictionDriveline:
    """
    Engine, driveshaft, wheel and the primary shaft of each clutch, with dry-friction elements.

    Each clutch transmits its kinetic capacity against its slip, and sticks at slip zero up to its
    static capacity. Rolling resistance and brake act on w_r in the same way with one capacity, the
    holding torque. C_m, C_load and the holding torque are held over a 10 ms period, the capacities
    of the clutches are linear between 11 nodes. Exact as `Driveline` is, events included. In a
    launch there is one clutch. In a shift there are two, and gears are engaged and disengaged at
    given steps; both clutches stick together only at rest: that is tie-up, and the car has stopped
    or the engine has stalled.
    """

    def __init__(
        self,
        engaged: EngagedGears,
        vehicle: VehicleParameters,
        initial: InitialState,
        changes: Mapping[int, EngagedGears] | None = None,
    ) -> None:
        """
        Start in the given state, whose load torque is that of air and slope only.

        `engaged` are the gears at t_0, `changes` those that are engaged from a step on.
        """
        self._parameters = engaged.driveline
        self._wheel_radius = vehicle.wheel_radius_m
        self._changes = changes or {}
        self._take(engaged)
        slips = [initial.engine_speed - side.shaft_speed for side in initial.sides]
        signs = tuple(map(_sign, (*slips, initial.wheel_speed)))
        friction = [*(side.torque for side in initial.sides), initial.wheel_torque]
        state = engaged.of_values(initial.values)
        self.now = Interval(state, signs, [], [0.0] * len(signs), friction)
        """Result of the last period: state of the engaged gears' system, mode, events, friction
        work of the elements."""
        self.synchronising_work = 0.0
        """Kinetic energy in J that the preselection of its gear has given the on-coming shaft."""
        self._phases = [
            _OPEN if side.open else phase_of(sign, side.torque)
            for side, sign in zip(initial.sides, signs, strict=False)
        ]
        self._torques = initial.engine_torque, initial.load_torque
        self._tie_up_work = 0.0 if self._tie_up else None
        self._steps = 0

    @property
    def engine_speed(self) -> float:
        """Engine speed w_m in rad/s at the present step."""
        return self.now.state[_ENGINE]

    def outputs(self) -> DrivelineOutputs:
        """Return the outputs at the present step; the wheel's effort includes its friction."""
        now, engaged = self.now, self._engaged
        values = engaged.to_values(now.state)
        engine_torque, load_torque = self._torques
        torques = engine_torque, now.friction[ON_COMING], load_torque + now.friction[WHEEL]
        return DrivelineOutputs.of_state(
            self._parameters,
            self._wheel_radius,
            values[_OF_DRIVELINE],
            torques,
            clutch_sticks=now.signs[ON_COMING] == 0,
            wheels_stick=now.signs[WHEEL] == 0,
            clutch_phase=self._phases[ON_COMING],
            friction_work=now.work[ON_COMING],
            phase_events=self._events(ON_COMING),
            gear_speed=engaged.gear.wheel_speed(values[engaged.turning]),
            off_going=self._off_going(values) if self._tie_up else None,
            tie_up_work=self._tie_up_work,
        )

    def _off_going(self, values: Sequence[float]) -> OffGoingOutputs:
        now, shaft_speed = self.now, values[_OTHER]
        return OffGoingOutputs(
            values[_OTHER_ANGLE],
            shaft_speed,
            now.friction[OFF_GOING],
            values[_ENGINE] - shaft_speed if now.signs[OFF_GOING] else 0.0,
            self._phases[OFF_GOING],
            now.work[OFF_GOING],
            self._events(OFF_GOING),
        )

    def _events(self, element: int) -> tuple[PhaseEvent, ...]:
        """Return the events of an element in the last period, in the order of time."""
        if not self.now.events:
            return ()
        start_s = time_of_step(self._steps - 1)
        return tuple(
            PhaseEvent(start_s + event.time_s, event.kind, event.slip_acceleration)
            for event in self.now.events
            if event.element == element
        )

    def step(
        self,
        engine_torque: float,
        load_torque: float,
        holding_torque: float,
        kinetic_torque: Sequence[float],
        static_torque: Sequence[float],
        off_going_kinetic: Sequence[float] = (),
        off_going_static: Sequence[float] = (),
    ) -> None:
        """
        Advance by 10 ms with held C_m and C_load and the (11,) nodes of each clutch's capacities.

        All are in N m. `load_torque` is that of air and slope; `holding_torque`, the capacity of
        rolling resistance and brake at the wheel, is held too. Only a shift has an off-going
        clutch. Raise ParameterError for a negative capacity, or a static one below the kinetic
        one.
        """
        kinetic = static = [*kinetic_torque, *off_going_kinetic, holding_torque]
        if static_torque is not kinetic_torque or off_going_static is not off_going_kinetic:
            static = [*static_torque, *off_going_static, holding_torque]
        before, inputs = self.now, (engine_torque, load_torque)
        now = self.now = self._engaged.integrator.advance(
            before.state, before.signs, inputs, kinetic, static, keep=self._tie_up is not None
        )
        if self._tie_up:
            self._tie_up_work = self._tie_up.work(before, now, inputs, kinetic, static)
        self._phases = [phase_of(now.signs[ON_COMING], kinetic_torque[-1])]
        if off_going_kinetic:
            self._phases.append(phase_of(now.signs[OFF_GOING], off_going_kinetic[-1]))
        self._torques = inputs
        self._steps += 1
        if self._steps in self._changes:
            self._engage(self._changes[self._steps])

    def _take(self, engaged: EngagedGears) -> None:
        self._engaged = engaged
        self._tie_up = TieUp(engaged) if engaged.clutches > 1 else None

    def _engage(self, new: EngagedGears) -> None:
        """Go over to other engaged gears at the present step."""
        now, before = self.now, self._engaged.to_values(self.now.state)
        now.state = new.of_values(before)
        self._take(new)
        after = new.to_values(now.state)
        if after[_SHAFT] != before[_SHAFT]:
            now.signs = (_sign(after[_ENGINE] - after[_SHAFT]), *now.signs[OFF_GOING:])
            gained = after[_SHAFT] ** 2 - before[_SHAFT] ** 2
            self.synchronising_work = self._parameters.shaft_inertia * gained / 2.0


def phase_of(sign: int, capacity: float) -> float:
    """Return the index in PHASES for the sign of the slip and the capacity in N m."""
    if sign == 0:
        return _LOCKED
    return _SLIPPING if capacity else _OPEN


def _sign(slip: float) -> int:
    return (slip > 0.0) - (slip < 0.0)
