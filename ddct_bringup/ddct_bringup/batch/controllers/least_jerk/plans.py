# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The planned torques of slipping plates of many runs."""

from collections.abc import Sequence

import numpy as np

from ddct_bringup.batch.controllers.least_jerk.values import Values, numbers
from ddct_controllers.least_jerk.plan import LEVEL_S, SHORTEST_S, PlanLimits
from ddct_controllers.least_jerk.torque_plan import (
    CATCH_UP,
    CORRECTION,
    GENTLE_S,
    LEAST_SHARE,
    MISSED,
    OPENING,
    REFILLING,
)
from ddct_plant.base.timebase import PERIOD_S


class TorquePlans(Values):
    """The counterpart of `TorquePlan`; plates of all runs can lock, or none."""

    def __init__(self, limits: Sequence[PlanLimits], torque: np.ndarray) -> None:
        """Start with torques in N m as planned and smoothed."""
        self._sticks = limits[0].sticks
        self.easy_rate, self._refill_per_s, self._latest_s, self._end_s, self._twist = (
            numbers(limits, name)
            for name in ('easy_rate', 'refill_per_s', 'latest_s', 'end_s', 'twist')
        )
        self._band, self._first_s = numbers(limits, 'band'), numbers(limits, 'least_s')
        self._at_once = np.array([each.hurries for each in limits])
        smoothing = np.maximum(numbers(limits, 'smoothing_s'), PERIOD_S)
        self.share = np.minimum(PERIOD_S / smoothing, 1.0)
        runs = len(limits)
        self.rate, self._needed, self._rise, self._moves = np.zeros((4, runs))
        self.torque = self.smoothed = torque
        self._falling, self._hurries = np.zeros((2, runs), dtype=bool)
        self._least_s = self._first_s
        self.start(np.ones(runs, dtype=bool), torque)

    def start(self, which: np.ndarray, torque: np.ndarray) -> None:
        """Take torques in N m as planned and smoothed."""
        self.put(
            which,
            torque=torque,
            smoothed=torque,
            _needed=np.nan,
            _rise=0.0,
            _hurries=self._at_once,
            _least_s=self._first_s,
            _moves=0.0,
        )

    def part(self, which: np.ndarray, torque: np.ndarray) -> None:
        """Start anew from torques in N m after plates have parted."""
        self.start(which, torque)
        self.put(which, _hurries=True, _falling=False)

    def smooth(self, which: np.ndarray, share: np.ndarray) -> None:
        """Let the low-pass follow the planned torques by a share."""
        self.put(which, smoothed=self.smoothed + share * (self.torque - self.smoothed))

    def move(
        self,
        which: np.ndarray,
        momentum: np.ndarray,
        needed: np.ndarray,
        left_s: np.ndarray,
        rise: np.ndarray,
    ) -> None:
        """Move the planned torques of some runs by a period; see `TorquePlan.move`."""
        self.put(which, _rise=np.maximum(rise, 0.0))
        surplus, waits = self.torque - needed, ~self._hurries
        refilling = np.where(waits, np.maximum(needed, 0.0) * self._refill_per_s, 0.0)
        left_s = np.where(waits, np.maximum(left_s, self._least_s), left_s)
        self.put(which & waits, _least_s=self._least_s - PERIOD_S)
        self._choose_rate(which, momentum, surplus, left_s, refilling)
        share = np.clip((self._moves - OPENING) / REFILLING, 0.0, 1.0)
        final = self._final(momentum)
        aim = needed + final
        falls = self._falling | (self.torque >= aim)
        rising = self.rate + share * np.maximum(refilling - self.rate, 0.0)
        rise_to = np.where(np.isnan(self._needed), 0.0, needed - self._needed)
        meets = self._meets(momentum) & (surplus <= final + GENTLE_S * self.rate)
        # The plates meet gently by the time at which this acts: begin to close them.
        closing = PERIOD_S * self.rate + np.maximum(rise_to, 0.0)
        change = np.select(
            [~falls, meets],
            [np.minimum(aim - self.torque, PERIOD_S * rising), closing],
            self._fall(momentum, surplus, final, rise_to),
        )
        self.put(
            which,
            torque=self.torque + change,
            _falling=falls,
            _needed=needed,
            _moves=self._moves + 1.0,
        )

    def _fall(
        self, momentum: np.ndarray, surplus: np.ndarray, final: np.ndarray, rise_to: np.ndarray
    ) -> np.ndarray:
        """Return the changes in N m on the way down."""
        change = self._final(momentum - PERIOD_S * surplus) - final + rise_to
        share = CORRECTION * PERIOD_S * self.rate / np.maximum(final, 1e-9)
        change = change + np.minimum(share, 1.0) * (final - surplus)
        most = PERIOD_S * self.rate * CATCH_UP
        return np.minimum(np.maximum(change, -most), most)

    def _meets(self, momentum: np.ndarray) -> np.ndarray:
        if not self._sticks:
            return np.zeros(len(momentum), dtype=bool)
        return self._twisted(momentum) <= 0.0

    def _choose_rate(
        self,
        which: np.ndarray,
        momentum: np.ndarray,
        surplus: np.ndarray,
        left_s: np.ndarray,
        refilling: np.ndarray,
    ) -> None:
        """Choose the rates of plans that still rise, and notice those that missed their fall."""
        least, rises = LEAST_SHARE * self.easy_rate, np.ones(len(which), dtype=bool)
        missed = steeper = ~rises
        if not self._sticks:
            # Its slip may pass zero: the same plan serves below.
            sign = np.where(momentum < 0.0, -1.0, 1.0)
            momentum, surplus, least = sign * momentum, sign * surplus, self.easy_rate
        else:
            rises = ~self._falling
            missed = self._falling & (surplus < MISSED * self._final(momentum))
        way_down = self._way_down(momentum, surplus)
        steeper = ~rises & ~missed & (way_down > CATCH_UP * self.rate)
        twisted = self._twisted(momentum)
        late = falling_rate(twisted, surplus, left_s + self._latest_s, refilling)
        in_time = falling_rate(twisted, surplus, left_s, refilling)
        rate = np.minimum(np.maximum(self.easy_rate, late), in_time)
        rate = np.maximum(rate, np.maximum(least, way_down))
        self.put(which & missed, _falling=False, _hurries=True)
        self.put(which & (rises | steeper), rate=np.where(rises, rate, way_down))

    def _way_down(self, momentum: np.ndarray, surplus: np.ndarray) -> np.ndarray:
        """Return the rates in N m/s of a fall from a surplus in N m that ends with the slip."""
        twisted, surplus = self._twisted(momentum), np.maximum(surplus, 0.0)
        line = twisted * self._band * self._band <= self.rate
        return np.where(line, 0.0, surplus * surplus / (2.0 * np.where(line, 1.0, twisted)))

    def _twisted(self, momentum: np.ndarray) -> np.ndarray:
        """Return J_r w_d in N m s at the rates of the way down, for J_r s in N m s."""
        squared = self._band * self._band
        ending = momentum / (1.0 - self._twist * squared)
        return np.where(ending * squared <= self.rate, ending, momentum + self._twist * self.rate)

    def _final(self, momentum: np.ndarray) -> np.ndarray:
        """Return the surplus in N m of the way down."""
        twisted = self._twisted(momentum)
        if not self._sticks:
            return final_surplus(twisted, self.rate, self._band, np.zeros(len(momentum)))
        end = self._end_s * (self.rate + self._rise)
        return final_surplus(np.maximum(twisted, 0.0), self.rate, self._band, end)


