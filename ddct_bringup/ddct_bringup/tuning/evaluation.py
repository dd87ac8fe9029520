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
from ddct_bringup.many_runs.blocks import block_size, blocks_of
from ddct_bringup.many_runs.engine import WorkEngine, Workers, workers_of
from ddct_bringup.many_runs.work import Work
from ddct_bringup.tuning.loop_quantities import Quantities, loop_quantities
from ddct_bringup.tuning.specification.goals import OF_LOOP
from ddct_bringup.tuning.specification.parameters import Values
from ddct_bringup.tuning.tuning import Tuning

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


@contextmanager
def evaluation(
    tuning: Tuning, workers: int | None, stopped: Callable[[], bool]
) -> Iterator[TrialRuns]:
    """Yield an evaluation with its worker processes, by default one for each core."""
    with closing(workers_of(workers)) as chosen:
        yield TrialRuns.by(tuning, chosen, stopped)
