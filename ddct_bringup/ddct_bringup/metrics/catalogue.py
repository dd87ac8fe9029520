# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
All metrics and criteria, in the order of `scores.json`.

A new one is declared in the module of its subject, and nowhere else: scores, tables, verdict,
batch, campaigns, report and pages take it from here.
"""

from ddct_bringup.metrics import clutch, comfort, control, driveline, slip
from ddct_bringup.metrics.metric import Computed, Criterion, Metric
from ddct_bringup.metrics.shift import quantities as shift
from ddct_bringup.thesis.table_5_1 import TABLE_METRICS

_DECLARED: tuple[Computed, ...] = (
    *slip.QUANTITIES,
    *comfort.QUANTITIES,
    *clutch.QUANTITIES,
    *driveline.QUANTITIES,
    *control.QUANTITIES,
    *shift.QUANTITIES,
)


def _criterion_of(quantity: Computed) -> Criterion | None:
    if isinstance(quantity, Metric):
        return quantity.as_criterion() if quantity.criterion else None
    return quantity if isinstance(quantity, Criterion) else None


METRICS = {each.key: each for each in _DECLARED if isinstance(each, Metric)}
"""Every metric by its key in `scores.json`."""
CRITERIA = tuple(each for each in map(_criterion_of, _DECLARED) if each is not None)
"""Every criterion of the verdict."""
TABLE_5_1 = tuple(METRICS[name] for name in TABLE_METRICS)
"""Metrics that the thesis prints in Table 5.1."""
FURTHER = tuple(
    each for each in METRICS.values() if not each.from_timing and each not in TABLE_5_1
)
"""Metrics that are neither in Table 5.1 nor computed from `timing.json`."""
OF_SHIFT = tuple(each for each in FURTHER if each.of_shift)
"""Metrics that only a gear shift has."""
OF_EVERY_RUN = tuple(each for each in FURTHER if not each.of_shift)
"""Metrics of `FURTHER` that every run may have."""
CRITERION_UNITS = {each.key: each.unit for each in CRITERIA}


def _needing() -> dict[str, tuple[str, ...]]:
    found: dict[str, list[str]] = {}
    for each in (*METRICS.values(), *CRITERIA):
        for need in each.needs:
            found.setdefault(need, []).append(each.key)
    return {need: tuple(names) for need, names in found.items()}


NEEDED_BY = _needing()
"""Metrics and criteria that have no value without a quantity of a log, by its name."""
