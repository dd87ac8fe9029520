# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Loops and runs of trials, as work of the engine of many runs."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain
from typing import TypeAlias

import pyarrow as pa

from ddct_bringup.campaign.arrow_columns import arrow_column
from ddct_bringup.campaign.columns import runs_table, schema_of
from ddct_bringup.campaign.conduct import RESUME
from ddct_bringup.campaign.rows import ScoredRow
from ddct_bringup.campaign.run_set import ImpossibleRow, PlannedRow
from ddct_bringup.campaign.scored import Scorer, are_together
from ddct_bringup.evaluation.non_dominated import dominates
from ddct_bringup.many_runs.blocks import block_size, blocks_of
from ddct_bringup.many_runs.engine import WorkEngine, Workers, workers_of
from ddct_bringup.many_runs.work import Work
from ddct_bringup.tuning.loop_quantities import Quantities, loop_quantities
from ddct_bringup.tuning.specification.development import parts_of
from ddct_bringup.tuning.specification.goals import OF_LOOP
from ddct_bringup.tuning.specification.parameters import Values
from ddct_bringup.tuning.trial import DOMINATED, FEASIBLE, Trial
from ddct_bringup.tuning.tuning import Tuning

LEAST_TOGETHER = 24
"""Fewest cases of a part whose runs are computed together: a batch of few takes nearly as long."""
PlannedCase = tuple[Values, int]
"""Values of a trial, and the number of one of its cases."""
Asked = Values | PlannedCase
"""What a trial needs: its loop, by its values, or one of its runs."""
Found: TypeAlias = 'list[Quantities] | pa.Table'
"""The quantities of each loop, or the row of each run."""


@dataclass(frozen=True)
class TrialWork(Work[Asked, Found]):
    """Computes loops, or runs, of the trials of a tuning."""

    tuning: Tuning

    @cached_property
    def scorer(self) -> Scorer:
        """Scorer, which keeps what no run changes."""
        return Scorer(self.tuning.limits)

    def of_block(self, items: Sequence[Asked]) -> Found:
        """Return the quantities of each loop, or the row of each run."""
        loops = [self._loop(item) for item in items if isinstance(item, Mapping)]
        return loops or self._rows([item for item in items if not isinstance(item, Mapping)])

    def joined(self, parts: Sequence[Found]) -> Found:
        """Return what was found in all parts."""
        tables = [part for part in parts if isinstance(part, pa.Table)]
        return pa.concat_tables(tables) if tables else [*chain.from_iterable(parts)]

    def without_result(self, item: Asked, why: str) -> Found:
        """Return a loop without quantities, or a row with the reason."""
        if isinstance(item, Mapping):
            return [dict.fromkeys(OF_LOOP)]
        return self._table([self.scorer.without_result(self._planned(item), why)])

    def _loop(self, values: Values) -> Quantities:
        campaign, tuning = self.tuning.with_values(values), self.tuning
        return loop_quantities(campaign, tuning.cases, tuning.spec.goals)

    def _rows(self, runs: Sequence[PlannedCase]) -> pa.Table:
        planned = [replace(self._planned(run), index=place) for place, run in enumerate(runs)]
        scored = self.scorer.scored(planned)
        return self._table(
            [replace(each, index=case) for each, (_, case) in zip(scored, runs, strict=True)]
        )

    def _table(self, runs: Sequence[ScoredRow]) -> pa.Table:
        return runs_table(schema_of(self.tuning.campaign.spec), runs)

    def _planned(self, run: PlannedCase) -> PlannedRow | ImpossibleRow:
        values, case = run
        (planned,) = self.tuning.with_values(values).planned(case, case + 1)
        return planned


@dataclass(frozen=True)
class TrialRuns:
    """Has loops and runs of trials computed; no result depends on the number of workers."""

    tuning: Tuning
    engine: WorkEngine[Asked, Found]

    @classmethod
    def by(
        cls, tuning: Tuning, workers: Workers, stopped: Callable[[], bool] = lambda: False
    ) -> 'TrialRuns':
        """Return those of a tuning that workers compute."""
        return cls(tuning, WorkEngine(TrialWork(tuning), workers, stopped, RESUME))

    @cached_property
    def together(self) -> bool:
        """Whether runs can be computed together."""
        return are_together(self.tuning.campaign)

    def batch(
        self,
        suggested: Mapping[int, Values],
        before: Sequence[Trial],
        timed: Callable[[Trial], Trial],
    ) -> list[Trial]:
        """
        Return the trials of a batch; `before` are all trials of earlier batches.

        After each part of the cases a trial ends if it breaks a constraint, or if one of `before`
        is better in every objective, whatever the rest of its runs come to. So no trial of the
        front ends early. The first trial with the present values runs in all cases, to be
        compared. `timed` adds the update time to a trial that keeps all else.
        """
        tuning = self.tuning
        spec, cases = tuning.spec, tuning.cases
        rivals = [each.costs(spec, len(cases)) for each in before if each.state == FEASIBLE]
        loops = self.loops(list(suggested.values()))
        trials = [
            Trial(number, values, further=loop).checked(spec, len(cases))
            for (number, values), loop in zip(suggested.items(), loops, strict=True)
        ]
        for part in parts_of(cases, LEAST_TOGETHER if self.together else 1):
            going = [
                each for each in trials if each.state == FEASIBLE or _is_present(tuning, each)
            ]
            rows = self.rows([(each.values, case) for each in going for case in part])
            for place, each in enumerate(going):
                of_trial = rows.slice(place * len(part), len(part))
                trials[trials.index(each)] = _ended(tuning, each.with_rows(of_trial), rivals)
        return [
            timed(each).checked(spec, len(cases)) if each.state == FEASIBLE else each
            for each in trials
        ]

    def loops(self, values: Sequence[Values]) -> list[Quantities]:
        """Return the quantities of the loop of each trial that the goals need."""
        return [*chain.from_iterable(self._found(values, together=False))]

    def rows(self, runs: Sequence[PlannedCase]) -> pa.Table:
        """Return the rows of runs in their order; runs of one case are computed together."""
        places = sorted(range(len(runs)), key=lambda place: runs[place][1])
        parts = self._found([runs[place] for place in places], together=self.together)
        none = schema_of(self.tuning.campaign.spec).empty_table()
        order = sorted(range(len(runs)), key=lambda at: places[at])
        return pa.concat_tables([none, *parts]).take(arrow_column(pa.int64(), order))

    def _found(self, items: Sequence[Asked], *, together: bool) -> Iterator[Found]:
        blocks = blocks_of(items, block_size(len(items), together=together))
        return self.engine.in_order(blocks)


def _is_present(tuning: Tuning, trial: Trial) -> bool:
    return trial.number == 0 and bool(tuning.present)


def _ended(tuning: Tuning, trial: Trial, rivals: Sequence[Sequence[float]]) -> Trial:
    """Return a trial after a part of its runs, ended where that is certain."""
    cases = len(tuning.cases)
    trial = trial.checked(tuning.spec, cases)
    if trial.state != FEASIBLE or len(trial.rows) == cases:
        return trial
    costs = trial.costs(tuning.spec, cases)
    if any(dominates(rival, costs) for rival in rivals) and not _is_present(tuning, trial):
        return trial.ended(DOMINATED, 'another one is better in every objective')
    return trial


@contextmanager
def evaluation(
    tuning: Tuning, workers: int | None, stopped: Callable[[], bool]
) -> Iterator[TrialRuns]:
    """Yield an evaluation with its worker processes, by default one for each core."""
    with closing(workers_of(workers)) as chosen:
        yield TrialRuns.by(tuning, chosen, stopped)
