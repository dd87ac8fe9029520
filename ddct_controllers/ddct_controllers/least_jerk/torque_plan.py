# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The planned torque of slipping plates, moved by a period at a time."""

import math

from ddct_controllers.least_jerk.plan import PlanLimits, falling_rate, final_surplus
from ddct_plant.base.timebase import PERIOD_S

LEAST_SHARE = 0.05
"""Least rate of the plan over that of `jerk_m_s3`."""
CATCH_UP = 1.6
"""Highest rate on the way down, over that of the plan."""
CORRECTION = 4.0
"""Errors of the way down are corrected within this part of the time that it still takes."""
GENTLE_S = 0.06
"""Time of the fall that may be missing where the plates meet, for them to be closed from there."""
MISSED = 0.3
"""Share of the planned surplus below which the torque rises again."""
OPENING, REFILLING = 3, 6
"""
Periods of feedback in a gear shift before the torque rises faster, and until it does so fully.

The off-going clutch opens meanwhile, which jerks too.
"""


class TorquePlan:
    """
    A torque that rises at a constant rate, and then falls at it until slip and surplus are zero.

    After the torque phase of a gear shift it rises faster than it falls.

    `torque` is the planned one, `smoothed` the same behind the low-pass that requests follow.
    """

    def __init__(self, limits: PlanLimits) -> None:
        """Start with no torque."""
        self._limits = limits
        self._band = limits.band
        self.share = min(PERIOD_S / max(limits.smoothing_s, PERIOD_S), 1.0)
        """Share of the low-pass in a period."""
        self.reset()

    def reset(self) -> None:
        """Clear the plan."""
        self.rate = 0.0
        """Rate of the plan in N m/s, that of its fall where both differ."""
        self._falling = False
        self.start(0.0)

    def start(self, torque: float) -> None:
        """Take a torque in N m as planned and smoothed."""
        self.torque = self.smoothed = torque
        self._needed = math.nan
        self._rise = 0.0
        self._hurries = self._limits.hurries
        self._least_s = self._limits.least_s
        self._moves = 0

    def part(self, torque: float) -> None:
        """Start anew from a torque in N m after plates have parted."""
        self.start(torque)
        self._hurries = True
        self._falling = False

    def smooth(self, share: float) -> None:
        """Let the low-pass follow the planned torque by a share."""
        self.smoothed += share * (self.torque - self.smoothed)

    def move(self, momentum: float, needed: float, left_s: float, rise: float) -> None:
        """
        Move the planned torque by a period.

        `momentum` is J_r s in N m s when a new request acts, `needed` the torque in N m of
        constant slip then, `left_s` the time in s from then until the slip shall be zero, and
        `rise` the rate in N m/s at which the torque of constant slip rises with the demand.
        """
        self._rise = max(rise, 0.0)
        surplus = self.torque - needed
        refilling = 0.0
        if not self._hurries:
            refilling = max(needed, 0.0) * self._limits.refill_per_s
            left_s = max(left_s, self._least_s)
            self._least_s -= PERIOD_S
        self._choose_rate(momentum, surplus, left_s, refilling)
        share = min(max((self._moves - OPENING) / REFILLING, 0.0), 1.0)
        self._moves += 1
        final = self._final(momentum)
        aim = needed + final
        if not self._falling and self.torque >= aim:
            self._falling = True
        if not self._falling:
            rising = self.rate + share * max(refilling - self.rate, 0.0)
            self.torque += min(aim - self.torque, PERIOD_S * rising)
        elif self._meets(momentum) and surplus <= final + GENTLE_S * self.rate:
            # The plates meet gently by the time at which this acts: begin to close them.
            self.torque += PERIOD_S * self.rate + max(self._rise_to(needed), 0.0)
        else:
            self._fall(momentum, needed, final)
        self._needed = needed

    def _fall(self, momentum: float, needed: float, final: float) -> None:
        """Follow the way down; errors are corrected the slower, the longer it still takes."""
        surplus = self.torque - needed
        change = self._final(momentum - PERIOD_S * surplus) - final + self._rise_to(needed)
        share = min(CORRECTION * PERIOD_S * self.rate / max(final, 1e-9), 1.0)
        change += share * (final - surplus)
        most = PERIOD_S * self.rate * CATCH_UP
        self.torque += min(max(change, -most), most)

    def _rise_to(self, needed: float) -> float:
        """Return by how much the torque of constant slip has risen since the last period, N m."""
        return 0.0 if math.isnan(self._needed) else needed - self._needed

    def _meets(self, momentum: float) -> bool:
        return self._limits.sticks and self._twisted(momentum) <= 0.0

    def _choose_rate(
        self, momentum: float, surplus: float, left_s: float, refilling: float
    ) -> None:
        """Choose the rate of a plan that still rises, at `refilling` in N m/s if that is more."""
        limits = self._limits
        least = LEAST_SHARE * limits.easy_rate
        if not limits.sticks:
            # Its slip may pass zero: the same plan serves below.
            sign = -1.0 if momentum < 0.0 else 1.0
            momentum, surplus, least = sign * momentum, sign * surplus, limits.easy_rate
        elif self._falling:
            if surplus < MISSED * self._final(momentum):
                self._falling, self._hurries = False, True
            elif (steeper := self._way_down(momentum, surplus)) > CATCH_UP * self.rate:
                self.rate = steeper
            return
        twisted = self._twisted(momentum)
        late = falling_rate(twisted, surplus, left_s + limits.latest_s, refilling)
        in_time = falling_rate(twisted, surplus, left_s, refilling)
        least = max(least, self._way_down(momentum, surplus))
        self.rate = max(min(max(limits.easy_rate, late), in_time), least)

    def _way_down(self, momentum: float, surplus: float) -> float:
        """Return the rate in N m/s of a fall from a surplus in N m that ends with the slip."""
        twisted = self._twisted(momentum)
        if twisted * self._band * self._band <= self.rate:
            return 0.0  # the line to zero: its rate does not exceed that of the plan
        surplus = max(surplus, 0.0)
        return surplus * surplus / (2.0 * twisted)

    def _twisted(self, momentum: float) -> float:
        """
        Return J_r w_d in N m s at the rate of the way down, for J_r s in N m s.

        w_d = s + kappa R while the torque falls at R. In the last part it falls at w^2 J_r w_d.
        """
        squared = self._band * self._band
        ending = momentum / (1.0 - self._limits.twist * squared)
        if ending * squared <= self.rate:
            return ending
        return momentum + self._limits.twist * self.rate

    def _final(self, momentum: float) -> float:
        """Return the surplus in N m of the way down."""
        twisted = self._twisted(momentum)
        if not self._limits.sticks:
            return final_surplus(twisted, self.rate, self._band, 0.0)
        # Where the demand rises, plates that meet late have to carry more.
        end = self._limits.end_s * (self.rate + self._rise)
        return final_surplus(max(twisted, 0.0), self.rate, self._band, end)
