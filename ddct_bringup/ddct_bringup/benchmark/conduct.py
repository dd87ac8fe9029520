# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Carry out a benchmark: the campaigns of each judged controller, one after the other."""

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.resources.abc import Traversable
from pathlib import Path

from ddct_bringup.benchmark.case_rows import CaseRows
from ddct_bringup.benchmark.cases import Cases, packaged_folder
from ddct_bringup.benchmark.judged import Judged
from ddct_bringup.benchmark.plan import BenchmarkPlan, JudgedEntry, RecordedBenchmark
from ddct_bringup.benchmark.release import ROWS, copy_release_rows, release_rows
from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.conduct import RESUME, carry_out_parts
from ddct_bringup.campaign.plan import CampaignPlan, RecordedCampaign
from ddct_bringup.campaign_report.reading import read_table
from ddct_bringup.manifest.begun import begun_manifest
from ddct_bringup.manifest.file_states import require_unaltered
from ddct_bringup.manifest.inputs import InputFiles
from ddct_bringup.manifest.limits import NamedLimits
from ddct_bringup.manifest.manifest import (
    BENCHMARK,
    begin_manifest,
    require_same_inputs,
    resume_manifest,
)
from ddct_bringup.run.output_folder import (
    locked_folders,
    mark_folder,
)
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.base.errors import DdctError

DEVELOPMENT, HELD_OUT = 'development', 'held_out'
"""Names of the folders of a judged controller's campaigns."""
AGAIN = 'what is done stays: start the same benchmark again'


@dataclass(frozen=True, eq=False)
class JudgedRows:
    """Rows of a judged controller."""

    development: CaseRows | None
    """
    Its rows of the development cases; None of a packaged one, whose rows the release has.

    With a car of the user they have those of the controllers beside it too.
    """
    held_out: CaseRows
    """Rows of held-out cases, its own first."""


@dataclass(frozen=True)
class Options:
    """Options of a benchmark that change no number."""

    workers: int | None = None
    """Number of processes, None for one per core."""
    stopped: Callable[[], bool] = lambda: False
    """Function that returns whether the user has stopped the benchmark."""
    release: str = ''
    """Digest of the code by which held-out cases are drawn; that of this process if empty."""
    rows: Path | None = None
    """Folder with the rows of the release; None for those of this one."""


def carry_out_benchmark(
    judged: Sequence[Judged],
    cases: Cases,
    out: Path,
    judge_seed: int | None = None,
    options: Options = Options(),
) -> dict[str, str]:
    """
    Compute all missing runs of a benchmark into a folder.

    Return the reason by name of each controller whose runs could not be computed; the others are
    complete. Raise DdctError for a folder that holds something else, KeyboardInterrupt when it is
    stopped: what is done stays, and another call goes on with it.
    """
    inputs = InputFiles()
    plan = BenchmarkPlan.of(judged, cases, judge_seed, inputs, options.release)
    rows = None
    if cases.car is None:
        rows = options.rows or packaged_folder()
        ours = [each.name for each in judged if each.is_packaged]
        release_rows(rows).of(cases).rows.only([*cases.beside, *ours])
    failed = {}
    with locked_folders(out, shared=True):
        _begin(plan, inputs, rows, out)
        cases = plan.cases_in(out)
        for each in plan.controllers:
            try:
                _compute(each, cases, out, options)
            except DdctError as error:
                failed[each.name] = str(error).replace(RESUME, AGAIN)
            except KeyboardInterrupt as error:
                raise KeyboardInterrupt(f'interrupted; {AGAIN}') from error
    return failed


def _begin(plan: BenchmarkPlan, inputs: InputFiles, rows: Traversable | None, out: Path) -> None:
    """Write the manifest, or require the same one in the folder."""
    if known := begun_manifest(out, 'benchmark', ROWS):
        RecordedBenchmark.of(known, out).require_same(plan, out)
        require_same_inputs(out, known, inputs)
        require_unaltered(out, list(inputs.files))
        resume_manifest(out, known)
        return
    mark_folder(out)
    if rows is not None:
        copy_release_rows(rows, out)
    inputs.copy(out)
    limits = NamedLimits.of(packaged_limits(), inputs)
    campaigns = {
        f'{entry.name}/{name}': CampaignPlan.of(campaign, limits, out)
        for entry in plan.controllers
        for name, campaign in campaigns_of(entry, plan.cases_in(out), out).items()
    }
    begin_manifest(out, BENCHMARK, plan, inputs, campaigns)


def campaigns_of(entry: JudgedEntry, cases: Cases, out: Path) -> dict[str, Campaign]:
    """Return the campaigns of a judged controller by the names of their folders."""
    judged = entry.judged(out)
    chosen, folder = judged.chosen, judged.folder
    held_out = {HELD_OUT: cases.held_out(chosen, folder, entry.held_out_seed)}
    if cases.car is not None:
        chosen_ones = cases.with_beside(chosen)
    elif judged.is_packaged:
        return held_out
    else:
        chosen_ones = [chosen]
    return {DEVELOPMENT: cases.development(chosen_ones, folder), **held_out}


def _compute(entry: JudgedEntry, cases: Cases, out: Path, options: Options) -> None:
    """Compute what is missing of a judged controller's runs."""
    mark_folder(out / entry.name)
    parts = {}
    for name, campaign in campaigns_of(entry, cases, out).items():
        folder = out / entry.name / name
        print(f'{entry.name}: {name}, {campaign.runs} runs', file=sys.stderr, flush=True)
        mark_folder(folder)
        parts[folder] = RecordedCampaign.read(folder)
    carry_out_parts(parts, packaged_limits(), workers=options.workers, stopped=options.stopped)


def read_judged_rows(folder: Path) -> JudgedRows:
    """Return the rows in the folder of a judged controller; raise DdctError where some miss."""
    development = _rows(folder / DEVELOPMENT) if (folder / DEVELOPMENT).exists() else None
    return JudgedRows(development, _rows(folder / HELD_OUT))


def _rows(folder: Path) -> CaseRows:
    return CaseRows(read_table(folder, RecordedCampaign.read(folder)))
