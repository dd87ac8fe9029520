# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Results of a batch and of its runs step by step, each with the signals that it comes from."""

from typing import Any
from unittest import mock

from batch_runs import signals_until_end

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.batch import run_batch as batch
from ddct_bringup.batch.simulate import simulate_batch
from ddct_bringup.campaign import rows
from ddct_bringup.run.headless import run_headless
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.from_python import chosen_from

LIMITS = packaged_limits()


def step_by_step(settings, controller) -> tuple[ScoredRun, Trajectory]:
    """Return the scores of a run in a campaign that goes step by step, and its signals."""
    kept = []

    def run(*arguments):
        kept.append(run_headless(*arguments))
        return kept[-1]

    with mock.patch.object(rows, 'run_headless', run):
        scores = rows.scored_headless(settings, chosen_from(controller, 'same'), LIMITS)
    return scores, kept[-1]


def batch_of(runs) -> list[tuple[ScoredRun | None, dict[str, Any] | None]]:
    """
    Return for each run what `run_batch` gives, and its signals, or None if they are unsure.

    No two of the runs share their settings, by which their signals are found.
    """
    signals: dict[int, dict[str, Any] | None] = {}

    def simulated(settings, controllers, factor=1.0):
        stack = simulate_batch(settings, controllers, factor)
        if factor == 1.0:  # else the stack tests whether rounding grows
            found = (signals_until_end(stack, index) for index in range(len(settings)))
            signals.update(zip(map(id, settings), found, strict=True))
        return stack

    with mock.patch.object(batch, 'simulate_batch', simulated):
        results = batch.run_batch(runs, LIMITS)
    return [(result, signals[id(run[0])]) for result, run in zip(results, runs, strict=True)]
