"""What an engagement is judged by: its signals from control start on, and when the plates meet."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.verdict.meeting import SLIPPING, events_of, first_lock, locked_at
from ddct_bringup.verdict.plant import JudgedPlant
from ddct_bringup.verdict.vibration import (
    SHORTEST_JUDDER_S,
    judder,
    shuffle,
    strongest_stretch,
    weighted_acceleration,
)
from ddct_plant.base.timebase import PERIOD_S, steps_in, time_of_step
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.models.driveline import RELEASE

_DRIVESHAFT = 3
"""Its place among the joints."""
Values = float | int | np.ndarray
"""A number, or one for each of many runs."""


@dataclass(frozen=True)
class JudgedRun:
    """What the criteria are computed from."""

    trajectory: Trajectory
    control_start: int
    """Step at which feedback starts."""
    score_window_s: tuple[float, float]
    metrics: Mapping[str, Any]
    """Those of `scores.json`, by name."""
    engagements_a_day: float
    plant: JudgedPlant | None = None
    """None where it is not known, as of a log; of many runs its values are (R,)."""

    @cached_property
    def torsion_speed_rpm(self) -> np.ndarray:
        """(N+1,) w_sr in rpm."""
        return rpm_from_rad_s(self.trajectory.joint_speed[..., _DRIVESHAFT])

    @cached_property
    def shuffle(self) -> tuple[Values | None, Values | None]:
        """Amplitude in rpm and decay in s of w_sr once the plates are together."""
        together = self.together_from
        return (None, None) if together is None else shuffle(self.torsion_speed_rpm[together:])

    @property
    def judder(self) -> Values | None:
        """R.m.s. in rpm of w_sr from 2 to 20 Hz while the clutch slips, short locks included."""
        return judder(self.torsion_speed_rpm[self.slipping])

    @property
    def slips_for_judder(self) -> Any:
        """Whether the clutch slips long enough for a judder, (R,) of many runs."""
        slipping = self.slipping
        return (slipping.stop - slipping.start - 1) * PERIOD_S >= SHORTEST_JUDDER_S

    @cached_property
    def strongest(self) -> tuple[Values | None, Values | None]:
        """
        Weighted acceleration and dose where they are strongest, None where the window has none.

        That is over any stretch after control start as long as the score window. A window whose
        place is known beforehand says nothing of plates that come together after it.
        """
        first, last = (steps_in('score_window_s', time) for time in self.score_window_s)
        if self.metrics['vdv_m_s1_75'] is None:
            return None, None
        weighted = weighted_acceleration(self.trajectory.vehicle_accel)
        return strongest_stretch(weighted[..., min(first, self.control_start) :], last - first)

    @property
    def acceleration(self) -> np.ndarray:
        """A_x in m/s^2 from control start on."""
        return self.trajectory.vehicle_accel[..., self.control_start :]

    @property
    def driveshaft_torque(self) -> np.ndarray:
        """Torque of the driveshaft in N m from control start on."""
        return self.trajectory.joint_effort[..., self.control_start :, _DRIVESHAFT]

    @cached_property
    def locks_from_s(self) -> float | None:
        """
        Scenario time of the first lock after control start, or control start when locked there.

        None when the plates never lock, and for a linear clutch.
        """
        if locked_at(self.trajectory, self.control_start):
            return time_of_step(self.control_start)
        lock = first_lock(self.trajectory, self.control_start)
        return lock.time_s if lock else None

    @property
    def time_to_lock_s(self) -> float | None:
        """From control start to the first lock; None too when locked at control start."""
        lock = first_lock(self.trajectory, self.control_start)
        return lock.time_s - time_of_step(self.control_start) if lock else None

    @property
    def releases(self) -> int | None:
        """How often the plates part after `locks_from_s`; None without."""
        if self.locks_from_s is None:
            return None
        releases = events_of(self.trajectory, RELEASE)
        return sum(event.time_s >= self.locks_from_s for event in releases)

    @property
    def together_from(self) -> int | None:
        """First step at or after the lock, or t_a for a linear clutch; None without."""
        if self.trajectory.clutch_phase is not None:
            return None if self.locks_from_s is None else step_at(self.locks_from_s)
        time = self.metrics['engagement_time_s']
        if time is None:
            return None
        return step_at(time_of_step(self.control_start) + time)

    @cached_property
    def slipping(self) -> slice:
        """
        Samples from the first to the last of slipping, from control start on.

        Of a linear clutch, which slips on after t_a, those before t_a at which w_d is not 0;
        without t_a all of them.
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
    # A time on the grid is not pushed to the next step by its last bit.
    return math.ceil(time_s / PERIOD_S - 1e-9)
