# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The controller `least_jerk`: one step, from the measurement to the command."""

from ddct_controllers.interface import (
    Command,
    Controller,
    ControllerContext,
    ControllerSpec,
    Measurement,
)
from ddct_controllers.least_jerk.actuator_model import ActuatorTorque
from ddct_controllers.least_jerk.demand_trend import DemandTrend
from ddct_controllers.least_jerk.design import LeastJerkDesign
from ddct_controllers.least_jerk.lock import CLOSED, SLIPPING
from ddct_controllers.least_jerk.options import LeastJerkOptions
from ddct_controllers.least_jerk.plan import time_left
from ddct_controllers.least_jerk.shaped_demand import ShapedDemand
from ddct_controllers.least_jerk.torque_plan import TorquePlan
from ddct_controllers.measurement import measured_speeds
from ddct_plant.base.timebase import PERIOD_S

NAME = 'least_jerk'
SLIPPING_RAD_S = 1.0
"""Slip from which the engine's torque balance has the whole torque that the clutch can carry."""
STANDING_RAD_S = 1.0
"""Speed of the primary shaft below which the car may be held by its brake."""
CARRIES_LAGS = 1.4
"""Time with feedback in lags of the actuator in which an off-going clutch carries some torque."""
PARTED_SHARE, PARTED_N_M = 1.2, 10.0
"""Torque of plates that have parted, over that of constant slip, and beyond it in N m."""


