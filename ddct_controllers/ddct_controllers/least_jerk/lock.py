# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Detection of the lock, and the request that then keeps the plates together."""

from ddct_plant.base.timebase import PERIOD_S

LOCKED_RAD_S = 0.8
"""
Size of the measured slip of plates that may be locked: six times the deviation of w_m - w_p where
each is known to 0.1 rad/s.
"""
AT_START_RAD_S = 1.0
"""Size of the measured slip of plates that count as locked when feedback starts."""
PARTED_RAD_S = 2.5
"""Size of the measured slip of plates that have parted again."""
PARTED_STEPS = 3
"""
Number of samples in turn beyond `PARTED_RAD_S` after which plates count as parted.

In second gear a shaft gains up to 1.7 rad/s in a period, so two lost samples look like more slip.
"""
DWELL_STEPS = 2
"""Number of samples within `LOCKED_RAD_S` after which the request begins to rise."""
CONFIRMING_STEPS = 10
"""Number of further periods in which it rises no faster than the plan."""
CLOSING_S = 0.25
"""Time in s in which the torque then rises by the highest request of closed plates."""
SLIPPING, CONFIRMING, CLOSED = 'slipping', 'confirming', 'closed'
"""Phases of the lock."""


class LockPhases:
    """
    Phases of the lock: slipping, confirming, closed.

    While it is confirmed the torque rises at the rate of the plan. If the plates were not locked
    after all, that costs no more jerk than the plan itself.
    """

    def __init__(self, most_request: float) -> None:
        """Start slipping; the highest request of closed plates is in N m."""
        self._most, self._rate = most_request, most_request / CLOSING_S
        self.reset()

    def reset(self) -> None:
        """Start slipping."""
        self.phase = SLIPPING
        """Present phase."""
        self._count = self._apart = 0

    def start(self, slip: float) -> None:
        """Begin with feedback at a measured slip in rad/s."""
        self.phase = CLOSED if abs(slip) < AT_START_RAD_S else SLIPPING
        self._count = self._apart = 0

    def update(self, slip: float) -> bool:
        """Take the measured slip in rad/s; return whether locked plates have parted."""
        if self.phase == SLIPPING:
            self._count = self._count + 1 if abs(slip) < LOCKED_RAD_S else 0
            if self._count >= DWELL_STEPS:
                self.phase, self._count, self._apart = CONFIRMING, 0, 0
            return False
        self._apart = self._apart + 1 if abs(slip) > PARTED_RAD_S else 0
        if self._apart >= PARTED_STEPS:
            self.phase, self._count = SLIPPING, 0
            return True
        if self.phase == CONFIRMING:
            self._count += 1
            if self._count > CONFIRMING_STEPS:
                self.phase = CLOSED
        return False

    def torque(self, before: float, rate: float, gain: float) -> float:
        """
        Return the torque in N m that locked plates shall be able to carry.

        `before` is that of the last period in N m, `rate` that of the plan in N m/s; the highest
        one is the highest request at the wear gain.
        """
        if self.phase == CONFIRMING:
            return before + PERIOD_S * rate
        return min(before + PERIOD_S * self._rate, self._most * gain)
