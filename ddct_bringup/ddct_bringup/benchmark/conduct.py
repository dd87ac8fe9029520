# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Carry out a benchmark: the campaigns of each judged controller, one after the other."""

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from ddct_bringup.benchmark.case_rows import CaseRows
from ddct_bringup.benchmark.cases import Cases, packaged_folder
from ddct_bringup.benchmark.judged import Judged
from ddct_bringup.benchmark.manifest import MANIFEST, BenchmarkManifest
from ddct_bringup.benchmark.release import ROWS, copy_release_rows, release_rows
from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.conduct import RESUME, carry_out
from ddct_bringup.campaign.manifest import MANIFEST as CAMPAIGN_MANIFEST
from ddct_bringup.campaign.manifest import Manifest
from ddct_bringup.campaign_report.reading import read_table
from ddct_bringup.run.output_folder import (
    MARKER,
    locked_folders,
    mark_folder,
    require_ours_or_empty,
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
    """Its rows of the development cases; None of a packaged one, whose rows the release has."""
    held_out: CaseRows
    """Rows of held-out cases, its own first."""


@dataclass(frozen=True)
class Options:
    """Options of a benchmark that change no number."""

    workers: int | None = None
    """Number of processes, None for one per core."""
    stopped: Callable[[], bool] = lambda: False
    """Function that returns whether the user has stopped the benchmark."""


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
    manifest = BenchmarkManifest.of(judged, cases, judge_seed)
    ours = [each.name for each in judged if each.is_packaged]
    release_rows(packaged_folder()).of(cases).rows.only([*cases.beside, *ours])
    failed = {}
    with locked_folders(out, shared=True):
        _begin(manifest, out)
        for each, entry in zip(judged, manifest.controllers, strict=True):
            try:
                _compute(each, entry.held_out_seed, cases, out / each.name, options)
            except DdctError as error:
                failed[each.name] = str(error).replace(RESUME, AGAIN)
            except KeyboardInterrupt as error:
                raise KeyboardInterrupt(f'interrupted; {AGAIN}') from error
    return failed


def _begin(manifest: BenchmarkManifest, out: Path) -> None:
    """Write the manifest, or require the same one in the folder."""
    require_ours_or_empty(out)
    if (out / MANIFEST).exists():
        BenchmarkManifest.read(out).require_same(manifest, out)
        return
    begun = {MARKER, ROWS}  # what a start that was killed may leave
    if out.is_dir() and {each.name for each in out.iterdir()} - begun:
        raise DdctError(f'{out} holds other results: choose another --out')
    mark_folder(out)
    copy_release_rows(out)
    manifest.write(out)


def campaigns_of(judged: Judged, cases: Cases, held_out_seed: int) -> dict[str, Campaign]:
    """Return the campaigns of a judged controller by the names of their folders."""
    chosen, folder = judged.chosen, judged.folder
    held_out = {HELD_OUT: cases.held_out(chosen, folder, held_out_seed)}
    if judged.is_packaged:
        return held_out
    return {DEVELOPMENT: cases.development([chosen], folder), **held_out}


def _compute(judged: Judged, seed: int, cases: Cases, folder: Path, options: Options) -> None:
    """Compute what is missing of a judged controller's runs."""
    if not (folder / MARKER).exists():
        mark_folder(folder)
    for name, campaign in campaigns_of(judged, cases, seed).items():
        print(f'{judged.name}: {name}, {campaign.runs} runs', file=sys.stderr, flush=True)
        carry_out(
            campaign,
            packaged_limits(),
            folder / name,
            workers=options.workers,
            resume=(folder / name / CAMPAIGN_MANIFEST).exists(),
            stopped=options.stopped,
        )


def read_judged_rows(folder: Path) -> JudgedRows:
    """Return the rows in the folder of a judged controller; raise DdctError where some miss."""
    development = _rows(folder / DEVELOPMENT) if (folder / DEVELOPMENT).exists() else None
    return JudgedRows(development, _rows(folder / HELD_OUT))


def _rows(folder: Path) -> CaseRows:
    return CaseRows.of_table(read_table(folder, Manifest.read(folder)))
