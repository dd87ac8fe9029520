# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Level and rate of the noisy engine torque: a line through its values since it last changed."""

from ddct_plant.base.timebase import PERIOD_S

LONGEST = 80
"""Number of values that a line is fitted to while the torque keeps to it."""
AFTER_DRIFT, AFTER_STEP = 12, 5
"""Number of values that count after the mean error, and after one error that noise leaves open."""
EXPLAINED_N_M = 4.5
"""Size of an error that noise explains: four times the deviation where C_m is known to 1 N m."""
MEAN_SHARE = 0.1
"""Share of a new error in the mean of errors."""
EXPLAINED_MEAN_N_M = 0.8
"""Size of that mean which noise explains: three times its deviation."""


class DemandTrend:
    """
    C_m and dC_m/dt of a torque that follows a line.

    An alpha-beta filter with the gains of the least squares over n values, 2 (2 n - 1)/(n (n + 1))
    and 6/(n (n + 1)). n grows up to `LONGEST`, where 1 N m of noise leaves 0.2 N m of the level. A
    change of the torque makes n small again.
    """

    def __init__(self) -> None:
        """Start with the next measurement."""
        self.reset()

    def reset(self) -> None:
        """Clear level and rate."""
        self.level = self.rate = 0.0
        """C_m in N m and its rate in N m/s."""
        self._mean = 0.0
        self._count = 0

    def update(self, engine_torque: float) -> None:
        """Take the C_m of a period in N m."""
        if self._count == 0:
            self.level, self._count = engine_torque, 1
            return
        predicted = self.level + PERIOD_S * self.rate
        error = engine_torque - predicted
        self._mean += MEAN_SHARE * (error - self._mean)
        self._count = min(self._count + 1, LONGEST)
        if abs(error) > EXPLAINED_N_M:
            self._count = min(self._count, AFTER_STEP)
        elif abs(self._mean) > EXPLAINED_MEAN_N_M:
            self._count = min(self._count, AFTER_DRIFT)
        count = float(self._count)
        both = count * (count + 1.0)
        self.level = predicted + 2.0 * (2.0 * count - 1.0) / both * error
        self.rate += 6.0 / both / PERIOD_S * error