class LeastJerk(Controller):
    """
    Lock the plates along the torque of least jerk, at or after the end of the reference.

    The car's jerk follows the rate of the clutch's torque. So the plan is a torque that rises at
    a constant rate, and then falls at it until slip and surplus torque are zero together. Its
    torque is planned for the time at which a request acts, from the slip of that time. What the
    clutch carries is estimated, and the request is divided by the wear gain.
    """

    def __init__(self, context: ControllerContext) -> None:
        """Compute the design, and make the estimates and the plan."""
        design = self.design = LeastJerkDesign.of(context)
        """Numbers that the scenario and the options give."""
        self._engine_inertia = design.driveline.engine_inertia
        self._damping = design.driveline.engine_damping
        self._sticks, self._shifts = design.sticks, design.shifts
        self._static = design.static
        self.actuator = ActuatorTorque(design.actuator)
        """Known actuator, to which the requests go."""
        self._lag_s = self.actuator.ahead * PERIOD_S
        """Time in s after which a request acts."""
        self._clutch, self._slip, self._guard = design.clutch(), design.slip(), design.guard()
        self._plan = TorquePlan(design.limits)
        self._demand, self._lock = DemandTrend(), design.lock()
        self._engine = ShapedDemand(design.shaping_steps, design.authority)
        self.commands_engine = design.shaping_steps > 0
        self.reset()

    def reset(self) -> None:
        """Clear every estimate and the plan."""
        self.actuator.reset(self.design.initial_request)
        parts = self._clutch, self._slip, self._demand, self._lock, self._plan, self._engine
        for part in parts:
            part.reset()
        self._started = self._on = False
        opening_s = CARRIES_LAGS * self.design.actuator.lag_s if self._shifts else 0.0
        self._opening = round(opening_s / PERIOD_S)
        self._torque = self._torque_before = self.design.initial_request
        self._engine_torque = 0.0
        self._plan.start(self.design.initial_request)

    def hold(self, measurement: Measurement) -> None:
        """Follow the plant under the open-loop torque, which keeps locked plates closed."""
        m = measurement
        self._engine.hold(m.engine_torque)
        self._observe(m, learns=not self._shifts and not self._on)
        if self._on:
            self._lock.phase = CLOSED
        request = max(m.open_loop_torque, 0.0)
        self._advance(m, request)
        # The plan begins without the noise of C_m, which the open loop has.
        noise = self._constant_slip(m, m.engine_torque)
        noise -= self._constant_slip(m, self._demand.level)
        self._plan.start(self._clutch.applied(max(request - noise, 0.0)))

    def update(self, measurement: Measurement) -> Command:
        """Return the request of the coming period less the open loop, and that of the engine."""
        measurement, engine_request = self._engine.update(
            measurement, closed=self._lock.phase == CLOSED
        )
        self._observe(measurement, learns=self._lock.phase == SLIPPING and not self._opening)
        self._opening = max(self._opening - 1, 0)
        slip, plan, lock = measurement.slip_speed, self._plan, self._lock
        if not self._on:
            self._on = True
            if self._shifts:
                plan.start(self._constant_slip(measurement, self._demand.level))
            if self._sticks:
                lock.start(slip)
        elif self._sticks and lock.update(slip):
            self._part(measurement)
        if lock.phase == SLIPPING:
            self._move(measurement)
        else:
            # The locked clutch transmits more as the demand rises; it begins with what it carries.
            rate = max(plan.rate, self.design.limits.easy_rate) + max(self._rise(measurement), 0.0)
            plan.torque = lock.torque(max(plan.torque, plan.smoothed), rate, self._clutch.gain)
        plan.smooth(plan.share if lock.phase == SLIPPING else 1.0)
        request = self._clutch.request(plan.smoothed)
        self._advance(measurement, request)
        return Command(
            request - measurement.open_loop_torque,
            (
                ('phase', lock.phase),
                ('wear_gain_estimate', repr(self._clutch.gain)),
                ('torque_offset_n_m', repr(self._clutch.offset)),
                ('planned_rate_n_m_s', repr(plan.rate)),
            ),
            engine_request,
        )

    def _constant_slip(self, measurement: Measurement, engine_torque: float) -> float:
        """Return the torque of constant slip in N m for C_m in N m."""
        m = measurement
        return self._static.torque(engine_torque, m.load_torque, m.engine_speed, m.shaft_speed)

    def _rise(self, measurement: Measurement) -> float:
        """Return the rate in N m/s at which the torque of constant slip rises with the demand."""
        level = self._demand.level
        more = self._constant_slip(measurement, level + 1.0)
        return (more - self._constant_slip(measurement, level)) * self._demand.rate

    def _observe(self, measurement: Measurement, *, learns: bool) -> None:
        """Update every estimate with the measurement and what was requested before."""
        engine_speed, shaft_speed, _ = measured_speeds(measurement)
        slip = engine_speed - shaft_speed
        slips = not self._sticks or slip > SLIPPING_RAD_S
        self._demand.update(measurement.engine_torque)
        engine_torque, torque = self._engine_torque, self._torque
        if not self._started:
            self._started = True
            self._clutch.follow(engine_speed)
            self._slip.follow(slip)
            return
        carried = self._clutch.carried(torque)
        change = self._clutch.gain * (torque - self._torque_before)
        if learns and slips:
            self._clutch.update(engine_speed, engine_torque, torque)
        else:
            self._clutch.follow(engine_speed)
        if not slips:
            self._slip.follow(slip, keep=self._lock.phase == SLIPPING)
        elif shaft_speed < STANDING_RAD_S:
            driven = engine_torque - self._damping * engine_speed - carried
            self._slip.update_held_shaft(slip, driven / self._engine_inertia)
        else:
            surplus = carried - self._constant_slip(measurement, engine_torque)
            self._slip.update(slip, surplus, change)

    def _advance(self, measurement: Measurement, request: float) -> None:
        """Store what acts in the coming period."""
        self._torque_before, self._torque = self._torque, self.actuator.mean_torque(request)
        self._engine_torque = measurement.engine_torque
        self.actuator.advance(request)

    def _part(self, measurement: Measurement) -> None:
        """Start a plan for plates that have parted again."""
        carried = self._clutch.carried(self.actuator.request)
        needed = abs(self._constant_slip(measurement, self._demand.level))
        self._plan.part(min(carried, PARTED_SHARE * needed + PARTED_N_M))

    def _move(self, measurement: Measurement) -> None:
        """Move the plan by a period, to the time at which a new request acts."""
        options, plan, demand = self.design.options, self._plan, self._demand
        needed = self._constant_slip(measurement, demand.level)
        rise = self._rise(measurement)
        ahead_s = self._lag_s + options.smoothing_s
        # Momentum of the slip when a new request acts, from the torque of those so far.
        error = self._slip.surplus_error
        passed = self._clutch.gain * self.actuator.torque_ahead()
        passed += self.actuator.ahead * (
            self._clutch.offset + error - needed - 0.5 * rise * self._lag_s
        )
        momentum = self._slip.inertia * self._slip.slip - PERIOD_S * passed
        momentum -= options.smoothing_s * (plan.smoothed + error - needed - rise * self._lag_s)
        left_s = time_left(measurement.slip_reference[0], measurement.slip_reference_rate[0])
        if self._sticks:
            speeds = measurement.engine_speed, measurement.shaft_speed
            earliest_s = self._guard.earliest_s(speeds, demand.level, needed, plan.rate)
            left_s = max(left_s, min(earliest_s, left_s + options.latest_s))
        plan.move(momentum, needed + rise * ahead_s - error, left_s - ahead_s, rise)
        engine_torque = demand.level + demand.rate * ahead_s
        plan.torque = self._guard.bounded(plan.torque, measurement.engine_speed, engine_torque)


SPEC = ControllerSpec(NAME, LeastJerk, LeastJerkOptions().options)
