# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Readers of the files of a benchmark: its manifest, the rows of the release, update times."""

from pathlib import Path

from ddct_bringup.benchmark.cases import Cases, packaged_folder
from ddct_bringup.benchmark.judged import Judged
from ddct_bringup.benchmark.plan import BenchmarkPlan, JudgedEntry
from ddct_bringup.benchmark.release import ROWS, release_rows
from ddct_bringup.benchmark.update_times import (
    NoUpdateTime,
    UpdateTime,
    UpdateTimesFile,
    read_update_times,
)
from ddct_bringup.manifest.inputs import InputFiles
from ddct_bringup.run.timing_and_failure import TIMING_FILE
from ddct_plant.files.json_records import json_text, read_json
from fuzz.reader import Reader
from fuzz.targets.run_readers import in_folder

_UPDATE_TIMES = UpdateTimesFile(
    'pi',
    {
        'mine': UpdateTime(2.0, 1.9, 2.1, 10.0, 5.0),
        'other': NoUpdateTime(None, 'ValueError: it failed'),
    },
)


def benchmark_readers(folder: Path) -> list[Reader]:
    """Return the readers of a benchmark's files."""
    judged = [Judged.of(name) for name in ('pi', 'ls8')]
    plan = BenchmarkPlan.of(judged, Cases.packaged(quick=True), None, InputFiles())
    rows = (packaged_folder() / ROWS).read_bytes()
    times = json_text(_UPDATE_TIMES).encode()
    return [
        Reader('benchmark', 'plan.json', _plan, (json_text(plan).encode(),)),
        Reader('benchmark_rows', ROWS, in_folder(_release), (rows,)),
        Reader('update_times', TIMING_FILE, in_folder(read_update_times), (times,)),
    ]


def _plan(file: Path) -> object:
    """Return all that follows from a plan alone."""
    plan, folder = read_json(BenchmarkPlan, file), file.parent
    cases = plan.cases_in(folder)
    cases.require_parts()
    judged = [each.judged(folder) for each in plan.controllers]
    seeds = [JudgedEntry.of(each, '', plan.judge_seed).held_out_seed for each in judged]
    pairs = zip(judged, seeds, strict=True)
    held_out = [cases.held_out(each.chosen, folder, seed).cases for each, seed in pairs]
    return cases.digest, held_out


def _release(folder: Path) -> object:
    """Return the number of cases that the rows of a release have."""
    return release_rows(folder).of(Cases.packaged(quick=True)).rows.cases
