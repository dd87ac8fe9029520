# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The page of recorded runs, written whole or not at all."""

import importlib.util
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path

from rich.console import Console

from ddct_bringup.api import shell
from ddct_bringup.documents.page_parts import MARKER
from ddct_bringup.logs.columns import load_columns
from ddct_bringup.manifest.manifest import keep_digests
from ddct_bringup.report.evidence import evidence_of
from ddct_bringup.report.run_labels import in_order, require_one_scenario
from ddct_bringup.run.output_folder import is_ours, locked_folders
from ddct_bringup.scores.bags import bags_in
from ddct_bringup.scores.floors import with_floors
from ddct_bringup.scores.scored_recording import ScoredRecording, score_any_bag
from ddct_bringup.verdict.limits import Limits
from ddct_plant.base.errors import DdctError
from ddct_plant.files.output_file import STDOUT, require_place, write_text
from ddct_plant.program.progress import with_progress

REPORT_FILE = 'report.html'
_HEAD_BYTES = 1000
"""Number of leading bytes of a page that contain its marker."""


def report(
    bags: Iterable[Path], out: str, limits: Limits, *, columns: str | None, floors: bool
) -> list[ScoredRecording]:
    """
    Score bags and logs, write their page to `out`, and return them; print the progress.

    A bag that cannot be read is on the page with its reason. Raise DdctError as `write_report`,
    and before anything is read where `out` cannot be written or is a foreign file.
    """
    require_chart_library()
    _require_writable(out)
    places = [] if out == STDOUT else [Path(out).parent]
    with locked_folders(*filter(is_ours, places)):
        found = bags_in(bags)
        known = load_columns(columns) if columns else None
        runs = [
            score_any_bag(*bag, limits, known)
            for bag in with_progress(found, len(found), 'reading')
        ]
        require_one_scenario(runs)
        shown = with_floors(runs, limits) if floors else runs
        write_report(in_order(shown), out, limits)
        keep_digests([out] if places else [])
    return runs


def require_chart_library() -> None:
    """Raise DdctError where the package that draws the charts is not installed."""
    if importlib.util.find_spec('bokeh') is None:
        raise DdctError('the report needs the Python package bokeh: pip install bokeh')


def _require_writable(out: str) -> None:
    """Raise DdctError where the page cannot be written, or would replace a foreign file."""
    if out == STDOUT:
        return
    require_place('--out', out)
    try:
        if Path(out).is_file():
            with Path(out).open('rb') as file:
                head = file.read(_HEAD_BYTES)
            if head and MARKER.encode() not in head:
                raise DdctError(f'--out {out} is a file that is not ours: choose another name')
    except OSError as error:
        raise DdctError(f'--out {out}: cannot be read ({error.strerror})') from error


def write_report(runs: Sequence[ScoredRecording], out: str, limits: Limits) -> None:
    """
    Write the page of runs, in their order, judged by these limits.

    Call `require_chart_library` first. A bag that could not be read is on the page with its
    reason. Raise DdctError when none can be read, when they are of several scenarios, and when the
    page cannot be written.
    """
    if all(run.recording is None for run in runs):
        reasons = '; '.join(run.scores.reason for run in runs)
        raise DdctError(f'none of the {len(runs)} bags can be read, so nothing to show: {reasons}')
    require_one_scenario(runs)
    with Console(file=sys.stderr).status('frequency evidence'):
        evidence = evidence_of(runs)
    # What draws is imported here at last: bokeh takes longer than a headless run.
    write_text(out, shell.report_page(runs, evidence, limits))
