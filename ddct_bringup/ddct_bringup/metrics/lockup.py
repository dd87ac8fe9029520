# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Instants at which the plates of a clutch come together and part."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.zero_slip import (
    SLIPPING,
    events_of,
    first_lock,
    first_sign_change,
    first_zero_slip,
    locked_at,
)
from ddct_plant.base.timebase import PERIOD_S, time_of_step
from ddct_plant.models.driveline import LOCK, RELEASE


@dataclass(frozen=True)
class Lockup:
    """
    Instants at which the plates of one run, or of R runs, come together and part.

    A shape (...) is () for one run, and (R,) for R runs, whose clutches are linear.
    """

    trajectory: Trajectory
    start: int
    """Step at which feedback starts; beyond the end of the run where it never does."""

    @property
    def sticks(self) -> bool:
        """Whether the plates can lock."""
        return self.trajectory.clutch_phase is not None

    @cached_property
    def _sign_change(self) -> tuple[np.ndarray, np.ndarray]:
        return first_sign_change(self.trajectory.slip_speed, self.start)

    @cached_property
    def engagement_time_s(self) -> np.ndarray:
        """
        Engagement time t_a in s (thesis Section 5.1), (...): to the first sign change of w_d.

        It is counted from `start` and interpolated linearly between samples. Not finite without
        one, or when w_d is zero at `start`. For plates that stick it ends at the exact instant of
        the first lock or passage through zero; in a bag from before passages were events, at a
        sign change without an event.
        """
        crossing_s = self._sign_change[0]
        if self.trajectory.phase_events is None:
            return crossing_s
        found = first_zero_slip(self.trajectory, self.start)
        if found is None:
            return crossing_s
        step, event = found
        if crossing_s <= time_of_step(step - 1 - self.start):
            return crossing_s
        return np.array(event.time_s - time_of_step(self.start))

    @property
    def slip_acceleration(self) -> np.ndarray:
        """
        Slope of w_d in rad/s^2 at its first sign change, between the samples around it, (...).

        For plates that stick it is the exact slope just before the first lock.
        """
        if self.trajectory.phase_events is None:
            return self._sign_change[1]
        lock = first_lock(self.trajectory, self.start)
        return np.array(math.nan if lock is None else lock.slip_acceleration, dtype=float)

    @cached_property
    def locks_from_s(self) -> float | None:
        """
        Scenario time in s of the first lock after `start`.

        It is that of `start` where the plates are locked there; None when they never lock, and for
        a linear clutch.
        """
        if locked_at(self.trajectory, self.start):
            return time_of_step(self.start)
        lock = first_lock(self.trajectory, self.start)
        return lock.time_s if lock else None

    @property
    def final_lock_s(self) -> float | None:
        """
        Exact time in s from `start` to the last lock, 0 where the plates never part after it.

        None where the plates are not locked at the end, and for a linear clutch.
        """
        run = self.trajectory
        if run.steps < self.start or not locked_at(run, run.steps):
            return None
        locks = [event.time_s for event in events_of(run, LOCK, after=self.start)]
        return locks[-1] - time_of_step(self.start) if locks else 0.0

    @property
    def releases(self) -> int | None:
        """Number of releases after `start`; None for a linear clutch."""
        if not self.sticks:
            return None
        return sum(1 for _ in events_of(self.trajectory, RELEASE, after=self.start))

    @cached_property
    def together_from(self) -> np.ndarray:
        """First step at or after the lock, of a linear clutch t_a, (...); N+1 without one."""
        if self.sticks:
            at_s = np.array(math.nan if self.locks_from_s is None else self.locks_from_s)
        else:
            at_s = time_of_step(self.start) + self.engagement_time_s
        never = self.trajectory.steps + 1
        steps = [step_at(time) if math.isfinite(time) else never for time in at_s.flat]
        return np.reshape(steps, at_s.shape)

    @cached_property
    def slipping(self) -> tuple[np.ndarray, np.ndarray]:
        """
        First sample with slip from `start` on, and one after the last, (...) each.

        For a linear clutch, which continues to slip after t_a, only samples before t_a count, or
        all where there is no t_a. Both are equal where no sample slips.
        """
        sample = np.arange(self.trajectory.steps + 1)
        if self.sticks:
            mask = self.trajectory.clutch_phase == SLIPPING
        else:
            mask = self.trajectory.slip_speed != 0.0
            mask &= sample < self.together_from[..., np.newaxis]
        mask &= sample >= self.start
        first, after = np.argmax(mask, axis=-1), len(sample) - np.argmax(mask[..., ::-1], axis=-1)
        return first, np.where(mask.any(axis=-1), after, first)


def step_at(time_s: float) -> int:
    """Return the first step at or after a scenario time."""
    # The margin keeps a time on the grid from being rounded up to the next step by its last bit.
    return math.ceil(time_s / PERIOD_S - 1e-9)
