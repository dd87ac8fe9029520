# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""One of many runs: its scores without a bag."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ddct_bringup.bag.run_facts import RunFacts
from ddct_bringup.metrics.catalogue import REPEATABLE
from ddct_bringup.run.execution import recording_in_memory
from ddct_bringup.run.headless import run_headless
from ddct_bringup.run.plan import require_headless
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.scores.scoring import run_without_score, score_run
from ddct_bringup.verdict.limits import Limits
from ddct_controllers.architecture import loop_needs
from ddct_controllers.registry import Chosen, controller_label
from ddct_plant.base.errors import FOREIGN_FAILURES, DdctError, ParameterError, printable
from ddct_plant.scenario.settings import RunSettings

INDEX, CONTROLLER, PATH, SEED = 'index', 'controller', 'path', 'seed'
"""Columns of a row before those of the varied keys."""
SERIAL, VECTORISED = 'serial', 'vectorised'
"""Values of the column `path`: simulated step by step, or together with other runs."""
STATE = 'state'
"""Column of the state of a run."""
METRIC_COLUMNS = tuple(metric.key for metric in REPEATABLE)
"""Figures and metrics of `scores.json` that a run alone gives, equal in every repetition."""


@dataclass(frozen=True)
class ScoredRow:
    """A run of a set with its scores, and the values that distinguish it from the others."""

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


def require_suitable(controller: Chosen, settings: RunSettings) -> None:
    """Raise an error of the user's controller; a controller that fails in a run gets its rows."""
    try:
        loop_needs(controller, settings.known)
    except ParameterError:
        raise
    except DdctError:
        return


def scored_headless(settings: RunSettings, controller: Chosen, limits: Limits) -> ScoredRun:
    """
    Carry out a run headless and return its scores, with the reason if it fails.

    It has no wall-clock metrics: a row is equal in every repetition.
    """
    name = controller_label(controller)
    try:
        require_headless(settings)
        trajectory = run_headless(settings, controller)
    except DdctError as error:
        reason = str(error)
    except FOREIGN_FAILURES as error:  # a failed run must not end the others
        reason = printable(f'{type(error).__name__}: {error}')
    else:
        # Without update times, since no wall-clock time is measured.
        recording = recording_in_memory(settings, name, trajectory)
        return score_run(recording, name, limits, RunTiming())
    facts = RunFacts.of(settings, name, settings.scenario.steps)
    return run_without_score(name, facts, reason)
