# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Score the runs of a run set: linear ones at once, all others step by step."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import chain
from typing import Any

import numpy as np

from ddct_bringup.batch.batchable import why_not_batchable
from ddct_bringup.batch.run_batch import run_batch
from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.rows import (
    CONTROLLER,
    INDEX,
    SEED,
    SERIAL,
    VECTORISED,
    Row,
    result_row,
    scored_headless,
)
from ddct_bringup.campaign.run_set import ImpossibleRow, PlannedRow, RunSet
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.scores.scoring import run_without_score
from ddct_bringup.verdict.limits import Limits
from ddct_controllers.registry import make_controller
from ddct_plant.base.errors import FOREIGN_FAILURES
from ddct_plant.program.workers import in_processes, worker_count

_LARGEST_PART = 16
"""Largest number of runs that a worker hands over together."""
_PARTS_EACH = 8
"""Least number of parts for each worker, so that all end together."""


@dataclass(frozen=True)
class ScoredRow:
    """A run of the set with its scores, and the values that distinguish it from the others."""

    index: int
    controller: str
    seed: int
    """Seed of the random numbers within the run."""
    varied: Mapping[str, Any]
    """Values by key, as they were given."""
    scores: ScoredRun
    """Scores; of a run that was computed at once without facts and bag."""
    path: str
    """Path of the computation: `serial` or `vectorised`."""

    def row(self) -> Row:
        """Return the row of the run, by the columns of `results.parquet`."""
        ours = {INDEX: self.index, SEED: self.seed}
        row = result_row(self.scores, self.varied, self.path)
        return {**ours, **row, CONTROLLER: self.controller}


@dataclass
class Scorer:
    """Scores runs, those of linear plants and controllers together."""

    limits: Limits
    at_once: bool = True
    """Whether linear runs are computed together, to 1e-9 of the run step by step."""

    def scored(self, runs: Iterable[PlannedRow | ImpossibleRow]) -> list[ScoredRow]:
        """
        Return every run with its scores, in their order.

        A failed run, and one whose settings cannot be built, has its reason.
        """
        planned = list(runs)
        # A value that is not finite becomes a reason in the row of its run.
        with np.errstate(all='ignore'):
            found = self._together([run for run in planned if isinstance(run, PlannedRow)])
            return [self._of(run, found.get(run.index)) for run in planned]

    def _of(self, run: PlannedRow | ImpossibleRow, found: ScoredRun | None) -> ScoredRow:
        name, path, scores = run.controller.name, VECTORISED, found
        if isinstance(run, ImpossibleRow):
            path, scores = SERIAL, run_without_score(name, None, str(run.error))
        elif scores is None:
            path = SERIAL
            scores = scored_headless(run.settings, run.controller, self.limits)
        return ScoredRow(run.index, name, run.seed, run.varied, scores, path)

    def _together(self, runs: Sequence[PlannedRow]) -> dict[int, ScoredRun]:
        """Return the scores of the runs that can be computed at once, by index."""
        suited = []
        for run in runs if self.at_once else ():
            if run.controller.compiled:
                continue
            try:
                controller = make_controller(run.controller, run.settings.known)
            except FOREIGN_FAILURES:
                continue  # the run step by step gives the reason
            if not why_not_batchable(run.settings, controller):
                suited.append((run, controller))
        results = run_batch(
            [(run.settings, controller) for run, controller in suited], self.limits
        )
        return {
            run.index: result
            for (run, _), result in zip(suited, results, strict=True)
            if result is not None
        }


def are_linear(campaign: Campaign) -> bool:
    """Return whether the first run of each controller of a campaign can be computed at once."""
    for first in range(0, campaign.runs, campaign.cases):
        (run,) = campaign.planned(first, first + 1)
        if isinstance(run, ImpossibleRow) or run.controller.compiled:
            return False
        try:
            controller = make_controller(run.controller, run.settings.known)
        except FOREIGN_FAILURES:
            return False
        if why_not_batchable(run.settings, controller):
            return False
    return True


@contextmanager
def scored_runs(
    runs: RunSet, limits: Limits, *, workers: int | None = None
) -> Iterator[Iterator[ScoredRow]]:
    """
    Yield an iterator over all runs with their scores, step by step, in the order of their indices.

    They are computed while it is consumed, by `workers` processes, by default one per core; none
    is kept. Call `RunSet.require_sound` before: here a run that cannot be built has its reason.
    """
    scorer = Scorer(limits, at_once=False)
    count = worker_count(workers)
    size = max(1, min(_LARGEST_PART, runs.runs // (_PARTS_EACH * count)))
    parts = -(-runs.runs // size)

    def part(number: int) -> list[ScoredRow]:
        first = number * size
        return scorer.scored(runs.planned(first, min(first + size, runs.runs)))

    with in_processes(part, parts, count, chunk=1) as found:
        yield chain.from_iterable(found)
