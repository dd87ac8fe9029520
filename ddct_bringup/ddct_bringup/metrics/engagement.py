# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Signals and conditions of runs, from which metrics are computed."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.lockup import Lockup
from ddct_bringup.metrics.plant import JudgedPlant
from ddct_bringup.metrics.shift.course import ShiftCourse
from ddct_bringup.run.timing_and_failure import RunTiming

Values = float | int | np.ndarray
"""One number, or one number per run, (R,)."""


@dataclass(frozen=True)
class Engagement:
    """
    Signals and conditions of one run, or of R runs, from which metrics are computed.

    The trajectory of R runs is a stack, (R, N+1) for each signal, of one length, control start and
    score window; of gear shifts also of one step at which the torque phase ends. A shape (...) is
    () for one run, and (R,) for R runs. Values are not finite, or None, where they are not
    defined.
    """

    trajectory: Trajectory
    control_start: int
    """Step at which control starts: feedback, or a gear shift. Figures run from it to the end."""
    score_window: tuple[int, int]
    """First and last step of the window of Table 5.1."""
    planned_steps: int = 0
    """Steps that the run was to have; a run with fewer ended early."""
    plant: JudgedPlant | None = None
    """Plant of the run; None where it is unknown, as for a log. Values are (R,) for R runs."""
    timing: RunTiming | None = None
    """Times on the wall clock, and counts; None without `timing.json`."""

    @property
    def sticks(self) -> bool:
        """Whether the plates can lock."""
        return self.lockup.sticks

    @property
    def ends_early(self) -> bool:
        """Whether the run ends before its plan."""
        return self.trajectory.steps < self.planned_steps

    @property
    def periods(self) -> int:
        """Number of periods from control start to the end; negative where it ends before."""
        return self.trajectory.steps - self.control_start

    @property
    def window_samples(self) -> slice | None:
        """Samples of the score window, both ends included; None where the run ends before."""
        first, last = self.score_window
        return None if self.trajectory.steps < last else slice(first, last + 1)

    @cached_property
    def shift(self) -> ShiftCourse | None:
        """Course of a gear shift, which starts at `control_start`; None for any other run."""
        return ShiftCourse(self.trajectory, self.control_start) if self.trajectory.shift else None

    @property
    def feedback_start(self) -> int:
        """
        Step at which feedback starts.

        In a gear shift it is the first one whose share is 1, N+1 where the share never is.
        """
        return self.control_start if self.shift is None else self.shift.feedback_start

    @cached_property
    def lockup(self) -> Lockup:
        """Instants at which the plates come together and part, from the start of feedback on."""
        return (
            Lockup(self.trajectory, self.control_start)
            if self.shift is None
            else self.shift.lockup
        )

    @cached_property
    def whole_lockup(self) -> Lockup:
        """Instants at which the plates come together and part, from control start on."""
        return Lockup(self.trajectory, self.control_start) if self.shift else self.lockup
