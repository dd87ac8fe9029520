# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Signals and conditions of runs, from which metrics and criteria are computed."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.lockup import Lockup
from ddct_bringup.metrics.plant import JudgedPlant
from ddct_bringup.metrics.shift.course import ShiftCourse
from ddct_bringup.metrics.signals.vibration import (
    SHORTEST_JUDDER_S,
    judder_of,
    shuffle_of,
    strongest_stretch,
    vibration_dose,
    weighted_acceleration,
)
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import rpm_from_rad_s

Values = float | int | np.ndarray
"""One number, or one number per run, (R,)."""


@dataclass(frozen=True)
class Engagement:
    """
    Signals and conditions of one run, or of R runs, from which metrics and criteria are computed.

    The trajectory of R runs is a stack, (R, N+1) for each signal, of one length, control start and
    score window; their clutches are linear. A shape (...) is () for one run, and (R,) for R runs.
    Values are not finite, or None, where they are not defined.
    """

    trajectory: Trajectory
    control_start: int
    """Step at which control starts: feedback, or a gear shift."""
    score_window: tuple[int, int]
    """First and last scored step."""
    engagements_a_day: float = 1.0
    """Number of engagements per day, for the daily vibration dose."""
    plant: JudgedPlant | None = None
    """Plant of the run; None where it is unknown, as for a log. Values are (R,) for R runs."""
    timing: RunTiming | None = None
    """Times on the wall clock, and counts; None without `timing.json`."""

    @property
    def sticks(self) -> bool:
        """Whether the plates can lock."""
        return self.lockup.sticks

    @property
    def window_samples(self) -> slice | None:
        """Samples of the score window, both ends included; None where the run ends before."""
        first, last = self.score_window
        return None if self.trajectory.steps < last else slice(first, last + 1)

    @property
    def acceleration(self) -> np.ndarray:
        """Vehicle acceleration A_x in m/s^2 from control start on, (..., n)."""
        return self.trajectory.vehicle_accel[..., self.control_start :]

    @property
    def driveshaft_torque(self) -> np.ndarray:
        """Torque of the driveshaft in N m from control start on, (..., n)."""
        return self.trajectory.driveshaft_effort[..., self.control_start :]

    @property
    def torsion_speed(self) -> np.ndarray:
        """Torsion speed w_sr in rad/s, (..., N+1)."""
        return self.trajectory.driveshaft_speed

    @cached_property
    def torsion_speed_rpm(self) -> np.ndarray:
        """Torsion speed w_sr in rpm, (..., N+1)."""
        return rpm_from_rad_s(self.torsion_speed)

    @property
    def driving_acceleration(self) -> Values | None:
        """
        Largest driving force at the wheels over the mass of the car, m/s^2, in the whole run.

        The force is the driveshaft torque divided by the wheel radius. None without a plant.
        """
        if self.plant is None:
            return None
        torque = np.max(self.trajectory.driveshaft_effort, axis=-1)
        return torque / (self.plant.wheel_radius * self.plant.mass)

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

    @property
    def judged_from(self) -> int:
        """Step from which the slip decides the state: that of feedback, or of control without."""
        within = self.feedback_start <= self.trajectory.steps
        return self.feedback_start if within else self.control_start

    @cached_property
    def lockup(self) -> Lockup:
        """Instants at which the plates come together and part, from the start of feedback on."""
        return Lockup(self.trajectory, self.feedback_start)

    @property
    def slips_for_judder(self) -> np.ndarray:
        """Whether the clutch slips long enough to compute the judder, (...)."""
        first, after = self.lockup.slipping
        return (after - first - 1) * PERIOD_S >= SHORTEST_JUDDER_S

    @property
    def judder(self) -> np.ndarray:
        """R.m.s. in rpm of w_sr from 2 to 20 Hz while the clutch slips, short locks included."""
        first, after = self.lockup.slipping
        return judder_of(self.torsion_speed_rpm, first, after)

    @cached_property
    def shuffle(self) -> tuple[np.ndarray, np.ndarray]:
        """Amplitude in rpm and decay time in s of w_sr after the plates have engaged, (...)."""
        return shuffle_of(self.torsion_speed_rpm, self.lockup.together_from)

    @cached_property
    def _window_weighted(self) -> np.ndarray | None:
        """Weighted A_x in m/s^2 over the score window, (..., n); None if the run ends before."""
        if self.window_samples is None:
            return None
        # The filter gets no sample after the window, so a longer run has the same metrics.
        until = self.trajectory.vehicle_accel[..., : self.window_samples.stop]
        return weighted_acceleration(until)[..., self.window_samples]

    @cached_property
    def window_dose(self) -> np.ndarray | None:
        """Vibration dose value in m/s^1.75 over the score window, (...)."""
        weighted = self._window_weighted
        return None if weighted is None else vibration_dose(weighted)

    @property
    def window_weighted_rms(self) -> np.ndarray | None:
        """Root mean square of the weighted A_x in m/s^2 over the score window, (...)."""
        weighted = self._window_weighted
        return None if weighted is None else np.sqrt(np.mean(weighted**2, axis=-1))

    @cached_property
    def strongest(self) -> tuple[Values | None, Values | None]:
        """
        Largest weighted acceleration in m/s^2 and dose in m/s^1.75, (...) each.

        The maximum is taken over every interval after control start that is as long as the score
        window: a window at a fixed place would miss plates that lock after it.
        """
        if self.window_dose is None:
            return None, None
        first, last = self.score_window
        weighted = weighted_acceleration(self.trajectory.vehicle_accel)
        found = strongest_stretch(weighted[..., min(first, self.control_start) :], last - first)
        defined = np.isfinite(self.window_dose)
        acceleration, dose = (np.where(defined, each, math.nan) for each in found)
        return acceleration, dose
