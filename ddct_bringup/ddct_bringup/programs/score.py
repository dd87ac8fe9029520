# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `score`: compute the metrics of recorded runs."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from ddct_bringup.bag.measured_run import add_columns_option, read_recording
from ddct_bringup.digests.writing import keep_digests
from ddct_bringup.run.output_folder import is_ours, locked_folders
from ddct_bringup.scores.bags import bag_name, bags_in
from ddct_bringup.scores.csv_text import scores_csv
from ddct_bringup.scores.document import scores_document
from ddct_bringup.scores.floors import NONE, add_floors_option, with_least
from ddct_bringup.scores.run_table import figure_columns, identifying_columns, print_runs
from ddct_bringup.scores.scored_recording import score_recording
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.scores.scoring import unreadable_run
from ddct_bringup.scores.signal_files import signal_file_stems, write_signals
from ddct_bringup.scores.validity import MISS_TOLERANCE
from ddct_bringup.verdict.limits import Limits, add_limits_option, load_limits
from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import write_json
from ddct_plant.files.output_file import STDOUT, require_one_for_stdout, write_text
from ddct_plant.measured.columns import load_columns
from ddct_plant.program.command_line import ProgramParser, complain, run_program
from ddct_plant.program.progress import with_progress

PROGRAM = 'ddct score'

_EPILOG = f"""\
examples:
  ddct score runs/demo                        every bag in the folder and below it
  ddct score runs/demo/pi runs/demo/ls8       two bags
  ddct score runs/demo --json scores.json     also as JSON; '-' is standard output
  ddct score runs/demo --csv - | column -ts,  as CSV on standard output, table on standard error
  ddct score runs/demo --signals-csv signals  also every signal, one file per bag
  ddct score runs/demo --signals-mat signals  the same as MAT files, for MATLAB
  ddct score runs/demo --limits mine.yaml     judged by other limits than the packaged ones

The exit code is 0 only if every bag was scored and valid: whole, of the length that the
run was meant to have, every value finite; in real time also at most {MISS_TOLERANCE:.0%} of the
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
    limits = load_limits(options.limits)
    bags = bags_in(options.bags)
    with locked_folders(*_run_folders(options)):
        written: list[Path | str] = []
        runs = _scored(bags, options, limits, written)
        if options.json:
            write_json(options.json, scores_document(runs, limits))
        if options.csv:
            write_text(options.csv, scores_csv(runs))
        written += [file for file in (options.json, options.csv) if file not in (None, STDOUT)]
        keep_digests(written)
    table = sys.stderr if STDOUT in (options.json, options.csv) else sys.stdout
    print_runs(runs, (*identifying_columns(runs), *figure_columns(runs)), table)
    return 0 if all(run.valid for run in runs) else 1


def _run_folders(options: argparse.Namespace) -> list[Path]:
    """Return the folders of runs into which these options write."""
    files = (options.json, options.csv)
    folders = [Path(file).parent for file in files if file not in (None, STDOUT)]
    folders += [each for each in _signal_folders(options).values() if each is not None]
    return list(filter(is_ours, folders))


def _scored(
    bags: Sequence[tuple[Path, Path | None]],
    options: argparse.Namespace,
    limits: Limits,
    written: list[Path | str],
) -> list[ScoredRun]:
    """Return the scores of bags; write signals if requested, and add the files to `written`."""
    runs = []
    folders = {ending: each for ending, each in _signal_folders(options).items() if each}
    stems = signal_file_stems(bags) if folders else {}
    columns = load_columns(options.columns) if options.columns else None
    for bag, folder in with_progress(bags, len(bags), 'scoring'):
        recording = None
        try:
            recording = read_recording(bag, columns)
            name = bag_name(bag, folder)
            for line in recording.custom_data.get('adjusted', '').splitlines():
                complain(PROGRAM, f'{name}: {line}')
            scored = score_recording(recording, name, limits)
            runs.append((scored if options.floors == NONE else with_least(scored, limits)).scores)
        except DdctError as error:
            unreadable = unreadable_run(bag, error, relative_to=folder)
            complain(PROGRAM, unreadable.reason)
            runs.append(unreadable)
        if recording is None:
            continue
        for ending, target in folders.items():  # a full disk is no fault of the bag
            write_signals(target, f'{stems[bag]}.{ending}', recording)
            written.append(target / f'{stems[bag]}.{ending}')
    return runs


def _signal_folders(options: argparse.Namespace) -> dict[str, Path | None]:
    """Return the folders for files of signals, by file extension."""
    return {'csv': options.signals_csv, 'mat': options.signals_mat}


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
        help='a bag folder, an .mcap file, a folder that is searched for bags, or a CSV log',
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
