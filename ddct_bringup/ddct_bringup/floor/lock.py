# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The instant at which a run locks, once and for good."""

import math
from dataclasses import dataclass

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.lockup import Lockup
from ddct_bringup.metrics.zero_slip import locked_at
from ddct_bringup.verdict.rules import Rules
from ddct_plant.base.timebase import PERIOD_S, time_of_step
from ddct_plant.scenario.settings import RunSettings


@dataclass(frozen=True)
class Lock:
    """Instant of a lock."""

    time_s: float
    """Time in s from control start, in a gear shift from the start of the inertia phase."""

    @property
    def periods(self) -> int:
        """Number of the period that ends with the lock, or in which it is; at least 1."""
        return max(math.ceil(self.time_s / PERIOD_S - 1e-7), 1)


def counted_from(settings: RunSettings) -> str:
    """Return the words for the instant from which lock times count."""
    return 'the start of the inertia phase' if settings.shift else 'control start'


def lock_of(run: Trajectory, start: int, rules: Rules) -> Lock | None:
    """
    Return the lock of a run that locks once after step `start` and stays locked, else None.

    In a gear shift it is that of the on-coming clutch. Plates that stick lock at the exact
    instant, and slip one way before. A linear clutch locks with the first sample from which the
    slip stays within the band of the rules to the end.
    """
    if run.steps <= start:
        return None
    if run.clutch_phase is None:
        return _settled(run.slip_speed[start:], rules)
    lockup = Lockup(run, start)
    lock, events = lockup.first_lock, lockup.events
    assert lock is not None and events is not None, 'plates that stick have events'
    if (
        lock.step < 0
        or np.count_nonzero(events.step > start) != 1
        or not locked_at(run, run.steps)
    ):
        return None
    return Lock(float(lock.time_s) - time_of_step(start))


def final_lock_of(run: Trajectory, start: int, rules: Rules) -> Lock | None:
    """
    Return the last lock of a run after step `start`, after which it stays locked, else None.

    None too where the plates never part after `start`, or lock before.
    """
    if run.steps <= start:
        return None
    if run.clutch_phase is None:
        return _settled(run.slip_speed[start:], rules)
    time_s = float(Lockup(run, start).final_lock_s)
    return Lock(time_s) if time_s > 0.0 else None


def _settled(slip: np.ndarray, rules: Rules) -> Lock | None:
    outside = np.flatnonzero(np.abs(slip) > rules.engaged_slip_rad_s)
    first = int(outside[-1]) + 1 if outside.size else 0
    if first == 0 or (len(slip) - 1 - first) * PERIOD_S < rules.settled_time - 1e-9:
        return None
    return Lock(first * PERIOD_S)
