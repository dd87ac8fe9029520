# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Data that the criteria of an engagement are computed from: signals after control start, lock."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.verdict.plant import JudgedPlant
from ddct_bringup.verdict.vibration import (
    SHORTEST_JUDDER_S,
    judder,
    shuffle,
    strongest_stretch,
    weighted_acceleration,
)
from ddct_bringup.verdict.zero_slip import SLIPPING, events_of, first_lock, locked_at
from ddct_plant.base.timebase import PERIOD_S, steps_in, time_of_step
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.models.driveline import RELEASE

Values = float | int | np.ndarray
"""One number, or one number per run, (R,)."""


@dataclass(frozen=True)
class JudgedRun:
    """Signals, metrics and plant of a run from which its criteria are computed."""

    trajectory: Trajectory
    control_start: int
    """Step at which feedback starts."""
    score_window_s: tuple[float, float]
    metrics: Mapping[str, Any]
    """Metrics of `scores.json` by name."""
    engagements_a_day: float
    plant: JudgedPlant | None = None
    """Plant of the run; None where it is unknown, as for a log. Values are (R,) for many runs."""

    @cached_property
    def torsion_speed_rpm(self) -> np.ndarray:
        """Torsion speed w_sr in rpm, (N+1,)."""
        return rpm_from_rad_s(self.trajectory.driveshaft_speed)

    @cached_property
    def shuffle(self) -> tuple[Values | None, Values | None]:
        """Amplitude in rpm and decay time in s of w_sr after the plates have engaged."""
        together = self.together_from
        return (None, None) if together is None else shuffle(self.torsion_speed_rpm[together:])

    @property
    def judder(self) -> Values | None:
        """R.m.s. in rpm of w_sr from 2 to 20 Hz while the clutch slips, short locks included."""
        return judder(self.torsion_speed_rpm[self.slipping])

    @property
    def slips_for_judder(self) -> Any:
        """Whether the clutch slips long enough to compute the judder, (R,) for many runs."""
        slipping = self.slipping
        return (slipping.stop - slipping.start - 1) * PERIOD_S >= SHORTEST_JUDDER_S

    @cached_property
    def strongest(self) -> tuple[Values | None, Values | None]:
        """
        Largest weighted acceleration and dose; None where the score window contains none.

        The maximum is taken over every interval after control start that is as long as the score
        window: a window at a fixed place would miss plates that lock after it.
        """
        first, last = (steps_in('score_window_s', time) for time in self.score_window_s)
        if self.metrics['vdv_m_s1_75'] is None:
            return None, None
        weighted = weighted_acceleration(self.trajectory.vehicle_accel)
        return strongest_stretch(weighted[..., min(first, self.control_start) :], last - first)

    @property
    def acceleration(self) -> np.ndarray:
        """Vehicle acceleration A_x in m/s^2 from control start on."""
        return self.trajectory.vehicle_accel[..., self.control_start :]

    @property
    def driveshaft_torque(self) -> np.ndarray:
        """Torque of the driveshaft in N m from control start on."""
        return self.trajectory.driveshaft_effort[..., self.control_start :]

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

    @property
    def together_from(self) -> int | None:
        """First step at or after the lock, or after t_a for a linear clutch; None without one."""
        if self.trajectory.clutch_phase is not None:
            return None if self.locks_from_s is None else step_at(self.locks_from_s)
        time = self.metrics['engagement_time_s']
        if time is None:
            return None
        return step_at(time_of_step(self.control_start) + time)

    @cached_property
    def slipping(self) -> slice:
        """
        Samples from the first to the last with slip, from control start on.

        For a linear clutch, which continues to slip after t_a, the samples before t_a at which w_d
        is not 0; all samples where there is no t_a.
        """
        if self.trajectory.clutch_phase is not None:
            mask = self.trajectory.clutch_phase == SLIPPING
        else:
            mask = self.trajectory.slip_speed != 0.0
            if self.together_from is not None:
                mask[self.together_from :] = False
        slips = self.control_start + np.flatnonzero(mask[self.control_start :])
        return slice(int(slips[0]), int(slips[-1]) + 1) if slips.size else slice(0, 0)


def step_at(time_s: float) -> int:
    """Return the first step at or after a scenario time."""
    # The margin keeps a time on the grid from being rounded up to the next step by its last bit.
    return math.ceil(time_s / PERIOD_S - 1e-9)
