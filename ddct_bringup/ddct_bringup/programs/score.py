# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `score`: compute the metrics of recorded runs."""

import argparse
import sys
from functools import partial
from pathlib import Path

from ddct_bringup.api import shell
from ddct_bringup.programs.options.of_runs import (
    add_columns_option,
    add_floors_option,
    add_limits_option,
    wants_floors,
)
from ddct_plant.files.output_file import STDOUT, require_one_for_stdout
from ddct_plant.program.command_line import ProgramParser, complain, run_program

PROGRAM = 'ddct score'

_EPILOG = """\
examples:
  ddct score runs/demo                        every bag in the folder and below it
  ddct score runs/demo/pi runs/demo/ls8       two bags
  ddct score runs/demo --json scores.json     also as JSON; '-' is standard output
  ddct score runs/demo --csv - | column -ts,  as CSV on standard output, table on standard error
  ddct score runs/demo --signals-csv signals  also every signal, one file per bag
  ddct score runs/demo --signals-mat signals  the same as MAT files, for MATLAB
  ddct score runs/demo --limits mine.yaml     judged by other limits than the packaged ones

The exit code is 0 only if every bag was scored and valid: whole, of the length that the
run was meant to have, every value finite; in real time also at most 1% of the
steps without a reply, and no node in its safe state. A run that a stalled or over-revved
engine ended is valid: that is its state. A bag that its recorder could not finish is read as
far as it is whole, and has no figures.
Figures run from control start to the end. Jerk: A_x through a 20 Hz low-pass without delay.
"""


def main(argv: list[str] | None = None) -> int:
    """Run the program and return its exit code."""
    return run_program(PROGRAM, _score, argv)


def _score(argv: list[str]) -> int:
    options = _parser().parse_args(argv)
    require_one_for_stdout(options.json, options.csv)
    scorer = shell.BagScorer(
        limits=shell.load_limits(options.limits),
        complain=partial(complain, PROGRAM),
        columns=options.columns,
        floors=wants_floors(options),
    )
    signals = {'csv': options.signals_csv, 'mat': options.signals_mat}
    folders = {ending: folder for ending, folder in signals.items() if folder is not None}
    files = shell.ScoreFiles(options.json, options.csv, folders)
    runs = shell.score_bags(options.bags, scorer, files)
    table = sys.stderr if STDOUT in (options.json, options.csv) else sys.stdout
    columns = (*shell.identifying_columns(runs), *shell.figure_columns(runs))
    shell.print_runs(runs, columns, table)
    return 0 if all(run.valid for run in runs) else 1


def _parser() -> argparse.ArgumentParser:
    parser = ProgramParser(
        prog=PROGRAM,
        description='Compute the metrics of recorded runs from their bags, and judge them.',
        epilog=_EPILOG,
    )
    parser.add_argument(
        'bags',
        metavar='BAG|FOLDER',
        type=Path,
        nargs='+',
        help='a bag folder, an .mcap file, a folder that is searched for bags, or a log',
    )
    parser.add_argument('--json', metavar='FILE', help="write scores.json to FILE; '-': stdout")
    add_columns_option(parser)
    add_limits_option(parser)
    add_floors_option(parser)
    parser.add_argument('--csv', metavar='FILE', help="write a CSV table to FILE; '-': stdout")
    parser.add_argument(
        '--signals-csv',
        metavar='DIR',
        type=Path,
        help='write the signals of each bag to a CSV file in DIR',
    )
    parser.add_argument(
        '--signals-mat',
        metavar='DIR',
        type=Path,
        help='write the same signals to MAT files, for MATLAB, Octave and scipy',
    )
    return parser


if __name__ == '__main__':
    sys.exit(main())
