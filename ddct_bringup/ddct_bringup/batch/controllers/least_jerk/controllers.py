# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The controller `least_jerk` of many runs: one step, from the measurement to the torques."""

from collections.abc import Hashable, Sequence
from typing import Any, Self

import numpy as np

from ddct_bringup.batch.controllers.interface import Measured, StackedController
from ddct_bringup.batch.controllers.least_jerk.actuators import ActuatorTorques, sizes
from ddct_bringup.batch.controllers.least_jerk.estimates import (
    CarriedTorques,
    DemandTrends,
    RigidSlips,
)
from ddct_bringup.batch.controllers.least_jerk.lock import (
    CLOSED,
    SLIPPING,
    EngineGuards,
    StackedLockPhases,
)
from ddct_bringup.batch.controllers.least_jerk.plans import TorquePlans, time_left
from ddct_bringup.batch.controllers.least_jerk.values import numbers
from ddct_bringup.batch.controllers.observers import measured_speeds
from ddct_bringup.batch.open_loops import static_torques
from ddct_controllers.interface import Controller
from ddct_controllers.least_jerk.controller import (
    CARRIES_LAGS,
    PARTED_N_M,
    PARTED_SHARE,
    SLIPPING_RAD_S,
    STANDING_RAD_S,
    LeastJerk,
)
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.scenario.settings import KnownSettings


