"""Program `calibrate`: fit the thesis scenario to three rows of Table 5.1, and show the fit."""

import argparse
import os
import sys
from pathlib import Path

from ddct_bringup.calibration.ensemble import find_members, members_in, write_members
from ddct_bringup.calibration.files import fill_page, scenario_text
from ddct_bringup.calibration.predicted_values import predict
from ddct_bringup.calibration.predictions import FILE as PREDICTIONS_FILE
from ddct_bringup.calibration.record import (
    RETURN_TOLERANCE,
    Record,
    calibrate,
    check_frozen,
    outside_tolerance,
)
from ddct_bringup.calibration.tables import CalibrationTable, all_tables, check_tables
from ddct_plant.cli import ProgramParser, run_program
from ddct_plant.errors import DdctError
from ddct_plant.output_file import STDOUT, write_json, write_text
from ddct_plant.page_tables import read_page
from ddct_plant.scenario_file import load_scenario
from ddct_plant.table import print_table

PROGRAM = 'calibrate'
_DESCRIPTION = """\
Fit engine torque, reference slope, PI gains and the end of the score window to the
LS8, Hinf1 and PI rows of Table 5.1 of the thesis (nine numbers; the MPC rows take no
part), and show bounds, result, identifiability and what each row left out gives."""
_EPILOG = """\
examples:
  calibrate                          the whole calibration, about a minute and a half
  calibrate --quick                  only check that the frozen scenario is the optimum
  calibrate --json -                 the result as JSON on standard output, alone
  calibrate --write my_thesis.yaml   write the calibrated scenario
  calibrate --ensemble DIR           search the admissible scenarios again, about two minutes
  calibrate --predict DIR            only predict again in those of DIR, about half a minute

The exit code is 1 when a residual is outside its tolerance (5 % of t_a, 10 % of a
sigma), or when --quick finds that the frozen scenario is not the optimum."""


def main(argv: list[str] | None = None) -> int:
    """Run the program and return its exit code."""
    return run_program(PROGRAM, _run, argv)


def _run(argv: list[str]) -> int:
    parser = _parser()
    options = parser.parse_args(argv)
    if options.quick and (options.write or options.write_doc):
        parser.error('--quick finds nothing to write: leave out --write and --write-doc')
    if options.ensemble is not None or options.predict is not None:
        if options.quick or options.json or options.write or options.write_doc:
            parser.error('--ensemble and --predict take no other option: leave it out')
        _make_ensemble(options)
        return 0
    if options.json == options.write == STDOUT:
        parser.error('--json - and --write - both want standard output: give one a file')
    for output in (options.json, options.write, options.write_doc):
        _require_writable(output)
    page = read_page(options.write_doc) if options.write_doc else ''
    quiet = STDOUT in (options.json, options.write)
    if options.quick:
        record = check_frozen(load_scenario('thesis'), _progress)
        _print_tables(check_tables(record), quiet)
    else:
        record = calibrate(_progress)
        _print_tables(list(all_tables(record).values()), quiet)
    if options.json:
        write_json(options.json, record)
    _require_tolerances(record)
    if options.quick:
        _require_optimum(record)
    if options.write:
        write_text(options.write, scenario_text(record))
    if options.write_doc:
        write_text(options.write_doc, fill_page(page, record))
    return 0


def _make_ensemble(options: argparse.Namespace) -> None:
    """Write the admissible scenarios, or keep those in the folder, and what they predict."""
    folder: Path = options.ensemble or options.predict
    if not folder.is_dir() or not os.access(folder, os.W_OK):
        raise DdctError(f'{folder} is no folder that can be written: make it first')
    frozen = load_scenario('thesis')
    if options.ensemble is not None:
        write_members(find_members(frozen, _progress), folder)
    members = members_in(folder)
    write_json(str(folder / PREDICTIONS_FILE), predict(frozen, members, _progress).as_record())
    _progress(f'{len(members)} admissible scenarios and {PREDICTIONS_FILE} are in {folder}')


def _progress(text: str) -> None:
    print(f'{PROGRAM}: {text}', file=sys.stderr, flush=True)


def _print_tables(tables: list[CalibrationTable], quiet: bool) -> None:
    if not quiet:
        for table in tables:
            print_table(table.title, table.headers, table.rows)


def _require_tolerances(record: Record) -> None:
    outside = outside_tolerance(record['residuals'])
    if outside:
        raise DdctError(f'no scenario fits: {", ".join(outside)} is outside the tolerance')


def _require_optimum(record: Record) -> None:
    moved = max(record['moved'].items(), key=lambda item: abs(item[1]))
    if abs(moved[1]) > RETURN_TOLERANCE:
        raise DdctError(
            f'scenario thesis is not the optimum: a refit moves {moved[0]} by '
            f'{100.0 * moved[1]:+.1f} % of its range; run calibrate without --quick'
        )


def _require_writable(output: str | None) -> None:
    """Refuse a file that cannot be written before the long work, not after it."""
    if output in (None, STDOUT):
        return
    path = Path(output)
    if path.is_dir() or not os.access(path if path.exists() else path.parent, os.W_OK):
        raise DdctError(f'{path}: cannot be written: give a file in a folder that can be')


def _parser() -> argparse.ArgumentParser:
    parser = ProgramParser(
        prog=PROGRAM,
        description=_DESCRIPTION,
        epilog=_EPILOG,
    )
    parser.add_argument('--quick', action='store_true', help='check the frozen scenario only')
    parser.add_argument('--json', metavar='FILE', help="write the result as JSON; '-' is stdout")
    parser.add_argument('--write', metavar='FILE', help="write the scenario; '-' is stdout")
    parser.add_argument('--write-doc', metavar='FILE', help='fill in the tables of the page FILE')
    ensemble = parser.add_mutually_exclusive_group()
    ensemble.add_argument(
        '--ensemble',
        metavar='DIR',
        type=Path,
        help='search the admissible scenarios that are kept, into DIR, and do as --predict',
    )
    ensemble.add_argument(
        '--predict', metavar='DIR', type=Path, help='write what the scenarios in DIR predict'
    )
    return parser


if __name__ == '__main__':
    raise SystemExit(main())
