# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
All metrics, in the order of `scores.json`.

A new one is declared in the module of its subject, and nowhere else: scores, tables, limits,
batch, campaigns, report and pages take it from here.
"""

from ddct_bringup.metrics import control, figures, limited, table_5_1
from ddct_bringup.metrics.metric import Metric
from ddct_bringup.metrics.shift import quantities as shift
from ddct_bringup.thesis.table_metrics import TABLE_METRICS

_DECLARED: tuple[Metric, ...] = (
    *figures.QUANTITIES,
    *shift.QUANTITIES,
    *table_5_1.QUANTITIES,
    *limited.QUANTITIES,
    *control.QUANTITIES,
)
METRICS = {
    each.key: each for each in sorted(_DECLARED, key=lambda each: (not each.figure, each.of_shift))
}
"""Every metric by its key in `scores.json`: figures first, those of a gear shift after others."""
FIGURES = tuple(each for each in METRICS.values() if each.figure)
"""Metrics that a run is judged by."""
OTHERS = tuple(each for each in METRICS.values() if not each.figure)
"""Metrics that no run is judged by."""
JERK_OVER_LEAST = METRICS['peak_jerk_over_least']
"""Figure that a convex program gives."""
TABLE_5_1 = tuple(METRICS[name] for name in TABLE_METRICS)
"""Metrics that the thesis prints in Table 5.1."""
REPEATABLE = tuple(
    each for each in METRICS.values() if not each.from_timing and each is not JERK_OVER_LEAST
)
"""Metrics that a run alone gives, equal in every repetition."""


def _needing() -> dict[str, tuple[str, ...]]:
    found: dict[str, list[str]] = {}
    for each in METRICS.values():
        for need in each.needs:
            found.setdefault(need, []).append(each.key)
    return {need: tuple(names) for need, names in found.items()}


NEEDED_BY = _needing()
"""Metrics that have no value without a quantity of a log, by its name."""