class LeastJerkControllers(StackedController):
    """
    The counterpart of `LeastJerk` that leaves the engine to the driver.

    Clutches of all runs can lock, or none; all runs are gear shifts, or none.
    """

    def __init__(self, controllers: Sequence[LeastJerk]) -> None:
        """Take the controllers of R runs."""
        designs = [each.design for each in controllers]
        first, drivelines = designs[0], [each.driveline for each in designs]
        self._sticks, self._shifts = first.sticks, first.shifts
        self._static = static_torques(drivelines, [each.static.equilibrium for each in designs])
        self._engine_inertia = numbers(drivelines, 'engine_inertia')
        self._damping = numbers(drivelines, 'engine_damping')
        options = [each.options for each in designs]
        self._smoothing_s, self._latest_s = (
            numbers(options, name) for name in ('smoothing_s', 'latest_s')
        )
        request = numbers(designs, 'initial_request')
        self._actuator = ActuatorTorques([each.actuator for each in controllers], request)
        self._lag_s = self._actuator.ahead * PERIOD_S
        self._clutch, self._slip = CarriedTorques(designs), RigidSlips(designs)
        self._guard, self._lock = EngineGuards(designs), StackedLockPhases(designs)
        self._plan = TorquePlans([each.limits for each in designs], request)
        self._demand = DemandTrends(len(designs))
        lags = np.array([each.actuator.lag_s for each in designs])
        opening = np.round(CARRIES_LAGS * lags / PERIOD_S)
        self._opening = opening if self._shifts else np.zeros(len(designs))
        self._torque = self._torque_before = request
        self._engine_torque = np.zeros(len(designs))
        self._started = False
        self._on, self._lost = np.zeros((2, len(designs)), dtype=bool)

    @classmethod
    def takes(cls, controller: Controller) -> bool:
        """Return whether a controller is `least_jerk`."""
        return type(controller) is LeastJerk

    @classmethod
    def why_not(cls, controller: Controller) -> str:
        """Return no reason."""
        return ''

    @classmethod
    def key(cls, controller: Controller) -> Hashable:
        """Return whether clutches lock and shift, and sizes of the actuator."""
        assert isinstance(controller, LeastJerk)
        design = controller.design
        return design.sticks, design.shifts, sizes(controller.actuator)

    @classmethod
    def of(cls, controllers: Sequence[Controller], known: Sequence[KnownSettings]) -> Self:
        """Return the stack of such controllers."""
        return cls([each for each in controllers if isinstance(each, LeastJerk)])

    def update(self, measured: Measured) -> np.ndarray:
        """Return the requests of the coming period less the open loops."""
        on, off, plan, lock = measured.on, ~measured.on, self._plan, self._lock
        waits = off & (not self._shifts) & ~self._on
        self._observe(measured, waits | (on & (lock.phase == SLIPPING) & (self._opening == 0.0)))
        self._opening = np.where(on, np.maximum(self._opening - 1.0, 0.0), self._opening)
        lock.put(off & self._on, phase=CLOSED)
        self._begin_or_part(measured)
        moving = on & (lock.phase == SLIPPING)
        self._move(moving, measured)
        self._carry_locked(on & ~moving, measured)
        plan.smooth(on, np.where(moving, plan.share, 1.0))
        given = np.maximum(measured.open_loop_torque, 0.0)
        request = np.where(on, self._clutch.request(plan.smoothed), given)
        self._advance(measured, request)
        # The plan begins without the noise of C_m, which the open loop has.
        noise = self._constant_slip(measured, measured.engine_torque)
        noise = noise - self._constant_slip(measured, self._demand.level)
        plan.start(off, self._clutch.applied(np.maximum(given - noise, 0.0)))
        torque = np.where(on, request - measured.open_loop_torque, 0.0)
        return np.where(self._lost, np.nan, torque)

    def _begin_or_part(self, measured: Measured) -> None:
        """Begin with feedback where it is on for the first time, and plan for parted plates."""
        on, slip = measured.on, measured.slip_speed
        begins = on & ~self._on
        if self._shifts:
            self._plan.start(begins, self._constant_slip(measured, self._demand.level))
        if self._sticks:
            parted = self._lock.update(on & self._on, slip)
            self._lock.start(begins, slip)
            carried = self._clutch.carried(self._actuator.request)
            needed = np.abs(self._constant_slip(measured, self._demand.level))
            self._plan.part(parted, np.minimum(carried, PARTED_SHARE * needed + PARTED_N_M))
        self._on = self._on | on

    def _carry_locked(self, which: np.ndarray, measured: Measured) -> None:
        """Move the torques that locked plates shall be able to carry by a period."""
        plan = self._plan
        # The locked clutch transmits more as the demand rises; it begins with what it carries.
        rate = np.maximum(plan.rate, plan.easy_rate) + np.maximum(self._rise(measured), 0.0)
        before = np.maximum(plan.torque, plan.smoothed)
        plan.put(which, torque=self._lock.torque(before, rate, self._clutch.gain))

    def _constant_slip(self, measured: Measured, engine_torque: np.ndarray) -> np.ndarray:
        """Return the torques of constant slip in N m for C_m in N m."""
        m = measured
        torque: np.ndarray = self._static.torque(
            engine_torque, m.load_torque, m.engine_speed, m.shaft_speed
        )
        return torque

    def _rise(self, measured: Measured) -> np.ndarray:
        """Return the rates in N m/s at which the torques of constant slip rise with the demand."""
        level = self._demand.level
        more = self._constant_slip(measured, level + 1.0)
        return (more - self._constant_slip(measured, level)) * self._demand.rate

    def _observe(self, measured: Measured, learns: np.ndarray) -> None:
        """Update every estimate with the measurements and what was requested before."""
        speeds = measured_speeds(measured)
        self._lost = self._lost | np.isnan(speeds[:, 0])
        engine_speed, shaft_speed = speeds[:, 0], speeds[:, 1]
        slip = engine_speed - shaft_speed
        slips: Any = slip > SLIPPING_RAD_S if self._sticks else np.ones(len(slip), dtype=bool)
        self._demand.update(measured.engine_torque)
        if not self._started:
            self._started, each = True, np.ones(len(slip), dtype=bool)
            self._clutch.follow(each, engine_speed)
            self._slip.follow(each, slip, ~each)
            return
        engine_torque, torque = self._engine_torque, self._torque
        carried = self._clutch.carried(torque)
        change = self._clutch.gain * (torque - self._torque_before)
        learns = learns & slips
        self._clutch.update(learns, engine_speed, engine_torque, torque)
        self._clutch.follow(~learns, engine_speed)
        self._slip.follow(~slips, slip, self._lock.phase == SLIPPING)
        stands = slips & (shaft_speed < STANDING_RAD_S)
        driven = engine_torque - self._damping * engine_speed - carried
        self._slip.update_held_shaft(stands, slip, driven / self._engine_inertia)
        surplus = carried - self._constant_slip(measured, engine_torque)
        self._slip.update(slips & ~stands, slip, surplus, change)

    def _advance(self, measured: Measured, request: np.ndarray) -> None:
        """Store what acts in the coming period."""
        self._torque_before, self._torque = self._torque, self._actuator.mean_torque(request)
        self._engine_torque = measured.engine_torque
        self._actuator.advance(request)

    def _move(self, which: np.ndarray, measured: Measured) -> None:
        """Move plans by a period, to the time at which a new request acts."""
        plan, demand, smoothing_s = self._plan, self._demand, self._smoothing_s
        needed, rise = self._constant_slip(measured, demand.level), self._rise(measured)
        ahead_s = self._lag_s + smoothing_s
        # Momentum of the slip when a new request acts, from the torque of those so far.
        error, ahead = self._slip.surplus_error, self._actuator.ahead
        passed = self._clutch.gain * self._actuator.torque_ahead()
        offset = self._clutch.offset + error - needed - 0.5 * rise * self._lag_s
        passed = passed + ahead * offset
        momentum = self._slip.inertia * self._slip.slip - PERIOD_S * passed
        smoothed = plan.smoothed + error - needed - rise * self._lag_s
        momentum = momentum - smoothing_s * smoothed
        left_s = time_left(measured.present_reference, measured.present_reference_rate)
        if self._sticks:
            speeds = measured.engine_speed, measured.shaft_speed
            earliest_s = self._guard.earliest_s(speeds, demand.level, needed, plan.rate)
            left_s = np.maximum(left_s, np.minimum(earliest_s, left_s + self._latest_s))
        needed_then = needed + rise * ahead_s - error
        plan.move(which, momentum, needed_then, left_s - ahead_s, rise)
        engine_torque = demand.level + demand.rate * ahead_s
        bounded = self._guard.bounded(plan.torque, measured.engine_speed, engine_torque)
        plan.put(which, torque=bounded)
