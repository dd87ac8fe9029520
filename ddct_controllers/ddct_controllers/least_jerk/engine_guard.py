# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Bounds of the clutch torque and of the time of the lock that the speed of the engine needs."""

import math
from dataclasses import dataclass

from ddct_plant.models.engine_limits import EngineLimits
from ddct_plant.models.parameters import DrivelineParameters

ABOVE_IDLE_RAD_S = 2.0
"""Speed above that of idle control at which the engine shall stay."""
MOST_DIP_RAD_S = 10.0
"""Highest fall of the engine speed below that of the lock which is counted in."""
LEAST_RATE_N_M_S = 1.0
"""Rate of a plan below which that fall is not computed."""
LEAST_SHARE = 0.85
"""Speed that the clutch does not pull the engine below, over that of idle control."""
BELOW_CUT_RAD_S = 10.0
"""Speed below that at which the rev limiter cuts the fuel to which the engine may rise."""


@dataclass(frozen=True)
class SpeedRange:
    """Speeds of the engine that the guard keeps, in rad/s."""

    least: float
    """Speed below which the clutch does not pull the engine."""
    idle: float
    """Speed of idle control, 0 without one."""
    cut: float
    """Speed at which the fuel is cut, infinite without a limiter."""

    @classmethod
    def of(cls, least: float | None, limits: EngineLimits | None) -> 'SpeedRange':
        """
        Return the range of an engine with or without limits.

        Without `least` in rad/s it is `LEAST_SHARE` of the idle speed, in whole rad/s.
        """
        if limits is None:
            return cls(least or 0.0, 0.0, math.inf)
        usual = float(round(LEAST_SHARE * limits.idle_rad_s))
        return cls(usual if least is None else least, limits.idle_rad_s, limits.cut_rad_s)


class EngineGuard:
    """Keeps the engine from a stall, from its limiter, and above idle speed at the lock."""

    def __init__(
        self,
        driveline: DrivelineParameters,
        speeds: SpeedRange,
        guard_s: float,
        most_torque: float,
    ) -> None:
        """Take the speeds, the time constant in s of an approach to them, and a torque in N m."""
        self._engine, self._vehicle = driveline.engine_inertia, driveline.vehicle_side_inertia
        self._damping = driveline.engine_damping
        self._least = speeds.least
        self.idle = speeds.idle + ABOVE_IDLE_RAD_S if speeds.idle > 0.0 else 0.0
        """Speed in rad/s that a lock leaves the engine above, 0 for none."""
        self.highest = speeds.cut - BELOW_CUT_RAD_S
        """Speed in rad/s that the engine does not exceed."""
        self.per_speed = self._engine / guard_s
        """Torque in N m that brings the engine 1 rad/s nearer within the time constant."""
        self._most_torque = most_torque

    def bounded(self, torque: float, engine_speed: float, engine_torque: float) -> float:
        """
        Return a torque in N m that neither stalls the engine nor lets it reach the limiter.

        w_m is in rad/s, C_m in N m.
        """
        least = engine_torque - self.per_speed * (self.highest - engine_speed)
        most = engine_torque + self.per_speed * (engine_speed - self._least)
        return max(min(max(torque, least), most, self._most_torque), 0.0)

    def earliest_s(
        self, speeds: tuple[float, float], engine_torque: float, needed: float, rate: float
    ) -> float:
        """
        Return the time in s until a lock leaves the engine above the speed of idle control.

        Below it idle control would add torque, which nobody demanded, until the plates have
        locked. The mean of w_m and w_p in rad/s, weighted by inertia, always accelerates as it
        does at constant slip, for which the clutch has to carry `needed` in N m. On a way down at
        a rate in N m/s the engine turns more slowly for a while than at the lock.
        """
        engine_speed, shaft_speed = speeds
        driven = engine_torque - self._damping * engine_speed - needed
        if driven <= 0.0 or self.idle <= 0.0:
            return 0.0
        dip = 0.5 * driven * driven / (self._engine * max(rate, LEAST_RATE_N_M_S))
        total = self._engine * engine_speed + self._vehicle * shaft_speed
        least = self.idle + min(dip, MOST_DIP_RAD_S)
        return (least - total / (self._engine + self._vehicle)) * self._engine / driven
