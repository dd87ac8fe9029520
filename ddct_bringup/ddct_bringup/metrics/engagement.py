# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Signals and conditions of runs, from which metrics and criteria are computed."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.plant import JudgedPlant
from ddct_bringup.metrics.vibration import (
    SHORTEST_JUDDER_S,
    judder_of,
    shuffle_of,
    strongest_stretch,
    vibration_dose,
    weighted_acceleration,
)
from ddct_bringup.metrics.zero_slip import (
    SLIPPING,
    events_of,
    first_lock,
    first_sign_change,
    first_zero_slip,
    locked_at,
)
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_plant.base.timebase import PERIOD_S, time_of_step
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.models.driveline import RELEASE

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
    """Step at which feedback starts."""
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
        return self.trajectory.clutch_phase is not None

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
    def _sign_change(self) -> tuple[np.ndarray, np.ndarray]:
        return first_sign_change(self.trajectory.slip_speed, self.control_start)

    @cached_property
    def engagement_time_s(self) -> np.ndarray:
        """
        Engagement time t_a in s (thesis Section 5.1), (...): to the first sign change of w_d.

        It is counted from control start and interpolated linearly between samples. Not finite
        without one, or when w_d is zero at control start. For plates that stick it ends at the
        exact instant of the first lock or passage through zero; in a bag from before passages
        were events, at a sign change without an event.
        """
        crossing_s = self._sign_change[0]
        if self.trajectory.phase_events is None:
            return crossing_s
        found = first_zero_slip(self.trajectory, self.control_start)
        if found is None:
            return crossing_s
        step, event = found
        if crossing_s <= time_of_step(step - 1 - self.control_start):
            return crossing_s
        return np.array(event.time_s - time_of_step(self.control_start))

    @property
    def lockup_slip_acceleration(self) -> np.ndarray:
        """
        Slope of w_d in rad/s^2 at its first sign change, between the samples around it, (...).

        For plates that stick it is the exact slope just before the first lock.
        """
        if self.trajectory.phase_events is None:
            return self._sign_change[1]
        lock = first_lock(self.trajectory, self.control_start)
        return np.array(math.nan if lock is None else lock.slip_acceleration, dtype=float)

    @cached_property
    def locks_from_s(self) -> float | None:
        """
        Scenario time in s of the first lock after control start.

        It is control start where the plates are locked there; None when they never lock, and for a
        linear clutch.
        """
        if locked_at(self.trajectory, self.control_start):
            return time_of_step(self.control_start)
        lock = first_lock(self.trajectory, self.control_start)
        return lock.time_s if lock else None

    @property
    def time_to_lock_s(self) -> float | None:
        """
        Time in s from control start to the first lock.

        None without a lock, and when the plates are locked at control start.
        """
        lock = first_lock(self.trajectory, self.control_start)
        return lock.time_s - time_of_step(self.control_start) if lock else None

    @property
    def releases(self) -> int | None:
        """Number of releases after `locks_from_s`; None without a lock."""
        if self.locks_from_s is None:
            return None
        releases = events_of(self.trajectory, RELEASE)
        return sum(event.time_s >= self.locks_from_s for event in releases)

    @cached_property
    def together_from(self) -> np.ndarray:
        """First step at or after the lock, of a linear clutch t_a, (...); N+1 without one."""
        if self.sticks:
            at_s = np.array(math.nan if self.locks_from_s is None else self.locks_from_s)
        else:
            at_s = time_of_step(self.control_start) + self.engagement_time_s
        never = self.trajectory.steps + 1
        steps = [step_at(time) if math.isfinite(time) else never for time in at_s.flat]
        return np.reshape(steps, at_s.shape)

    @cached_property
    def slipping(self) -> tuple[np.ndarray, np.ndarray]:
        """
        First sample with slip from control start on, and one after the last, (...) each.

        For a linear clutch, which continues to slip after t_a, only samples before t_a count, or
        all where there is no t_a. Both are equal where no sample slips.
        """
        sample = np.arange(self.trajectory.steps + 1)
        if self.sticks:
            mask = self.trajectory.clutch_phase == SLIPPING
        else:
            mask = self.trajectory.slip_speed != 0.0
            mask &= sample < self.together_from[..., np.newaxis]
        mask &= sample >= self.control_start
        first, after = np.argmax(mask, axis=-1), len(sample) - np.argmax(mask[..., ::-1], axis=-1)
        return first, np.where(mask.any(axis=-1), after, first)

    @property
    def slips_for_judder(self) -> np.ndarray:
        """Whether the clutch slips long enough to compute the judder, (...)."""
        first, after = self.slipping
        return (after - first - 1) * PERIOD_S >= SHORTEST_JUDDER_S

    @property
    def judder(self) -> np.ndarray:
        """R.m.s. in rpm of w_sr from 2 to 20 Hz while the clutch slips, short locks included."""
        first, after = self.slipping
        return judder_of(self.torsion_speed_rpm, first, after)

    @cached_property
    def shuffle(self) -> tuple[np.ndarray, np.ndarray]:
        """Amplitude in rpm and decay time in s of w_sr after the plates have engaged, (...)."""
        return shuffle_of(self.torsion_speed_rpm, self.together_from)

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


def step_at(time_s: float) -> int:
    """Return the first step at or after a scenario time."""
    # The margin keeps a time on the grid from being rounded up to the next step by its last bit.
    return math.ceil(time_s / PERIOD_S - 1e-9)
