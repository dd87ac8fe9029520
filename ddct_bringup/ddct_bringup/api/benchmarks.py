# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Judge controllers on the benchmark from Python."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

from ddct_bringup.api.shell.judging import judge_into, judged_of
from ddct_bringup.benchmark.cases import Cases
from ddct_bringup.benchmark.conduct import DEVELOPMENT, HELD_OUT
from ddct_bringup.benchmark.file_names import PAGE
from ddct_bringup.benchmark.result_types import Result
from ddct_bringup.evaluation.quantities import MAIN
from ddct_bringup.evaluation.summary import GroupSummary
from ddct_plant.base.errors import DdctError


class BenchmarkResults(NamedTuple):
    """Results of a finished benchmark of one controller."""

    table: Any
    """
    pandas DataFrame with a row per controller: the judged one, then those that run beside it.

    Columns for the sets `development` and `held_out`: `SET.success`, the share of successes, 0 to
    1, and `SET.FIGURE`, the median of each of the five figures over the successes.
    """
    result: Result
    """Content of `result.json`."""
    page: Path
    """Path of the page `report.html`."""


def benchmark(
    controller: str,
    out: str | Path,
    *,
    car: str | None = None,
    quick: bool = False,
    seed: int | None = None,
    workers: int | None = None,
) -> BenchmarkResults:
    """
    Judge a controller, by name or file, into the folder `out`, as `ddct benchmark` does.

    `car` is the car of all cases, by name or file, in place of those of the scenarios.
    `quick` runs a tenth of the cases. `seed` is that of a judge for the held-out cases. What is
    done stays in the folder, and another call goes on with it. Raise DdctError for a controller
    that cannot be judged.
    """
    import pandas

    cases, folder = Cases.packaged(quick=quick, car=car), Path(out)
    result, failed = judge_into(
        [judged_of(controller, cases)], cases, folder, seed, workers=workers
    )
    for name, reason in failed.items():
        raise DdctError(f'{name}: {reason}')
    (found,) = result.controllers
    sets = zip(*result.side_by_side(found), strict=True)
    columns = {
        f'{part}.{name}': values
        for part, groups in zip((DEVELOPMENT, HELD_OUT), sets, strict=True)
        for name, values in _columns(groups).items()
    }
    table = pandas.DataFrame(columns).rename_axis('controller')
    return BenchmarkResults(table, result, folder / PAGE)


def _columns(groups: Sequence[GroupSummary]) -> dict[str, dict[str, float | None]]:
    """Return the share of successes, and the median of each figure, by controller."""
    found = {'success': {each.controller: each.engaged.value for each in groups}}
    for key in MAIN:
        found[key] = {
            each.controller: each.quantities[key].quantiles.p50
            for each in groups
            if key in each.quantities
        }
    return found
