# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Instants at which the plates of a clutch come together and part."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.zero_slip import SLIPPING, Events, first_sign_change, locked_at
from ddct_plant.base.timebase import PERIOD_S, STEPS_PER_S, time_of_step
from ddct_plant.models.driveline import LOCK, RELEASE


@dataclass(frozen=True)
class Lockup:
    """
    Instants at which the plates of one run, or of R runs, come together and part.

    A shape (...) is () for one run, and (R,) for R runs. Times that do not exist are NaN.
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
    def events(self) -> Events | None:
        """Events of the plates; None for a linear clutch."""
        periods = self.trajectory.phase_events
        return None if periods is None else Events.of(periods)

    @cached_property
    def engagement_time_s(self) -> np.ndarray:
        """
        Engagement time t_a in s (thesis Section 5.1), (...): to the first sign change of w_d.

        It is counted from `start` and interpolated linearly between samples. Not finite without
        one, or when w_d is zero at `start`. For plates that stick it ends at the exact instant of
        the first lock or passage through zero; in a bag from before passages were events, at a
        sign change without an event.
        """
        crossing_s, slip = self._sign_change[0], self.trajectory.slip_speed
        if self.events is None or self.trajectory.steps < self.start:
            return crossing_s
        slips = slip[..., self.start : self.start + 1] != 0.0
        not_released = (self.events.kind != RELEASE) & (self.events.step > self.start)
        step, time_s, *_ = self.events.first(slips & not_released)
        without_event = crossing_s <= (step - 1 - self.start) / STEPS_PER_S
        return np.where((step < 0) | without_event, crossing_s, time_s - time_of_step(self.start))

    @cached_property
    def first_lock(self) -> Events | None:
        """
        First lock after `start`, (...) each; None for a linear clutch.

        Plates that are locked at `start` have none.
        """
        if self.events is None:
            return None
        locked = locked_at(self.trajectory, self.start)[..., np.newaxis]
        return self.events.first(self.events.after(self.start, LOCK) & ~locked)

    @property
    def slip_acceleration(self) -> np.ndarray:
        """
        Slope of w_d in rad/s^2 at its first sign change, between the samples around it, (...).

        For plates that stick it is the exact slope just before the first lock.
        """
        lock = self.first_lock
        return self._sign_change[1] if lock is None else lock.slip_acceleration

    @cached_property
    def locks_from_s(self) -> np.ndarray:
        """
        Scenario time in s of the first lock after `start`, (...).

        It is that of `start` where the plates are locked there; NaN when they never lock, and for
        a linear clutch.
        """
        first_s = math.nan if self.first_lock is None else self.first_lock.time_s
        locked = locked_at(self.trajectory, self.start)
        return np.where(locked, time_of_step(self.start), first_s)

    @cached_property
    def final_lock_s(self) -> np.ndarray:
        """
        Exact time in s from `start` to the last lock, (...), 0 where the plates never part.

        NaN where the plates are not locked at the end, and for a linear clutch.
        """
        run = self.trajectory
        locked = locked_at(run, run.steps) & (run.steps >= self.start)
        if self.events is None:
            return np.full(locked.shape, math.nan)
        locks = np.where(self.events.after(self.start, LOCK), self.events.time_s, -math.inf)
        last_s = np.max(locks, axis=-1)
        from_start_s = np.where(last_s >= 0.0, last_s - time_of_step(self.start), 0.0)
        return np.where(locked, from_start_s, math.nan)

    @property
    def releases(self) -> np.ndarray | None:
        """Number of releases after `start`, (...); None for a linear clutch."""
        if self.events is None:
            return None
        return np.count_nonzero(self.events.after(self.start, RELEASE), axis=-1)

    @cached_property
    def together_from(self) -> np.ndarray:
        """First step at or after the lock, of a linear clutch t_a, (...); N+1 without one."""
        at_s = self.locks_from_s
        if not self.sticks:
            at_s = time_of_step(self.start) + self.engagement_time_s
        return step_at(at_s, never=self.trajectory.steps + 1)

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


def step_at(time_s: np.ndarray, never: int) -> np.ndarray:
    """Return the first step at or after each scenario time in s, (...); `never` for NaN."""
    # The margin keeps a time on the grid from being rounded up to the next step by its last bit.
    steps = np.ceil(time_s / PERIOD_S - 1e-9)
    return np.where(np.isfinite(steps), steps, never).astype(int)
