# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The page of recorded runs, written whole or not at all."""

import importlib.util
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import BrokenExecutor
from contextlib import closing, contextmanager
from functools import partial
from importlib import import_module
from operator import call
from pathlib import Path
from typing import Any

from rich.console import Console

from ddct_bringup.api import shell
from ddct_bringup.documents.page_parts import MARKER
from ddct_bringup.logs.columns import load_columns
from ddct_bringup.manifest.manifest import keep_digests
from ddct_bringup.many_runs.local_workers import LocalWorkers
from ddct_bringup.many_runs.work import Each
from ddct_bringup.report.evidence import LoopEvidence, evidence_of
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


def draw_page(
    runs: Sequence[ScoredRecording], evidence: Sequence[LoopEvidence], limits: Limits
) -> str:
    """Return the page of runs; what draws is imported here, which takes longer than a run."""
    return shell.report_page(runs, evidence, limits)


def _get_ready() -> str:
    """Import what draws a page."""
    import_module('bokeh.plotting')
    return shell.report_page.__name__


@contextmanager
def drawn_apart() -> Iterator[Callable[..., str]]:
    """
    Yield a function like `draw_page` that draws in a second process.

    That process imports what it needs while this one goes on. If it has ended, as for lack of
    memory, the function draws in this process.
    """
    with closing(LocalWorkers(1)) as process:
        submit = process.begin(Each(call))
        submit([_get_ready])

        def draw(*content: Any) -> str:
            try:
                (page,) = submit([partial(draw_page, *content)]).result()
            except BrokenExecutor:
                return draw_page(*content)
            return str(page)

        yield draw


def write_report(
    runs: Sequence[ScoredRecording],
    out: str,
    limits: Limits,
    draw: Callable[..., str] = draw_page,
) -> None:
    """
    Write the page of runs, in their order, judged by these limits; `draw` is as `draw_page`.

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
    write_text(out, draw(runs, evidence, limits))
