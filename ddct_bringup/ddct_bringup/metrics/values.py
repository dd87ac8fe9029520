# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Values of the metrics and criteria of one run, or of a stack of runs."""

import math
from collections.abc import Iterable, Mapping

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.catalogue import CRITERIA, METRICS
from ddct_bringup.metrics.engagement import Engagement, Values
from ddct_bringup.metrics.metric import Computed, Metrics, finite
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_plant.base.timebase import steps_in


def compute_metrics(
    trajectory: Trajectory,
    *,
    control_start_s: float,
    score_window_s: tuple[float, float],
    timing: RunTiming | None = None,
) -> Metrics:
    """Compute every metric; times are scenario times in s, multiples of 10 ms."""
    return metrics_of(
        Engagement(
            trajectory,
            steps_in('control_start_s', control_start_s),
            window_steps(score_window_s),
            timing=timing,
        )
    )


def window_steps(score_window_s: tuple[float, float]) -> tuple[int, int]:
    """Return the first and the last scored step of a window in s."""
    first, last = (steps_in('score_window_s', time) for time in score_window_s)
    return first, last


def metrics_of(engagement: Engagement) -> Metrics:
    """Return the value of every metric of one run, None where it is not defined."""
    return {key: finite(value) for key, value in raw_metrics(engagement).items()}


def criteria_of(
    engagement: Engagement, metrics: Mapping[str, Values | None]
) -> dict[str, float | int | None]:
    """Return the value of every criterion of one run by name, None where it is not defined."""
    return {key: finite(value) for key, value in raw_criteria(engagement, metrics).items()}


def raw_metrics(engagement: Engagement) -> dict[str, Values | None]:
    """Return the values of all metrics by key, (R,) for many runs, not finite where undefined."""
    return _raw(METRICS.values(), engagement)


def raw_criteria(
    engagement: Engagement, metrics: Mapping[str, Values | None]
) -> dict[str, Values | None]:
    """
    Return the values of all criteria by name, (R,) for many runs, not finite where undefined.

    A criterion that is a metric too has the value in `metrics`.
    """
    own = _raw((each for each in CRITERIA if not each.metric), engagement)
    return {each.key: metrics[each.metric] if each.metric else own[each.key] for each in CRITERIA}


def existing(engagement: Engagement) -> dict[str, bool | np.ndarray]:
    """Return by criterion whether it is defined for the plant, (R,) for many runs."""
    with np.errstate(all='ignore'):
        return {criterion.key: criterion.exists(engagement) for criterion in CRITERIA}


def _raw(quantities: Iterable[Computed], engagement: Engagement) -> dict[str, Values | None]:
    with np.errstate(all='ignore'):  # what is not finite becomes None
        return {each.key: each.of(engagement) for each in quantities}


def rows_of(
    columns: Mapping[str, Values | None], runs: int
) -> list[dict[str, float | int | None]]:
    """Return the values of each of R runs by name, None for a value that is not finite."""
    lists = [_column(values, runs) for values in columns.values()]
    return [dict(zip(columns, row, strict=True)) for row in zip(*lists, strict=True)]


def _column(values: Values | None, runs: int) -> list[float | int | None]:
    if not isinstance(values, np.ndarray):
        return [values] * runs
    return [value if math.isfinite(value) else None for value in values.tolist()]
