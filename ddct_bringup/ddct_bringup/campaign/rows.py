# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""One of many runs: its scores without a bag, and its row."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from ddct_bringup.metrics.catalogue import CRITERIA, FURTHER, TABLE_5_1
from ddct_bringup.run.description import facts_of
from ddct_bringup.run.execution import recording_in_memory
from ddct_bringup.run.headless import run_headless
from ddct_bringup.run.plan import require_headless
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_bringup.scores.csv_text import OVER_FLOOR
from ddct_bringup.scores.floors import scores_with_ratios
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.scores.scoring import run_without_score, score_run
from ddct_bringup.verdict.limits import TRACTION, Limits
from ddct_controllers.architecture import make_architecture
from ddct_controllers.registry import Chosen, controller_label, make_controller
from ddct_plant.base.errors import FOREIGN_FAILURES, DdctError, ParameterError, printable
from ddct_plant.scenario.settings import RunSettings

INDEX, CONTROLLER, PATH, SEED = 'index', 'controller', 'path', 'seed'
"""Columns of a row before those of the varied keys."""
Row = Mapping[str, Any]
"""Row of `results.parquet`: values by column."""
SERIAL, VECTORISED = 'serial', 'vectorised'
"""Values of the column `path`: simulated step by step, or together with other runs."""
METRIC_COLUMNS = tuple(metric.key for metric in (*TABLE_5_1, *FURTHER))
"""Metrics of `scores.json` that are equal in every repetition of a run."""
CRITERION = 'criterion.'
"""Prefix of the column of a criterion, and of the traction."""
_JUDGED = (*(each.key for each in CRITERIA), TRACTION)
CRITERION_COLUMNS = tuple(f'{CRITERION}{name}' for name in _JUDGED)


def require_suitable(controller: Chosen, settings: RunSettings) -> None:
    """Raise an error of the user's controller; a controller that fails in a run gets its rows."""
    try:
        make_architecture(settings, make_controller(controller, settings))
    except ParameterError:
        raise
    except DdctError:
        return


def scored_headless(
    settings: RunSettings, controller: Chosen, limits: Limits, floors: Sequence[str] = ()
) -> ScoredRun:
    """
    Carry out a run headless and return its scores, with the reason if it fails.

    The metrics `floors` are set beside the least that any controller could have.
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
        scores = score_run(recording, name, limits, RunTiming())
        return scores_with_ratios(scores, settings, trajectory, floors) if floors else scores
    facts = facts_of(settings, name, settings.scenario.steps)
    failed = run_without_score(name, facts, reason)
    return replace(failed, over_floor=dict.fromkeys(floors))


def result_row(run: ScoredRun, varied: Mapping[str, Any], path: str = SERIAL) -> Row:
    """Return a run as one row: controller, path, varied values, metrics, verdict, criteria."""
    judged = {each.name: each.value for each in run.verdict.results}
    return {
        CONTROLLER: run.controller,
        PATH: path,
        **varied,
        **{name: run.metrics[name] for name in METRIC_COLUMNS},
        'valid': run.valid,
        'reason': run.reason,
        'verdict_state': run.verdict.state,
        'verdict_limits': run.verdict.limits,
        **{f'{CRITERION}{name}': judged.get(name) for name in _JUDGED},
        **{f'{OVER_FLOOR}{name}': ratio for name, ratio in run.over_floor.items()},
    }
