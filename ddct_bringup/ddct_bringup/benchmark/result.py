# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Result of a benchmark from its rows: the content of `result.json`."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import reduce

import pyarrow as pa

from ddct_bringup.benchmark.case_rows import CaseRows
from ddct_bringup.benchmark.comparison import (
    figures_in,
    gaps_between,
    paired_results,
    pairs_of,
)
from ddct_bringup.benchmark.conduct import JudgedRows
from ddct_bringup.benchmark.evaluated import MAIN
from ddct_bringup.benchmark.evaluation import evaluations_of, quantities_in
from ddct_bringup.benchmark.outcomes import share_of_successes
from ddct_bringup.benchmark.plan import JudgedEntry, RecordedBenchmark
from ddct_bringup.benchmark.release import ReleaseRows
from ddct_bringup.benchmark.result_types import (
    BoardRow,
    CasesResult,
    JudgedResult,
    Method,
    Result,
)
from ddct_bringup.benchmark.statistics.case_figures import CaseFigures
from ddct_bringup.benchmark.statistics.dominance import dominators_of, level_among
from ddct_bringup.benchmark.statistics.held_out_gaps import METHOD as GAP_METHOD
from ddct_bringup.campaign.keys import SCENARIO
from ddct_bringup.campaign_report.statistics import attribution, outcome, paired

SCHEMA_VERSION = 3
"""Schema version of `result.json`."""


def result_of(
    recorded: RecordedBenchmark,
    release: ReleaseRows | None,
    rows: Mapping[str, JudgedRows],
    failed: Mapping[str, str],
) -> Result:
    """
    Return the result of a benchmark.

    `release` has the rows of the development cases that ran, None where a car was given. `rows`
    has those of the judged controllers by name, `failed` the reasons of those that have none.
    """
    board = _board_rows(recorded, release, rows)
    figures = None if recorded.plan.quick else figures_in(board)
    return Result(
        schema_version=SCHEMA_VERSION,
        release=recorded.origin,
        cases=_cases(recorded, release),
        judge_seed=recorded.plan.judge_seed,
        method=_method(figures),
        controllers=[
            _judged(entry, recorded, release, rows[entry.name], figures)
            if entry.name in rows
            else _not_judged(entry, failed.get(entry.name))
            for entry in recorded.plan.controllers
        ],
        board=_board(board, rows, figures),
    )


def _cases(recorded: RecordedBenchmark, release: ReleaseRows | None) -> CasesResult:
    cases = recorded.cases
    spec = cases.planned.spec
    return CasesResult(
        digest=cases.digest,
        quick=cases.quick,
        car=cases.car,
        left_out=dict(cases.left_out),
        scenarios=list(spec.values_of(SCENARIO)),
        samples=spec.samples,
        varied=list(spec.vary),
        development_seed=spec.root,
        release_rows=release.origin if release else None,
        other_code=release.other_code(recorded.origin) if release else '',
    )


def _method(figures: dict[str, CaseFigures] | None) -> Method:
    return Method(
        share_interval=outcome.METHOD,
        difference_interval=paired.METHOD,
        gap=GAP_METHOD,
        causes=attribution.METHOD,
        confidence=outcome.CONFIDENCE,
        figures=list(MAIN),
        dominance_level=level_among(len(figures)) if figures else None,
    )


def _not_judged(entry: JudgedEntry, error: str | None) -> JudgedResult:
    """Return the result of a controller without rows."""
    return JudgedResult(
        controller=entry.name,
        digests=dict(entry.digests),
        held_out_seed=entry.held_out_seed,
        error=error,
        development=None,
        held_out=None,
        gaps=None,
        dominance=None,
        development_pairs=None,
        held_out_pairs=None,
    )


def _judged(
    entry: JudgedEntry,
    recorded: RecordedBenchmark,
    release: ReleaseRows | None,
    rows: JudgedRows,
    figures: dict[str, CaseFigures] | None,
) -> JudgedResult:
    """Return the result of one controller; `figures` has those of all on development cases."""
    name = entry.name
    development = _development(rows, release).only(rows.held_out.controllers)
    varied = list(recorded.cases.planned.spec.vary)
    return replace(
        _not_judged(entry, None),
        development=evaluations_of(development, varied, name),
        held_out=evaluations_of(rows.held_out, varied, name),
        gaps=gaps_between(development.of(name), rows.held_out.of(name)),
        dominance=paired_results(figures, name) if figures else None,
        development_pairs=pairs_of(development, name),
        held_out_pairs=pairs_of(rows.held_out, name),
    )


def _development(rows: JudgedRows, release: ReleaseRows | None) -> CaseRows:
    """Return the development rows of a judged controller, and those of the release."""
    return _together([rows.development, release.rows if release else None])


def _together(found: Iterable[CaseRows | None]) -> CaseRows:
    """Return those rows of the same cases that there are; none for no rows."""
    there = [each for each in found if each is not None]
    return reduce(CaseRows.beside, there) if there else CaseRows(pa.table({}))


def _board_rows(
    recorded: RecordedBenchmark,
    release: ReleaseRows | None,
    rows: Mapping[str, JudgedRows],
) -> CaseRows:
    """Return the rows of every controller on the development cases, the judged ones first."""
    developments = [each.development for each in rows.values()]
    together = _together([*developments, release.rows if release else None])
    judged = [entry.name for entry in recorded.plan.controllers if entry.name in rows]
    others = [name for name in together.controllers if name not in judged]
    return together.only([*judged, *others])


def _board(
    together: CaseRows, judged: Mapping[str, JudgedRows], figures: dict[str, CaseFigures] | None
) -> list[BoardRow]:
    """Return every controller on the development cases."""
    dominators = dominators_of(figures) if figures else {}
    found: list[BoardRow] = []
    for name in together.controllers:
        columns = together.of(name)
        found.append(
            BoardRow(
                controller=name,
                judged=name in judged,
                success=share_of_successes(columns),
                quantities=quantities_in(columns, MAIN),
                dominated_by=dominators.get(name),
            )
        )
    return found