def time_left(speed: np.ndarray, rate: np.ndarray) -> np.ndarray:
    """Return the times in s until references in rad/s are zero, along tangents in rad/s^2."""
    falls = rate < 0.0
    left = np.where(falls, speed / -np.where(falls, rate, -1.0), LEVEL_S)
    return np.where(speed <= 0.0, 0.0, left)


def falling_rate(
    momentum: np.ndarray, surplus: np.ndarray, time_s: np.ndarray, rising: np.ndarray
) -> np.ndarray:
    """Return the rates in N m/s of the fall after a rise at `rising`, as the single one."""
    time_s = np.maximum(time_s, SHORTEST_S)
    kept = surplus * time_s
    missing = 2.0 * np.maximum(momentum, 0.0) - kept
    least = (missing + np.sqrt(missing * missing + kept * kept)) / (time_s * time_s)
    direct = (rising <= least) | (surplus < 0.0) | (missing <= 0.0)
    rise_s = np.where(direct, 0.0, missing) / np.where(direct, 1.0, surplus + rising * time_s)
    return np.where(direct, least, (surplus + rising * rise_s) / (time_s - rise_s))


def final_surplus(
    momentum: np.ndarray, rate: np.ndarray, bandwidth_rad_s: np.ndarray, end: np.ndarray
) -> np.ndarray:
    """Return the surplus in N m from which falls end the slip at `end`, as the single one."""
    corner = rate / bandwidth_rad_s
    least = (corner - end) / bandwidth_rad_s
    curve = np.sqrt(corner * corner + 2.0 * rate * np.maximum(momentum - least, 0.0))
    ending = np.where(momentum <= least, end + bandwidth_rad_s * momentum, curve)
    straight = np.sqrt(end * end + 2.0 * rate * np.maximum(momentum, 0.0))
    return np.where(end >= corner, straight, ending)
