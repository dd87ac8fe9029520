# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Result of a benchmark from its rows: the content of `result.json`."""

import math
from collections.abc import Mapping

from ddct_bringup.benchmark import gaps
from ddct_bringup.benchmark.case_rows import CaseRows
from ddct_bringup.benchmark.comparison import (
    COMPARED,
    figures_of,
    non_dominated,
    pairs_of,
)
from ddct_bringup.benchmark.conduct import JudgedRows
from ddct_bringup.benchmark.evaluation import evaluations_of
from ddct_bringup.benchmark.kept_limits import limits_in
from ddct_bringup.benchmark.manifest import BenchmarkManifest, JudgedEntry
from ddct_bringup.benchmark.outcomes import share_of, successes_in
from ddct_bringup.benchmark.release import ReleaseRows
from ddct_bringup.benchmark.result_types import (
    BoardRow,
    CasesResult,
    JudgedResult,
    Method,
    Result,
)
from ddct_bringup.campaign.keys import SCENARIO
from ddct_bringup.campaign_report.printed_summary import MAIN
from ddct_bringup.campaign_report.statistics import attribution, outcome, paired
from ddct_bringup.verdict.limits import packaged_limits

SCHEMA_VERSION = 1
"""Schema version of `result.json`."""


def result_of(
    manifest: BenchmarkManifest,
    release: ReleaseRows,
    rows: Mapping[str, JudgedRows],
    failed: Mapping[str, str],
) -> Result:
    """
    Return the result of a benchmark.

    `release` has the rows of the development cases that ran, `rows` those of the judged
    controllers by name, `failed` the reasons of those that have none.
    """
    return {
        'schema_version': SCHEMA_VERSION,
        'release': manifest.origin.entry(),
        'cases': _cases(manifest, release),
        'judge_seed': manifest.judge_seed,
        'method': _method(),
        'controllers': [
            _judged(entry, manifest, release, rows.get(entry.name), failed.get(entry.name))
            for entry in manifest.controllers
        ],
        'board': _board(manifest, release, rows),
    }


def _cases(manifest: BenchmarkManifest, release: ReleaseRows) -> CasesResult:
    cases = manifest.run_cases
    spec = cases.planned.spec
    return {
        'digest': cases.digest,
        'quick': cases.quick,
        'scenarios': list(spec.values_of(SCENARIO)),
        'samples': spec.samples,
        'floor_samples': spec.floor_samples,
        'varied': list(spec.vary),
        'development_seed': spec.root,
        'release_rows': release.origin.entry(),
        'other_code': release.other_code(manifest.origin),
    }


def _method() -> Method:
    return {
        'share_interval': outcome.METHOD,
        'difference_interval': paired.METHOD,
        'gap_of_shares': gaps.OF_SHARES,
        'gap_of_quantities': gaps.OF_QUANTITIES,
        'causes': attribution.METHOD,
        'confidence': outcome.CONFIDENCE,
        'non_dominated': list(COMPARED),
    }


def _judged(
    entry: JudgedEntry,
    manifest: BenchmarkManifest,
    release: ReleaseRows,
    rows: JudgedRows | None,
    error: str | None,
) -> JudgedResult:
    """Return the result of one controller; all its parts are None without its rows."""
    found: JudgedResult = {
        'controller': entry.name,
        'digests': dict(entry.digests),
        'held_out_seed': entry.held_out_seed,
        'error': error,
        'development': None,
        'held_out': None,
        'gaps': None,
        'development_pairs': None,
        'held_out_pairs': None,
    }
    if rows is None:
        return found
    development = _development(rows, release).only(rows.held_out.controllers)
    varied = list(manifest.run_cases.planned.spec.vary)
    sets = ((development, release.unavoidable), (rows.held_out, rows.unavoidable))
    ours, theirs = (
        evaluations_of(each, unavoidable, packaged_limits(), varied, entry.name)
        for each, unavoidable in sets
    )
    return {
        **found,
        'development': ours,
        'held_out': theirs,
        'gaps': gaps.gaps_of(development.of(entry.name), rows.held_out.of(entry.name)),
        'development_pairs': pairs_of(development, entry.name),
        'held_out_pairs': pairs_of(rows.held_out, entry.name),
    }


def _development(rows: JudgedRows, release: ReleaseRows) -> CaseRows:
    """Return the development rows of a judged controller, and those of the release."""
    if rows.development is None:
        return release.rows
    return rows.development.beside(release.rows)


def _board(
    manifest: BenchmarkManifest, release: ReleaseRows, rows: Mapping[str, JudgedRows]
) -> list[BoardRow]:
    """Return every controller on the development cases, the judged ones first."""
    together = release.rows
    for each in rows.values():
        if each.development is not None:
            together = each.development.beside(together)
    judged = [entry.name for entry in manifest.controllers if entry.name in rows]
    others = [name for name in together.controllers if name not in judged]
    together = together.only([*judged, *others])
    best = non_dominated(together)
    found: list[BoardRow] = []
    for name in together.controllers:
        columns = together.of(name)
        success = int(successes_in(columns).sum())
        found.append(
            {
                'controller': name,
                'judged': name in judged,
                'success': share_of(success, together.cases),
                'limits': limits_in(together, name, release.unavoidable, packaged_limits()),
                'medians': {
                    key: value if math.isfinite(value) else None
                    for key, value in zip(MAIN, figures_of(together, name)[1:], strict=True)
                },
                'non_dominated': name in best,
            }
        )
    return found
