"""When the plates come together, and while they slip before."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_plant.base.timebase import PERIOD_S, time_of_step
from ddct_plant.models import driveline
from ddct_plant.models.driveline import PHASES

SLIPPING, LOCKED = PHASES.index(driveline.SLIPPING), PHASES.index(driveline.LOCKED)
"""Values of `clutch_phase`."""


@dataclass(frozen=True)
class Locking:
    """What happened between the plates of one run."""

    trajectory: Trajectory
    control_start: int
    """Step at which feedback starts."""
    engagement_time_s: float | None
    """t_a of the run, from control start."""

    @cached_property
    def phase(self) -> np.ndarray | None:
        """(N+1,) phase of the clutch at t_k; None for a linear clutch."""
        return self.trajectory.clutch_phase

    @cached_property
    def locks_from_s(self) -> float | None:
        """
        Scenario time of the first lock after control start, or control start when locked there.

        None when the plates never lock, and for a linear clutch.
        """
        start = time_of_step(self.control_start)
        if self._locked_at_control_start:
            return start
        return min((time for time in self._times('lock') if time >= start), default=None)

    @property
    def time_to_lock_s(self) -> float | None:
        """From control start to the first lock; None too when locked at control start."""
        if self.locks_from_s is None or self._locked_at_control_start:
            return None
        return self.locks_from_s - time_of_step(self.control_start)

    @property
    def releases(self) -> int | None:
        """How often the plates part after `locks_from_s`; None without."""
        if self.locks_from_s is None:
            return None
        return sum(time >= self.locks_from_s for time in self._times('release'))

    @property
    def together_from(self) -> int | None:
        """First step at or after the lock, or t_a for a linear clutch; None without."""
        if self.phase is not None:
            return None if self.locks_from_s is None else step_at(self.locks_from_s)
        if self.engagement_time_s is None:
            return None
        return step_at(time_of_step(self.control_start) + self.engagement_time_s)

    @property
    def slipping(self) -> slice:
        """
        Samples of the longest stretch of slipping.

        Of a linear clutch, which slips on after t_a, the samples before t_a at which w_d is not 0;
        without t_a all of them.
        """
        if self.phase is not None:
            mask = self.phase == SLIPPING
        else:
            mask = self.trajectory.slip_speed != 0.0
            if self.together_from is not None:
                mask[self.together_from :] = False
        edges = np.flatnonzero(np.diff(mask, prepend=False, append=False)).reshape(-1, 2)
        if not edges.size:
            return slice(0, 0)
        first, after = edges[np.argmax(edges[:, 1] - edges[:, 0])]
        return slice(int(first), int(after))

    @property
    def _locked_at_control_start(self) -> bool:
        phase = self.phase if self.phase is not None else np.empty(0)
        return len(phase) > self.control_start and phase[self.control_start] == LOCKED

    def _times(self, kind: str) -> list[float]:
        """Return the scenario times in s of all locks or releases, none of a linear clutch."""
        events = self.trajectory.phase_events or ()
        return [time for step in events for time, what in step if what == kind]


def step_at(time_s: float) -> int:
    """Return the first step at or after a scenario time."""
    # A time on the grid is not pushed to the next step by its last bit.
    return math.ceil(time_s / PERIOD_S - 1e-9)
