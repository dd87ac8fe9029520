# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Course of a gear shift: torque phase, inertia phase, wheel torque, flare and tie-up."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.lockup import Lockup, step_at
from ddct_bringup.metrics.zero_slip import LOCKED, Events
from ddct_plant.base.timebase import time_of_step


def torque_phase_ends(trajectory: Trajectory, start: int) -> np.ndarray:
    """Return the first step from `start` on whose share of C_fOL is 1, (...); N+1 without one."""
    sample = np.arange(trajectory.steps + 1)
    complete = (sample >= start) & (trajectory.handover_share >= 1.0)
    return np.where(complete.any(axis=-1), np.argmax(complete, axis=-1), trajectory.steps + 1)


@dataclass(frozen=True)
class ShiftCourse:
    """
    Course of one gear shift, or of R whose torque phases end at the same step.

    The torque phase is the time from the start of the shift to the first tick whose share of
    C_fOL is 1. The inertia phase follows, to the first lock of the on-coming clutch. Samples of
    torques at a tick are left limits. A shape (...) is () for one run, and (R,) for R runs.
    """

    trajectory: Trajectory
    start: int
    """Step at which the shift starts."""

    @cached_property
    def feedback_start(self) -> int:
        """First step from the start on whose share is 1; N+1 where there is none."""
        (step,) = set(torque_phase_ends(self.trajectory, self.start).flat)
        return int(step)

    @property
    def begun(self) -> bool:
        """Whether the run reaches the start of the shift."""
        return self.trajectory.steps >= self.start

    @property
    def handed_over(self) -> bool:
        """Whether the torque phase ends within the run."""
        return self.feedback_start <= self.trajectory.steps

    @property
    def torque_phase_s(self) -> float | None:
        """Length of the torque phase in s; None where it does not end."""
        if not self.handed_over:
            return None
        return time_of_step(self.feedback_start) - time_of_step(self.start)

    @cached_property
    def lockup(self) -> Lockup:
        """Instants at which the on-coming clutch locks and parts in the inertia phase."""
        return Lockup(self.trajectory, self.feedback_start)

    @property
    def lock_s(self) -> np.ndarray:
        """
        Scenario time in s of the first lock of the on-coming clutch in the inertia phase, (...).

        It is the start of the inertia phase where the clutch is locked there; NaN without a lock.
        """
        return self.lockup.locks_from_s

    @property
    def inertia_phase_s(self) -> np.ndarray:
        """Length of the inertia phase in s, (...), exact; NaN where it does not end."""
        return self.lock_s - time_of_step(self.feedback_start)

    @property
    def shift_time_s(self) -> np.ndarray:
        """Time in s from the start of the shift to the lock, (...); NaN without one."""
        return self.lock_s - time_of_step(self.start)

    @cached_property
    def _shifting(self) -> np.ndarray:
        """Whether a sample is from the start to the first tick with the lock, (..., N+1)."""
        sample = np.arange(self.trajectory.steps + 1)
        last = step_at(self.lock_s, never=self.trajectory.steps)
        return (sample >= self.start) & (sample <= last[..., np.newaxis])

    @property
    def wheel_torque_before(self) -> np.ndarray:
        """Torque of the driveshaft at the wheels at the start in N m, (...), of a shift begun."""
        torque: np.ndarray = self.trajectory.driveshaft_effort[..., self.start]
        return torque

    @cached_property
    def torque_dip(self) -> np.ndarray | None:
        """Fall of the wheel torque from the start to its least until the lock, in N m, (...)."""
        if not self.begun:
            return None
        torque = np.where(self._shifting, self.trajectory.driveshaft_effort, np.inf)
        return self.wheel_torque_before - np.min(torque, axis=-1)

    @property
    def torque_dip_percent(self) -> np.ndarray | None:
        """Fall of the wheel torque in % of that at the start, (...); NaN unless it is positive."""
        if self.torque_dip is None:
            return None
        before = self.wheel_torque_before
        return 100.0 * self.torque_dip / np.where(before > 0.0, before, np.nan)

    @cached_property
    def flare(self) -> np.ndarray | None:
        """
        Largest rise in rad/s of w_m above its speed in the off-going gear until the lock, (...).

        That speed is r w_p2 with r = w_p1/w_p2 at the start, when both gears are engaged: also
        when the off-going gear has been disengaged since. Zero while the off-going clutch is
        locked; NaN where the shafts stand still.
        """
        run = self.trajectory
        if not self.begun:
            return None
        shaft = run.primary_shaft_speed[..., self.start]
        ratio = run.off_going_shaft_speed[..., self.start] / np.where(shaft, shaft, np.nan)
        rise = run.engine_speed - ratio[..., np.newaxis] * run.primary_shaft_speed
        rise = np.where(run.off_going_clutch_phase == LOCKED, 0.0, rise)
        largest = np.max(np.where(self._shifting, rise, 0.0), axis=-1, initial=0.0)
        return np.where(shaft, largest, np.nan)

    @cached_property
    def tie_up_work(self) -> np.ndarray | None:
        """
        Work in J that both clutches do against each other from the start on, (...), exact.

        While their torques have opposite signs, the smaller magnitude of them goes in a circle
        through both gears, and the wheels lose min(|C_1|, |C_2|) |w_p1 - w_p2|.
        """
        if not self.begun:
            return None
        # The work recorded at a step is that of the period before.
        return np.sum(self.trajectory.tie_up_work[..., self.start + 1 :], axis=-1)

    def count(self, kind: str, *, off_going: bool) -> np.ndarray | None:
        """Return the number of locks or releases of a clutch from the start on, (...)."""
        if not self.begun:
            return None
        run = self.trajectory
        events = Events.of(run.off_going_phase_events) if off_going else self.lockup.events
        assert events is not None, 'both clutches of a gear shift stick'
        return np.count_nonzero(events.after(self.start, kind), axis=-1)
