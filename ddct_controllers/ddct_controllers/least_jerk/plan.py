# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What bounds a plan, and the torque that ends the slip at the least rate, in closed form."""

import math
from dataclasses import dataclass

SHORTEST_S = 0.2
"""Shortest time in s that a plan takes, five times the lag of the actuator."""

LEVEL_S = 1.0
"""Time in s that is left where the reference does not fall."""

MOST_BAND = 0.7
"""
Highest bandwidth over the frequency at which the twist of the half-shafts undoes the feedback.
"""


@dataclass(frozen=True)
class PlanLimits:
    """What bounds a plan, constant over a run."""

    easy_rate: float
    """Rate in N m/s at which the torque changes unless that takes too long."""
    refill_per_s: float
    """
    Rate at which the torque rises after a torque phase, over the torque of constant slip, in 1/s.

    It rises no slower than it falls, so 0 where it rises as it falls.
    """
    latest_s: float
    """Time in s by which the lock may be later than the reference ends."""
    least_s: float
    """Time in s that a plan takes at least."""
    bandwidth_rad_s: float
    """Bandwidth of the last part of the way down, before `MOST_BAND` limits it."""
    end_s: float
    """Time in s for which the surplus at the lock would still fall."""
    twist: float
    """J_r w_d of a rigid car beyond that of the measured one, in N m s per N m/s."""
    smoothing_s: float
    """Time constant of the low-pass behind the plan."""
    sticks: bool
    """Whether the plates can lock; else the slip may pass zero."""
    hurries: bool
    """
    Whether `refill_per_s` and `least_s` do not hold, as the plates are to be locked already.
    """

    @property
    def band(self) -> float:
        """Bandwidth in rad/s of the last part of the way down."""
        return min(self.bandwidth_rad_s, MOST_BAND / math.sqrt(self.twist))


def time_left(speed: float, rate: float) -> float:
    """Return the time in s until a reference in rad/s is zero, along its tangent in rad/s^2."""
    if speed <= 0.0:
        return 0.0
    return speed / -rate if rate < 0.0 else LEVEL_S


def least_rate(momentum: float, surplus: float, time_s: float) -> float:
    """
    Return the least |dy/dt| in N m/s with which slip and surplus are zero after `time_s`.

    `momentum` is J_r s in N m s, `surplus` y in N m. The optimum rises with a rate R and then
    falls with -R: y_0 + R t_1 - R t_2 = 0, t_1 + t_2 = T and the integral of y equal to J_r s give
    T^2 R^2 + (2 y_0 T - 4 J_r s) R - y_0^2 = 0.
    """
    time_s = max(time_s, SHORTEST_S)
    half = 2.0 * max(momentum, 0.0) - surplus * time_s
    kept = surplus * time_s
    return (half + math.sqrt(half * half + kept * kept)) / (time_s * time_s)


def falling_rate(momentum: float, surplus: float, time_s: float, rising: float) -> float:
    """
    Return the rate in N m/s of the fall after a rise at `rising` in N m/s, as in `least_rate`.

    With the rise at U for t_1 the integral of y is (y_0 t_1 + (y_0 + U t_1) T)/2 = J_r s, so
    t_1 = (2 J_r s - y_0 T)/(y_0 + U T) and R = (y_0 + U t_1)/(T - t_1). It is the least rate where
    U is less than that, or nothing is left to rise.
    """
    time_s = max(time_s, SHORTEST_S)
    least = least_rate(momentum, surplus, time_s)
    missing = 2.0 * max(momentum, 0.0) - surplus * time_s
    if rising <= least or surplus < 0.0 or missing <= 0.0:
        return least
    rise_s = missing / (surplus + rising * time_s)
    return (surplus + rising * rise_s) / (time_s - rise_s)


def final_surplus(momentum: float, rate: float, bandwidth_rad_s: float, end: float) -> float:
    """
    Return the surplus in N m from which a fall at `rate` in N m/s ends the slip at `end` in N m.

    With the momentum m = J_r s in N m s, y^2 = end^2 + 2 R m, as y dy = R dm on the way. The slope
    R/y grows without bound as y becomes small. Where it would exceed the bandwidth w in rad/s, the
    line y = end + w m takes its place, which meets the curve with the same slope. This is the
    proximate time-optimal law of Workman (1987) with the rate as the input.
    """
    corner = rate / bandwidth_rad_s
    if end >= corner:
        return math.sqrt(end * end + 2.0 * rate * max(momentum, 0.0))
    least = (corner - end) / bandwidth_rad_s
    if momentum <= least:
        return end + bandwidth_rad_s * momentum
    return math.sqrt(corner * corner + 2.0 * rate * (momentum - least))
