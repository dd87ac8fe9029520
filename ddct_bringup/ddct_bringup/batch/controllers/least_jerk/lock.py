# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Phases of the lock of many runs, and the guards of their engines."""

from collections.abc import Sequence

import numpy as np

from ddct_bringup.batch.controllers.least_jerk.values import Values, numbers
from ddct_controllers.least_jerk.design import LeastJerkDesign
from ddct_controllers.least_jerk.engine_guard import LEAST_RATE_N_M_S, MOST_DIP_RAD_S
from ddct_controllers.least_jerk.lock import (
    AT_START_RAD_S,
    CLOSING_S,
    CONFIRMING_STEPS,
    DWELL_STEPS,
    LOCKED_RAD_S,
    PARTED_RAD_S,
    PARTED_STEPS,
)
from ddct_plant.base.timebase import PERIOD_S

SLIPPING, CONFIRMING, CLOSED = range(3)
"""Phases of the lock."""


class StackedLockPhases(Values):
    """The counterpart of `LockPhases`."""

    def __init__(self, designs: Sequence[LeastJerkDesign]) -> None:
        """Start slipping."""
        self._most = numbers(designs, 'most_request')
        self.phase, self._count, self._apart = np.zeros((3, len(designs)), dtype=int)

    def start(self, which: np.ndarray, slip: np.ndarray) -> None:
        """Begin with feedback at measured slips in rad/s."""
        phase = np.where(np.abs(slip) < AT_START_RAD_S, CLOSED, SLIPPING)
        self.put(which, phase=phase, _count=0, _apart=0)

    def update(self, which: np.ndarray, slip: np.ndarray) -> np.ndarray:
        """Take the measured slips in rad/s; return whether locked plates have parted."""
        slips, slip = self.phase == SLIPPING, np.abs(slip)
        within = np.where(slip < LOCKED_RAD_S, self._count + 1, 0)
        locks = slips & (within >= DWELL_STEPS)
        apart = np.where(slip > PARTED_RAD_S, self._apart + 1, 0)
        parts = ~slips & (apart >= PARTED_STEPS)
        confirms = ~slips & ~parts & (self.phase == CONFIRMING)
        confirmed = self._count + 1
        closes = confirms & (confirmed > CONFIRMING_STEPS)
        phase = np.select([locks, parts, closes], [CONFIRMING, SLIPPING, CLOSED], self.phase)
        count = np.select([locks | parts, slips, confirms], [0, within, confirmed], self._count)
        self.put(
            which,
            phase=phase,
            _count=count,
            _apart=np.where(slips, np.where(locks, 0, self._apart), apart),
        )
        return parts & which

    def torque(self, before: np.ndarray, rate: np.ndarray, gain: np.ndarray) -> np.ndarray:
        """Return the torques in N m that locked plates shall be able to carry."""
        closing = before + PERIOD_S * (self._most / CLOSING_S)
        closing = np.minimum(closing, self._most * gain)
        return np.where(self.phase == CONFIRMING, before + PERIOD_S * rate, closing)


class EngineGuards:
    """The counterpart of `EngineGuard`."""

    def __init__(self, designs: Sequence[LeastJerkDesign]) -> None:
        """Take the guards of R runs."""
        drivelines = [each.driveline for each in designs]
        guards = [each.guard() for each in designs]
        self._engine, self._vehicle, self._damping = (
            numbers(drivelines, name)
            for name in ('engine_inertia', 'vehicle_side_inertia', 'engine_damping')
        )
        self._idle, self._highest, self._per_speed = (
            numbers(guards, name) for name in ('idle', 'highest', 'per_speed')
        )
        self._least = numbers([each.speeds for each in designs], 'least')
        self._most_torque = numbers(designs, 'most_torque')

    def bounded(
        self, torque: np.ndarray, engine_speed: np.ndarray, engine_torque: np.ndarray
    ) -> np.ndarray:
        """Return torques in N m that neither stall the engines nor let them reach the limiter."""
        least = engine_torque - self._per_speed * (self._highest - engine_speed)
        most = engine_torque + self._per_speed * (engine_speed - self._least)
        torque = np.minimum(np.minimum(np.maximum(torque, least), most), self._most_torque)
        return np.maximum(torque, 0.0)

    def earliest_s(
        self,
        speeds: tuple[np.ndarray, np.ndarray],
        engine_torque: np.ndarray,
        needed: np.ndarray,
        rate: np.ndarray,
    ) -> np.ndarray:
        """Return the times in s until a lock leaves the engines above idle control."""
        engine_speed, shaft_speed = speeds
        driven = engine_torque - self._damping * engine_speed - needed
        free = (driven <= 0.0) | (self._idle <= 0.0)
        dip = 0.5 * driven * driven / (self._engine * np.maximum(rate, LEAST_RATE_N_M_S))
        total = self._engine * engine_speed + self._vehicle * shaft_speed
        least = self._idle + np.minimum(dip, MOST_DIP_RAD_S)
        missing = least - total / (self._engine + self._vehicle)
        return np.where(free, 0.0, missing * self._engine / np.where(free, 1.0, driven))
