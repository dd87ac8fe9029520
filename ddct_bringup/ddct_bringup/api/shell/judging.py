# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Judge controllers on the cases of the benchmark, from their names to the page."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from ddct_bringup.benchmark.cases import Cases
from ddct_bringup.benchmark.conduct import Options, carry_out_benchmark
from ddct_bringup.benchmark.judged import Judged
from ddct_bringup.benchmark.report.folder import write_result
from ddct_bringup.benchmark.result_types import Result
from ddct_bringup.benchmark.update_times import write_update_times
from ddct_bringup.campaign.rows import require_suitable
from ddct_controllers.registry import controller_spec


def judged_of(name: str, cases: Cases) -> Judged:
    """Return a controller, by name or file; raise DdctError where it cannot be judged."""
    require_suitable(controller_spec(name), cases.planned.run(0).settings)
    return Judged.of(name)


def judge_into(
    judged: Sequence[Judged],
    cases: Cases,
    out: Path,
    seed: int | None,
    *,
    workers: int | None = None,
    stopped: Callable[[], bool] = lambda: False,
) -> tuple[Result, Mapping[str, str]]:
    """
    Judge controllers into the folder `out` and write its result and page.

    `seed` is that of a judge for the held-out cases, None for that of the release. Return the
    content of `result.json`, and the reasons of controllers that failed, by name. Raise DdctError
    for what cannot be used, KeyboardInterrupt when `stopped()` becomes true: another call goes on
    with what is done.
    """
    failed = carry_out_benchmark(judged, cases, out, seed, Options(workers, stopped))
    write_update_times([each for each in judged if each.name not in failed], cases, out)
    return write_result(out, failed), failed
