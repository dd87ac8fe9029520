# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Comparison of controllers on the same cases: who is not dominated, and paired differences."""

import numpy as np

from ddct_bringup.benchmark.case_rows import CaseRows
from ddct_bringup.benchmark.outcomes import outcomes_in, successes_in
from ddct_bringup.campaign_report.evaluated_quantities import QUANTITIES
from ddct_bringup.campaign_report.printed_summary import MAIN
from ddct_bringup.campaign_report.results import is_number
from ddct_bringup.campaign_report.statistics import paired
from ddct_bringup.campaign_report.summary_types import DifferenceSummary, PairSummary
from ddct_bringup.verdict.state import ENGAGED

COMPARED = ('share of runs that are no success', *(f'P50 of {name}' for name in MAIN))
"""
Figures of a controller that decide whether it is dominated; of each less is better.

A median is over all cases, and a run that did not engage counts as worse than any value. Among
engaged runs alone a controller that fails in the hard cases would look better.
"""


def figures_of(rows: CaseRows, controller: str) -> tuple[float, ...]:
    """Return the figures `COMPARED` of a controller, infinite where half of the runs fail."""
    columns = rows.of(controller)
    engaged = outcomes_in(columns) == ENGAGED
    found = [1.0 - float(np.mean(successes_in(columns)))]
    for name in MAIN:
        values = np.where(engaged, np.abs(columns[name]), np.inf)
        values = values[~np.isnan(values)]
        found.append(float(np.quantile(values, 0.5, method='higher')) if len(values) else np.inf)
    return tuple(found)


def non_dominated(rows: CaseRows) -> set[str]:
    """
    Return the controllers that no other one dominates.

    One dominates another if none of its figures `COMPARED` is worse and one is better.
    """
    figures = {name: figures_of(rows, name) for name in rows.controllers}
    return {
        name
        for name, ours in figures.items()
        if not any(_dominates(theirs, ours) for theirs in figures.values())
    }


def _dominates(first: tuple[float, ...], second: tuple[float, ...]) -> bool:
    return first != second and all(a <= b for a, b in zip(first, second, strict=True))


def pairs_of(rows: CaseRows, judged: str) -> list[PairSummary]:
    """Return the judged controller less each of the others, case by case."""
    return [_pair(rows, judged, other) for other in rows.controllers if other != judged]


def _pair(rows: CaseRows, first: str, second: str) -> PairSummary:
    ours, theirs = rows.of(first), rows.of(second)
    outcomes = outcomes_in(ours), outcomes_in(theirs)
    joint = paired.joint_outcomes(*outcomes)
    differences: list[DifferenceSummary] = []
    for quantity in QUANTITIES:
        if not is_number(ours.get(quantity.key)):
            continue
        found = paired.difference_of(ours[quantity.key], theirs[quantity.key], outcomes)
        differences.append(
            {
                'name': quantity.key,
                'unit': quantity.unit,
                'cases': found.cases,
                **found.quantiles,
                'interval': list(found.interval) if found.interval else None,
            }
        )
    return {
        'first': first,
        'second': second,
        'varied': {},
        'cases': joint.cases,
        'both': joint.both,
        'first_only': joint.first_only,
        'second_only': joint.second_only,
        'neither': joint.neither,
        'no_interval': '',
        'differences': differences,
    }
