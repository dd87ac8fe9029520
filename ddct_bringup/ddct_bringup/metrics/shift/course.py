# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Course of a gear shift: torque phase, inertia phase, wheel torque, flare and tie-up."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.lockup import Lockup, step_at
from ddct_bringup.metrics.zero_slip import LOCKED
from ddct_plant.base.timebase import time_of_step
from ddct_plant.models.driveline import LOCK, RELEASE, PhaseEvent


@dataclass(frozen=True)
class ShiftCourse:
    """
    Course of one gear shift, from the signals of both clutches.

    The torque phase is the time from the start of the shift to the first tick whose share of
    C_fOL is 1. The inertia phase follows, to the first lock of the on-coming clutch. Samples of
    torques at a tick are left limits.
    """

    trajectory: Trajectory
    start: int
    """Step at which the shift starts."""

    @cached_property
    def feedback_start(self) -> int:
        """First step from the start on whose share is 1; N+1 where there is none."""
        shares = self.trajectory.handover_share[self.start :]
        complete = np.flatnonzero(shares >= 1.0)
        return self.start + int(complete[0]) if complete.size else self.trajectory.steps + 1

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
        return self._from_start_s(self.feedback_start) if self.handed_over else None

    @cached_property
    def lock_s(self) -> float | None:
        """
        Scenario time in s of the first lock of the on-coming clutch in the inertia phase.

        It is the start of the inertia phase where the clutch is locked there; None without a lock.
        """
        return Lockup(self.trajectory, self.feedback_start).locks_from_s

    @property
    def inertia_phase_s(self) -> float | None:
        """Length of the inertia phase in s, exact; None where it does not end."""
        return None if self.lock_s is None else self.lock_s - time_of_step(self.feedback_start)

    @property
    def shift_time_s(self) -> float | None:
        """Time in s from the start of the shift to the lock; None without one."""
        return None if self.lock_s is None else self.lock_s - time_of_step(self.start)

    def _from_start_s(self, step: int) -> float:
        return time_of_step(step) - time_of_step(self.start)

    @cached_property
    def _shifting(self) -> slice:
        """Samples from the start to the first tick with the lock, or to the end of the run."""
        last = self.trajectory.steps if self.lock_s is None else step_at(self.lock_s)
        return slice(self.start, last + 1)

    @property
    def wheel_torque_before(self) -> float | None:
        """Torque of the driveshaft at the wheels at the start of the shift, in N m."""
        return float(self.trajectory.driveshaft_effort[self.start]) if self.begun else None

    @cached_property
    def torque_dip(self) -> float | None:
        """Fall of the wheel torque from the start to its least until the lock, in N m."""
        before = self.wheel_torque_before
        if before is None:
            return None
        return before - float(np.min(self.trajectory.driveshaft_effort[self._shifting]))

    @property
    def torque_dip_percent(self) -> float | None:
        """Fall of the wheel torque in % of that at the start; None unless that is positive."""
        dip, before = self.torque_dip, self.wheel_torque_before
        return 100.0 * dip / before if dip is not None and before and before > 0.0 else None

    @cached_property
    def flare(self) -> float | None:
        """
        Largest rise in rad/s of w_m above its speed in the off-going gear, until the lock.

        That speed is r w_p2 with r = w_p1/w_p2 at the start, when both gears are engaged: also
        when the off-going gear has been disengaged since. Zero while the off-going clutch is
        locked; None where the shafts stand still.
        """
        run = self.trajectory
        if not self.begun or run.primary_shaft_speed[self.start] == 0.0:
            return None
        ratio = run.off_going_shaft_speed[self.start] / run.primary_shaft_speed[self.start]
        rise = run.engine_speed - ratio * run.primary_shaft_speed
        rise = np.where(run.off_going_clutch_phase == LOCKED, 0.0, rise)
        return max(float(np.max(rise[self._shifting])), 0.0)

    @cached_property
    def tie_up_work(self) -> float | None:
        """
        Work in J that both clutches do against each other from the start on, exact.

        While their torques have opposite signs, the smaller magnitude of them goes in a circle
        through both gears, and the wheels lose min(|C_1|, |C_2|) |w_p1 - w_p2|.
        """
        if not self.begun:
            return None
        # The work recorded at a step is that of the period before.
        return float(np.sum(self.trajectory.tie_up_work[self.start + 1 :]))

    def events(self, kind: str, *, off_going: bool) -> int | None:
        """Return the number of locks or releases of a clutch from the start of the shift on."""
        if not self.begun:
            return None
        return sum(event.kind == kind for event in self._events_after(off_going=off_going))

    def _events_after(self, *, off_going: bool) -> Iterator[PhaseEvent]:
        run = self.trajectory
        periods = run.off_going_phase_events if off_going else run.phase_events
        return (event for events in periods[self.start + 1 :] for event in events)

    def locks(self, *, off_going: bool) -> int | None:
        """Return the number of locks of a clutch from the start of the shift on."""
        return self.events(LOCK, off_going=off_going)

    def releases(self, *, off_going: bool) -> int | None:
        """Return the number of releases of a clutch from the start of the shift on."""
        return self.events(RELEASE, off_going=off_going)
