# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Values of the metrics of one run, or of a stack of runs."""

import math
from collections.abc import Mapping

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.catalogue import JERK_OVER_LEAST, METRICS
from ddct_bringup.metrics.engagement import Engagement, Values
from ddct_bringup.metrics.metric import Metrics, finite
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


def null_reasons(engagement: Engagement, metrics: Metrics) -> Mapping[str, str]:
    """Return the reason of every metric without a value of one run, by its key."""
    return {
        key: METRICS[key].why_null(engagement)
        for key, value in metrics.items()
        if value is None and key != JERK_OVER_LEAST.key
    }


def raw_metrics(engagement: Engagement) -> dict[str, Values | None]:
    """Return the values of all metrics by key, (R,) for many runs, not finite where undefined."""
    with np.errstate(all='ignore'):  # what is not finite becomes None
        return {each.key: each.of(engagement) for each in METRICS.values()}


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
