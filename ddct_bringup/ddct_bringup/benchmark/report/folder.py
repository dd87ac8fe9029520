# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Write the result, the page and the digests of a benchmark into its folder."""

from collections.abc import Mapping
from pathlib import Path

from ddct_bringup.benchmark.conduct import JudgedRows, read_judged_rows
from ddct_bringup.benchmark.file_names import PAGE, RESULT
from ddct_bringup.benchmark.plan import RecordedBenchmark
from ddct_bringup.benchmark.release import release_rows
from ddct_bringup.benchmark.report.document import benchmark_document
from ddct_bringup.benchmark.result import result_of
from ddct_bringup.benchmark.result_types import Result, ResultWithTimes
from ddct_bringup.benchmark.update_times import read_update_times
from ddct_bringup.documents.document import Document
from ddct_bringup.documents.page import html_page
from ddct_bringup.manifest.manifest import finish_manifest
from ddct_bringup.run.output_folder import locked_folders
from ddct_plant.files.json_records import read_json, write_json
from ddct_plant.files.output_file import write_text

_NOTHING: Mapping[str, str] = {}


def result_in(out: Path, failed: Mapping[str, str] = _NOTHING) -> Result:
    """
    Return the result of the rows in a folder; raise DdctError where some are missing.

    `failed` has the reasons of the controllers without rows.
    """
    recorded = RecordedBenchmark.read(out)
    rows: dict[str, JudgedRows] = {
        each.name: read_judged_rows(out / each.name)
        for each in recorded.plan.controllers
        if each.name not in failed
    }
    cases = recorded.cases
    release = release_rows(out).of(cases) if cases.car is None else None
    return result_of(recorded, release, rows, failed)


def write_result(out: Path, failed: Mapping[str, str]) -> Result:
    """Write the result of the rows in a folder, and return it; raise DdctError as `result_in`."""
    result = result_in(out, failed)
    with locked_folders(out):
        write_json(str(out / RESULT), result)
        document = benchmark_document(result, read_update_times(out))
        write_text(str(out / PAGE), html_page(document))
        finish_manifest(out)
    return result


def benchmark_in(out: Path) -> Document:
    """Return the document of the benchmark in a folder; raise DdctError without a finished one."""
    result = read_json(Result, out / RESULT, advice='finish the benchmark')
    return benchmark_document(result, read_update_times(out))


def document_of(result: Result, out: Path) -> ResultWithTimes:
    """Return the result with the update times, as `--json` has it."""
    return ResultWithTimes(result, read_update_times(out))
