# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Result of a benchmark from its rows: the content of `result.json`."""

from collections.abc import Mapping
from functools import reduce

from ddct_bringup.benchmark.case_rows import CaseRows
from ddct_bringup.benchmark.conduct import JudgedRows
from ddct_bringup.benchmark.plan import JudgedEntry, RecordedBenchmark
from ddct_bringup.benchmark.release import ReleaseRows
from ddct_bringup.benchmark.result_types import (
    CasesResult,
    ComparisonMethod,
    JudgedResult,
    Result,
)
from ddct_bringup.campaign.keys import SCENARIO
from ddct_bringup.evaluation.dominance import level_among
from ddct_bringup.evaluation.held_out_gaps import METHOD as GAP_METHOD
from ddct_bringup.evaluation.quantities import MAIN
from ddct_bringup.evaluation.summarise import gaps_between, summarise

SCHEMA_VERSION = 4
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
    quick = recorded.plan.quick
    varied = tuple(recorded.cases.planned.spec.vary)
    development = _development(recorded, release, rows)
    among = len(development.controllers) if development else 0
    return Result(
        schema_version=SCHEMA_VERSION,
        release=recorded.origin,
        cases=_cases(recorded, release),
        judge_seed=recorded.plan.judge_seed,
        comparison=ComparisonMethod(
            gap=GAP_METHOD,
            figures=MAIN,
            dominance_level=level_among(among) if among > 1 and not quick else None,
        ),
        development=summarise(
            development.table, development.by(varied, tuple(rows), dominance=not quick)
        )
        if development
        else None,
        controllers=tuple(
            _judged(entry, varied, development, rows.get(entry.name), failed.get(entry.name))
            for entry in recorded.plan.controllers
        ),
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


def _judged(
    entry: JudgedEntry,
    varied: tuple[str, ...],
    development: CaseRows | None,
    rows: JudgedRows | None,
    error: str | None,
) -> JudgedResult:
    """Return the result of one controller; without rows it has the reason."""
    held_out = gaps = None
    if rows and development:
        name, cases = entry.name, rows.held_out
        held_out = summarise(cases.table, cases.by(varied, (name,)))
        gaps = gaps_between(development.only([name]).table, cases.only([name]).table)
    return JudgedResult(
        controller=entry.name,
        digests=dict(entry.digests),
        held_out_seed=entry.held_out_seed,
        error=error,
        held_out=held_out,
        gaps=gaps,
    )


def _development(
    recorded: RecordedBenchmark, release: ReleaseRows | None, rows: Mapping[str, JudgedRows]
) -> CaseRows | None:
    """Return the rows of every controller on the development cases, the judged ones first."""
    there = [each.development for each in rows.values() if each.development]
    if release:
        there.append(release.rows)
    if not there:
        return None
    together = reduce(CaseRows.beside, there)
    judged = [entry.name for entry in recorded.plan.controllers if entry.name in rows]
    return together.only([*judged, *together.controllers])
