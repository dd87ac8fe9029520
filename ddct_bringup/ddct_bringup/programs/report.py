# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `report`: one page that shows recorded runs side by side."""

import argparse
import importlib.util
import sys
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from ddct_bringup.bag.measured_run import add_columns_option
from ddct_bringup.digests.writing import keep_digests
from ddct_bringup.report.evidence import evidence_of
from ddct_bringup.report.page_parts import MARKER
from ddct_bringup.report.run_labels import in_order, require_one_scenario
from ddct_bringup.run.output_folder import is_ours, locked_folders
from ddct_bringup.scores.bags import bags_in
from ddct_bringup.scores.floors import add_floors_option, with_floors
from ddct_bringup.scores.scored_recording import ScoredRecording, score_any_bag
from ddct_bringup.verdict.limits import Limits, add_limits_option, load_limits
from ddct_plant.base.errors import DdctError
from ddct_plant.files.output_file import STDOUT, require_place, write_text
from ddct_plant.measured.columns import load_columns
from ddct_plant.program.command_line import ProgramParser, complain, run_program
from ddct_plant.program.progress import with_progress

PROGRAM = 'ddct report'
REPORT_FILE = 'report.html'
_HEAD_BYTES = 1000
"""Number of leading bytes of a page that contain its marker."""

_EPILOG = """\
examples:
  ddct report runs/demo                                  every bag in the folder and below it
  ddct report runs/new/ls8 runs/worn/ls8 --out ls8.html  one controller in two conditions
  ddct report runs/demo --out -                          the page on standard output
  ddct report runs/demo --limits mine.yaml               judged by limits of your own

The page needs no network and no other file. Bags are scored anew; frequency.json and
timing.json are taken from beside them. All runs must be of one scenario. The exit code is 0
only if every run is valid; the page is written all the same, and says why one is not.
"""


def main(argv: list[str] | None = None) -> int:
    """Run the program and return its exit code."""
    return run_program(PROGRAM, _report, argv)


def _report(argv: list[str]) -> int:
    options = _parser().parse_args(argv)
    require_chart_library()
    _require_writable(options.out)
    limits = load_limits(options.limits)
    places = [] if options.out == STDOUT else [Path(options.out).parent]
    with locked_folders(*filter(is_ours, places)):
        bags = bags_in(options.runs)
        columns = load_columns(options.columns) if options.columns else None
        runs = [
            score_any_bag(*bag, limits, columns)
            for bag in with_progress(bags, len(bags), 'reading')
        ]
        require_one_scenario(runs)
        floored = with_floors(runs, limits, options.floors)
        write_report(in_order(floored), options.out, limits)
        keep_digests([options.out] if places else [])
    for run in runs:
        if not run.scores.valid:
            complain(PROGRAM, f'{run.scores.bag}: {run.scores.reason}')
    return 0 if all(run.scores.valid for run in runs) else 1


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
    # Some seconds to import, and absent where require_chart_library raises.
    from ddct_bringup.report.page import report_page

    if all(run.recording is None for run in runs):
        reasons = '; '.join(run.scores.reason for run in runs)
        raise DdctError(f'none of the {len(runs)} bags can be read, so nothing to show: {reasons}')
    require_one_scenario(runs)
    with Console(file=sys.stderr).status('frequency evidence'):
        evidence = evidence_of(runs)
    write_text(out, report_page(runs, evidence, limits))


def _parser() -> argparse.ArgumentParser:
    parser = ProgramParser(
        prog=PROGRAM,
        description='Show recorded runs side by side on one page that needs no network.',
        epilog=_EPILOG,
    )
    parser.add_argument(
        'runs',
        metavar='RUN',
        type=Path,
        nargs='+',
        help='a bag folder, an .mcap file, a folder that is searched for bags, or a CSV log',
    )
    add_columns_option(parser)
    parser.add_argument(
        '--out',
        default=REPORT_FILE,
        metavar='FILE',
        help=f"the page, {REPORT_FILE} if not given; '-' is standard output",
    )
    add_limits_option(parser)
    add_floors_option(parser)
    return parser


if __name__ == '__main__':
    sys.exit(main())
