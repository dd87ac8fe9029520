# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `report`: one page that shows recorded runs side by side."""

import argparse
import sys
from pathlib import Path

from ddct_bringup.api import shell
from ddct_bringup.programs.options.of_runs import (
    add_columns_option,
    add_floors_option,
    add_limits_option,
    wants_floors,
)
from ddct_plant.program.command_line import ProgramParser, complain, run_program

PROGRAM = 'ddct report'
_PAGE = 'report.html'
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
    runs = shell.report(
        options.runs,
        options.out,
        shell.load_limits(options.limits),
        columns=options.columns,
        floors=wants_floors(options),
    )
    for run in runs:
        if not run.scores.valid:
            complain(PROGRAM, f'{run.scores.bag}: {run.scores.reason}')
    return 0 if all(run.scores.valid for run in runs) else 1


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
        help='a bag folder, an .mcap file, a folder that is searched for bags, or a log',
    )
    add_columns_option(parser)
    parser.add_argument(
        '--out',
        default=_PAGE,
        metavar='FILE',
        help=f"the page, {_PAGE} if not given; '-' is standard output",
    )
    add_limits_option(parser)
    add_floors_option(parser)
    return parser


if __name__ == '__main__':
    sys.exit(main())
