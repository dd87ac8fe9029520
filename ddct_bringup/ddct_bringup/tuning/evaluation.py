# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Computes loops and runs of trials: in this process, or in workers that last for the tuning."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import closing, contextmanager
from dataclasses import dataclass, field, replace
from typing import TypeVar

from ddct_bringup.campaign.conduct import RESUME, require_going_on
from ddct_bringup.campaign.rows import Row
from ddct_bringup.campaign.run_set import ImpossibleRow, PlannedRow
from ddct_bringup.campaign.scored import Scorer, are_linear
from ddct_bringup.tuning.loop_quantities import Quantities, loop_quantities
from ddct_bringup.tuning.specification.parameters import Values
from ddct_bringup.tuning.tuning import Tuning
from ddct_plant.base.errors import DdctError
from ddct_plant.program.workers import WorkerPool, worker_count

_MOST_AT_ONCE, _MOST_STEP_BY_STEP = 200, 16
"""Largest numbers of runs of a job: of linear ones, which are computed together, and of others."""
_JOBS_EACH = 4
"""Number of jobs of each worker, so that all end together; linear runs cost less the more."""
_POLL_S = 0.2
"""Time in s between two checks of signals."""
PlannedCase = tuple[Values, int]
"""Values of a trial, and the number of one of its cases."""
Job = Values | Sequence[PlannedCase]
"""Work of a worker: values whose loop is computed, or runs."""
Result = TypeVar('Result')


@dataclass
class TrialRuns:
    """Computes the loops and the runs of trials; no result depends on the number of workers."""

    tuning: Tuning
    workers: int
    stopped: Callable[[], bool]
    pool: WorkerPool | None = None
    scorer: Scorer = field(init=False)
    linear: bool = field(init=False)
    """Whether runs can be computed together."""

    def __post_init__(self) -> None:
        """Make the scorer, which keeps what no run changes."""
        self.scorer = Scorer(self.tuning.limits)
        self.linear = are_linear(self.tuning.campaign)

    def loops(self, values: Sequence[Values]) -> list[Quantities]:
        """Return the quantities of the loop of each trial that the goals need."""
        return self._computed(self.loop, values)

    def rows(self, runs: Sequence[PlannedCase]) -> list[Row]:
        """Return the rows of runs in their order."""
        jobs_each, most = (1, _MOST_AT_ONCE) if self.linear else (_JOBS_EACH, _MOST_STEP_BY_STEP)
        size = max(1, min(most, -(-len(runs) // (jobs_each * self.workers))))
        jobs = [runs[first : first + size] for first in range(0, len(runs), size)]
        return [row for part in self._computed(self.some_rows, jobs) for row in part]

    def work(self, job: Job) -> Quantities | list[Row]:
        """Do one job in a worker."""
        return self.loop(job) if isinstance(job, Mapping) else self.some_rows(job)

    def loop(self, values: Values) -> Quantities:
        """Return the quantities of the loop of one trial."""
        campaign, tuning = self.tuning.with_values(values), self.tuning
        return loop_quantities(campaign, tuning.cases, tuning.spec.goals)

    def some_rows(self, runs: Sequence[PlannedCase]) -> list[Row]:
        """Return the rows of some runs; those of a linear loop are computed together."""
        planned: list[PlannedRow | ImpossibleRow] = []
        for place, (values, case) in enumerate(runs):
            (run,) = self.tuning.with_values(values).planned(case, case + 1)
            planned.append(replace(run, index=place))
        scored = self.scorer.scored(planned)
        return [{**each.row(), 'index': runs[place][1]} for place, each in enumerate(scored)]

    def _computed(self, work: Callable[..., Result], jobs: Sequence[Job]) -> list[Result]:
        """Return the results of jobs in their order; raise KeyboardInterrupt when stopped."""
        if self.pool is None:
            found = []
            for job in jobs:
                require_going_on(self.stopped)
                found.append(work(job))
            return found
        try:
            futures = [self.pool.submit(job) for job in jobs]
            left = set(futures)
            while left:
                left = wait(left, _POLL_S, FIRST_COMPLETED).not_done
                require_going_on(self.stopped)
            return [future.result() for future in futures]
        except BrokenProcessPool as error:
            raise DdctError(
                f'a process that simulates was killed: free some memory if it ran out; {RESUME}'
            ) from error


@contextmanager
def evaluation(
    tuning: Tuning, workers: int | None, stopped: Callable[[], bool]
) -> Iterator[TrialRuns]:
    """Yield an evaluation with its worker processes, by default one for each core."""
    count = worker_count(workers)
    made = TrialRuns(tuning, count, stopped)
    if count < 2:
        yield made
        return
    with closing(WorkerPool(count, made.work)) as pool:
        made.pool = pool
        yield made
