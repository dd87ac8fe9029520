"""What scores say of runs that are not recorded: metrics and verdict."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.batch.judged_runs import JudgedRuns
from ddct_bringup.scores.metrics import metric_values
from ddct_bringup.scores.scoring import METRIC_NAMES, Entry
from ddct_bringup.verdict.criteria import raw_criteria
from ddct_bringup.verdict.limits import Limits
from ddct_bringup.verdict.state import slip_state
from ddct_bringup.verdict.verdict import verdict_of
from ddct_plant.base.timebase import steps_in
from ddct_plant.scenario.settings import RunSettings

_NO_TIMING = {'update_time_median_us': None, 'update_time_p99_us': None, 'worst_lateness_us': None}
_NOTHING_MISSED = {'missed_steps': 0, 'resends': 0}


def stacked_results(
    runs: Sequence[RunSettings], trajectory: Trajectory, limits: Limits
) -> list[Entry]:
    """
    Return the results of runs of one length, control start and score window.

    `trajectory` holds them as a stack in which all is finite. A result is what `scores.json` says
    of a run that counts, but for what needs a bag or a clock: the times of updates are None.
    """
    scenario = runs[0].scenario
    start = scenario.control_start_step
    window = tuple(steps_in('score_window_s', time) for time in scenario.score_window_s)
    of_loop = {'steps': trajectory.steps, **_NO_TIMING, **_NOTHING_MISSED}
    metrics: dict[str, Any] = {**metric_values(trajectory, start, window), **of_loop}
    judged = JudgedRuns(
        trajectory, start, scenario.score_window_s, metrics, limits.rules.engagements_a_day
    )
    by_metric = _rows({name: metrics[name] for name in METRIC_NAMES}, len(runs))
    by_criterion = _rows(raw_criteria(judged), len(runs))
    results = []
    for index, run in enumerate(runs):
        state = slip_state(one_or_more(trajectory, index), start, limits.rules)
        verdict = verdict_of(state, by_criterion[index], limits, run.scenario.name)
        counts = {'valid': True, 'reason': ''}
        results.append({'metrics': by_metric[index], 'verdict': verdict, **counts})
    return results


def one_or_more(stack: Trajectory, index: Any) -> Trajectory:
    """Return one run of a stack, or of some a stack."""
    return Trajectory({name: values[index] for name, values in stack.signals.items()})


def _rows(columns: Mapping[str, Any], runs: int) -> list[dict[str, float | int | None]]:
    """Return the values of each run by name, None for what is not finite."""
    lists = [_column(values, runs) for values in columns.values()]
    return [dict(zip(columns, row, strict=True)) for row in zip(*lists, strict=True)]


def _column(values: Any, runs: int) -> list[float | int | None]:
    if not isinstance(values, np.ndarray):
        return [values] * runs
    return [value if math.isfinite(value) else None for value in values.tolist()]
