# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Score the runs of a run set: those that a batch takes at once, all others step by step."""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import chain

import numpy as np

from ddct_bringup.bag.run_facts import RunFacts
from ddct_bringup.batch.batchable import needs_trial, why_not_batchable
from ddct_bringup.batch.controllers.trial import why_not_linear
from ddct_bringup.batch.run_batch import run_batch
from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.rows import SERIAL, VECTORISED, ScoredRow, scored_headless
from ddct_bringup.campaign.run_set import ImpossibleRow, PlannedRow, RunSet
from ddct_bringup.many_runs.blocks import block_size, blocks_of
from ddct_bringup.many_runs.engine import engine_of
from ddct_bringup.many_runs.work import Work
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.scores.scoring import run_without_score
from ddct_bringup.verdict.limits import Limits
from ddct_controllers.interface import Controller
from ddct_controllers.registry import make_controller
from ddct_plant.base.errors import FOREIGN_FAILURES
from ddct_plant.scenario.settings import KnownSettings


@dataclass
class Scorer:
    """Scores runs, those that a batch takes together."""

    limits: Limits
    at_once: bool = True
    """Whether runs that a batch takes are computed together, to 1e-9 of the run step by step."""

    def scored(self, runs: Iterable[PlannedRow | ImpossibleRow]) -> list[ScoredRow]:
        """
        Return every run with its scores, in their order.

        A failed run, and one whose settings cannot be built, has its reason.
        """
        planned = list(runs)
        # A value that is not finite becomes a reason in the row of its run.
        with np.errstate(all='ignore'):
            found = self._together(planned)
            return [self._of(run, found.get(place)) for place, run in enumerate(planned)]

    def without_result(self, run: PlannedRow | ImpossibleRow, why: str) -> ScoredRow:
        """Return a run that ends the process in which it is computed, with the reason."""
        name = run.controller.name
        facts = RunFacts.of(run.settings, name, 0) if isinstance(run, PlannedRow) else None
        scores = run_without_score(name, facts, why)
        return ScoredRow(run.index, name, run.seed, run.varied, scores, SERIAL)

    def _of(self, run: PlannedRow | ImpossibleRow, found: ScoredRun | None) -> ScoredRow:
        name, path, scores = run.controller.name, VECTORISED, found
        if isinstance(run, ImpossibleRow):
            path, scores = SERIAL, run_without_score(name, None, str(run.error))
        elif scores is None:
            path = SERIAL
            scores = scored_headless(run.settings, run.controller, self.limits)
        return ScoredRow(run.index, name, run.seed, run.varied, scores, path)

    def _together(self, runs: Sequence[PlannedRow | ImpossibleRow]) -> dict[int, ScoredRun]:
        """Return the scores of the runs that can be computed at once, by their places."""
        suited = _suited(runs) if self.at_once else {}
        pairs = [(run.settings, controller) for run, controller in suited.values()]
        results = run_batch(pairs, self.limits)
        return {
            place: result
            for place, result in zip(suited, results, strict=True)
            if result is not None
        }


def are_together(campaign: Campaign) -> bool:
    """Return whether a batch takes the first run of at least half of the controllers."""
    firsts = [*campaign.planned_at(range(0, campaign.runs, campaign.cases))]
    return 2 * len(_suited(firsts)) >= len(campaign.controllers)


def _suited(
    runs: Sequence[PlannedRow | ImpossibleRow],
) -> dict[int, tuple[PlannedRow, Controller]]:
    """Return the runs that a batch takes, with their controllers, by their places."""
    made: dict[int, tuple[KnownSettings, Controller]] = {}
    found = {}
    for place, run in enumerate(runs):
        if isinstance(run, ImpossibleRow) or run.controller.compiled:
            continue
        chosen, known = run.controller, run.settings.known
        if id(chosen) not in made or made[id(chosen)][0] != known:  # runs in turn share one
            try:
                made[id(chosen)] = known, make_controller(chosen, known)
            except FOREIGN_FAILURES:
                continue  # the run step by step gives the reason
        controller = made[id(chosen)][1]
        if not why_not_batchable(run.settings, controller):
            found[place] = run, controller
    foreign = {id(each): each for _, each in found.values() if needs_trial(each)}
    failed = {
        key for key, why in zip(foreign, why_not_linear([*foreign.values()]), strict=True) if why
    }
    return {place: each for place, each in found.items() if id(each[1]) not in failed}


@dataclass(frozen=True)
class ScoredRuns(Work[int, list[ScoredRow]]):
    """Runs of a set by their indices, and their scores."""

    runs: RunSet
    scorer: Scorer

    def of_block(self, items: Sequence[int]) -> list[ScoredRow]:
        """Return some runs with their scores."""
        return self.scorer.scored(self.runs.planned_at(items))

    def joined(self, parts: Sequence[list[ScoredRow]]) -> list[ScoredRow]:
        """Return the runs of all parts."""
        return [*chain.from_iterable(parts)]

    def without_result(self, item: int, why: str) -> list[ScoredRow]:
        """Return a run that ends its process, with the reason."""
        return [self.scorer.without_result(run, why) for run in self.runs.planned_at([item])]


@contextmanager
def scored_runs(
    runs: RunSet, limits: Limits, *, workers: int | None = None
) -> Iterator[Iterator[ScoredRow]]:
    """
    Yield an iterator over all runs with their scores, step by step, in the order of their indices.

    They are computed while it is consumed, by `workers` processes, by default one per core; none
    is kept. Call `RunSet.require_sound` before: here a run that cannot be built has its reason.
    """
    blocks = blocks_of(range(runs.runs), block_size(runs.runs))
    with engine_of(ScoredRuns(runs, Scorer(limits, at_once=False)), workers) as engine:
        yield chain.from_iterable(engine.in_order(blocks))
