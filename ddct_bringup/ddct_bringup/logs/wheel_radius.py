# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Rolling radius of the wheels from V_x and w_r of a log, with its interval."""

from dataclasses import dataclass

import numpy as np
import scipy

from ddct_bringup.logs.log import MeasuredLog
from ddct_plant.base.errors import DdctError

RADII_M = (0.15, 0.7)
"""Lowest and highest rolling radius of the wheels of a car or truck, m."""
_NEEDED = VEHICLE_SPEED, WHEEL_SPEED = 'vehicle_speed', 'wheel_speed'
_ROLLING = 1.0
"""Least wheel speed in rad/s of a sample that is used."""
_RATE_OVER_S = 0.05
"""Time in s before and after a sample over which the rate of w_r is taken."""
_BLOCKS = 10
"""Number of parts of the log between which the residuals count as independent."""
_FREE = _BLOCKS - 2
"""Degrees of freedom of the interval: two numbers are fitted."""
_FEWEST = 4 * _BLOCKS
"""Fewest samples for an estimate."""
_GAP = 5.0
"""Shortest gap of w_r, in its median steps, within which no sample of V_x is used."""
_LEAST_STD = 1e-12
"""Least relative standard deviation: the rounding of the arithmetic with an exact log."""


@dataclass(frozen=True)
class MeasuredRadius:
    """Wheel radius of a log."""

    value_m: float
    """Estimate in m."""
    lowest_m: float
    """Lower end of the 95 % interval in m."""
    highest_m: float
    """Upper end of that interval in m."""


def measured_radius(log: MeasuredLog) -> MeasuredRadius | None:
    """
    Return r_w of V_x = r_w (w_r - d dw_r/dt) by least squares; None for a log without both.

    d is how late V_x is against w_r, which would make r_w wrong in a log that accelerates. The
    interval is that of residuals with a memory: they are summed over parts of the log, between
    which they count as independent (Liang and Zeger 1986). Slip of the tyres is part of r_w, as
    the model has none. Raise DdctError for a radius that no car has.
    """
    if any(name not in log.signals for name in _NEEDED):
        return None
    speeds, table = _samples(log)
    if len(speeds) < _FEWEST:
        return None
    inverse = np.linalg.pinv(table.T @ table)
    found = inverse @ (table.T @ speeds)
    radius, residuals = float(found[0]), speeds - table @ found
    scores = np.array(
        [part.sum(axis=0) for part in np.array_split(table * residuals[:, None], _BLOCKS)]
    )
    covariance = inverse @ (scores.T @ scores) @ inverse * _BLOCKS / _FREE
    lowest, highest = RADII_M
    if not lowest <= radius <= highest:
        raise DdctError(
            f'{VEHICLE_SPEED} over {WHEEL_SPEED} gives wheels of {radius:.3g} m radius, a car has '
            f'{lowest:g} to {highest:g}: mend the units or signs of {VEHICLE_SPEED} and '
            f'{WHEEL_SPEED}',
            place=log.path,
            key=f'columns.{VEHICLE_SPEED}',
        )
    std = max(float(np.sqrt(covariance[0, 0])), _LEAST_STD * radius)
    reach = float(scipy.stats.t.ppf(0.975, _FREE)) * std
    return MeasuredRadius(radius, radius - reach, radius + reach)


def _samples(log: MeasuredLog) -> tuple[np.ndarray, np.ndarray]:
    """Return V_x in m/s, (n,), and w_r and its rate, (n, 2), where the wheels roll."""
    times_s, speeds = log.samples(VEHICLE_SPEED)
    wheel_s, _ = log.samples(WHEEL_SPEED)
    if len(times_s) < _FEWEST or len(wheel_s) < _FEWEST:
        return speeds[:0], np.zeros((0, 2))
    ends = [log.at(WHEEL_SPEED, times_s + side * _RATE_OVER_S) for side in (-1.0, 1.0)]
    wheels = log.at(WHEEL_SPEED, times_s)
    rates = (ends[1] - ends[0]) / (2.0 * _RATE_OVER_S)
    first_s, last_s = times_s - _RATE_OVER_S, times_s + _RATE_OVER_S
    used = (first_s >= wheel_s[0]) & (last_s <= wheel_s[-1]) & (np.abs(wheels) > _ROLLING)
    gap = np.diff(wheel_s) > _GAP * log.usual_step(WHEEL_SPEED)
    part = np.concatenate([[0], np.cumsum(gap)])
    before = np.searchsorted(wheel_s, first_s[used], side='right') - 1
    after = np.searchsorted(wheel_s, last_s[used], side='left')
    used[used] = part[before] == part[after]
    return speeds[used], np.column_stack([wheels, rates])[used]
