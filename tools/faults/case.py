# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A case of the fault campaign: one fault, its run, and what must follow from it."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from support.runs import plan

from ddct_bringup.run.plan import RunPlan
from ddct_plant.base.timebase import time_of_step
from faults.outcome import NEVER, Observed, Stated

SHORT, IN_REAL_TIME, LONG = 100, 160, 400
"""Steps of a run; in real time a fault of half a second must be over before the end."""
ENDED_BY_FAULT = 3000
"""Steps of a run in lock-step that its fault ends: it must not be over before the fault."""
MIDDLE = 68
"""Step at which a fault in the middle begins; control begins at step 60, or 30 in the shift."""
LATEST = 15
"""Most steps of a real-time run by which a fault may come later than its instant."""
MOST_TRIES = 3
"""Times that a case is tried where a busy machine was too late for it."""
Where = Mapping[tuple[str, str, int], Sequence[str]]
"""Targets of a fault by instant, mode and number of clutches."""


def places(where: Where) -> Iterator[tuple[str, str, str, int]]:
    """Yield target, instant, mode and number of clutches of each case."""
    for (instant, mode, clutches), targets in where.items():
        for target in targets:
            yield target, instant, mode, clutches


def run_of(mode: str, clutches: int, steps: int = SHORT, *, equipped: bool = False) -> RunPlan:
    """
    Return the run that a fault disturbs: of an engagement, or of a gear shift.

    An `equipped` shift has sensors and a commanded engine, and so every topic of a tick.
    """
    seconds = time_of_step(steps)
    if clutches == 1:
        return plan('ls8', duration_s=seconds, mode=mode)
    controller, changes = ('mpc4', ('sensors={}',)) if equipped else ('pi', ())
    return plan(
        controller,
        scenario='upshift',
        duration_s=seconds,
        mode=mode,
        changes=changes,
    )


@dataclass(frozen=True)
class Case:
    """One fault, where and when it happens, what must follow, and how it is tried."""

    fault: str
    target: str
    instant: str
    mode: str
    clutches: int
    stated: Stated
    attempt: Callable[['Case', Path], Observed]
    """Function that causes the fault in a run recorded in a new folder."""
    steps: int = SHORT
    """N, the number of steps of the run."""
    equipped: bool = False
    """Whether the run has every topic, as `run_of` describes it."""

    @property
    def name(self) -> str:
        """Name of the case, unique in the campaign."""
        clutches = 'one clutch' if self.clutches == 1 else 'two clutches'
        return ', '.join(
            filter(None, [self.fault, self.target, self.instant, self.mode, clutches])
        )

    @property
    def run(self) -> RunPlan:
        """The run that the fault disturbs."""
        return run_of(self.mode, self.clutches, self.steps, equipped=self.equipped)

    @property
    def begin(self) -> int:
        """Step at which the fault begins."""
        places = {'start': 0, 'middle': MIDDLE, 'end': self.steps - self.steps // 8}
        return places.get(self.instant, MIDDLE)

    def met(self, seen: Observed) -> bool:
        """Return whether what is stated followed, of a fault at its instant."""
        return self.in_time(seen) and self.stated.met(seen) and not seen.left

    def in_time(self, seen: Observed) -> bool:
        """Return whether the fault began at its instant, or not too long after it."""
        latest = self.begin + LATEST if self.mode == 'realtime' else self.steps
        return seen.fault_step <= latest

    def came_too_late(self, seen: Observed) -> bool:
        """Return whether the run was over before the fault, or the machine too slow."""
        over = seen.same_hash and not seen.error
        return self.mode == 'realtime' or over or seen.fault_step == NEVER
