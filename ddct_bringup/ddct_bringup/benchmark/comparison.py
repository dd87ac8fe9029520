# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Comparison of controllers on the same cases, and of one on development and held-out cases."""

import math

import numpy as np

from ddct_bringup.benchmark.case_rows import CaseRows
from ddct_bringup.benchmark.evaluated import EVALUATED, Columns, values_of
from ddct_bringup.benchmark.outcomes import case_figures_in, outcomes_in
from ddct_bringup.benchmark.result_types import FigureInCases, Gap, PairedResult
from ddct_bringup.benchmark.statistics.case_figures import CaseFigures
from ddct_bringup.benchmark.statistics.dominance import FigureComparison, compare
from ddct_bringup.benchmark.statistics.held_out_gaps import gaps_of
from ddct_bringup.campaign.keys import SCENARIO
from ddct_bringup.campaign_report.statistics import paired
from ddct_bringup.campaign_report.summary_types import DifferenceSummary, PairSummary


def figures_in(rows: CaseRows) -> dict[str, CaseFigures]:
    """Return the successes and the five figures of each controller, by its name."""
    return {name: case_figures_in(rows.of(name)) for name in rows.controllers}


def paired_results(figures: dict[str, CaseFigures], judged: str) -> list[PairedResult]:
    """Return the comparison of the judged controller with each of the others."""
    return [_paired_result(figures, judged, other) for other in figures if other != judged]


def _paired_result(figures: dict[str, CaseFigures], judged: str, other: str) -> PairedResult:
    ours = compare(figures[judged], figures[other])
    theirs = compare(figures[other], figures[judged])
    return PairedResult(
        other=other,
        cases=ours.cases,
        dominates=ours.dominates(among=len(figures)),
        dominated=theirs.dominates(among=len(figures)),
        figures=[_figure_in_cases(each) for each in ours.figures],
    )


def _figure_in_cases(found: FigureComparison) -> FigureInCases:
    median = found.median_difference
    return FigureInCases(
        name=found.name,
        better=found.better,
        worse=found.worse,
        left_out=found.null,
        median_difference=median if math.isfinite(median) else None,
    )


def gaps_between(development: Columns, held_out: Columns) -> list[Gap]:
    """
    Return the gap of each of the five figures between the runs of both sets.

    The ranks are those within the scenarios, which a column names where there are several.
    """
    ours, theirs = ((case_figures_in(each), _scenarios(each)) for each in (development, held_out))
    return [
        Gap(
            name=gap.name,
            p_value=gap.p_value,
            worse=gap.worse,
            left_out=gap.null,
            differs=gap.differs,
        )
        for gap in gaps_of(ours, theirs)
    ]


def _scenarios(columns: Columns) -> np.ndarray:
    one = np.full(len(columns['valid']), '')
    return columns.get(SCENARIO, one).astype(str)


def pairs_of(rows: CaseRows, judged: str) -> list[PairSummary]:
    """Return the judged controller less each of the others, case by case."""
    return [_pair(rows, judged, other) for other in rows.controllers if other != judged]


def _pair(rows: CaseRows, first: str, second: str) -> PairSummary:
    ours, theirs = rows.of(first), rows.of(second)
    outcomes = outcomes_in(ours), outcomes_in(theirs)
    differences: list[DifferenceSummary] = []
    for key, quantity in EVALUATED.items():
        mine, others = values_of(ours, key), values_of(theirs, key)
        if mine is None or others is None:
            continue
        found = paired.difference_of(mine, others, outcomes)
        differences.append(DifferenceSummary(key, quantity.unit, found))
    return PairSummary(
        first=first,
        second=second,
        varied={},
        outcomes=paired.joint_outcomes(*outcomes),
        no_interval='',
        differences=differences,
    )
