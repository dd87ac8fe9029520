# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Subcommand `reproduce calibration`: the thesis scenario, fitted to rows of Table 5.1."""

import argparse
import os
from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from ddct_bringup.reproduction.calibration.ensemble import find_members, members_in, write_members
from ddct_bringup.reproduction.calibration.parameters import outside_tolerance
from ddct_bringup.reproduction.calibration.predicted_values import predict
from ddct_bringup.reproduction.calibration.record import (
    RETURN_TOLERANCE,
    calibrate,
    check_frozen,
    drive_text,
)
from ddct_bringup.reproduction.calibration.record_tables import all_tables, check_tables
from ddct_bringup.reproduction.calibration.record_types import (
    CalibrationRecord,
    CheckRecord,
    ResidualEntry,
)
from ddct_bringup.thesis.predictions import FILE as PREDICTIONS_FILE
from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import write_json
from ddct_plant.files.output_file import STDOUT, require_place, write_text
from ddct_plant.program.command_line import complain
from ddct_plant.program.printed_table import print_tables
from ddct_plant.program.table import Table
from ddct_plant.scenario.file import load_scenario

_DESCRIPTION = """\
Fit engine torque, reference slope, PI gains and the end of the score window to the
LS8, Hinf1 and PI rows of Table 5.1 of the thesis (nine numbers; the MPC rows take no
part), and show bounds, result, identifiability and what each row left out gives."""
_EPILOG = """\
examples:
  ddct reproduce calibration                          all of it, about a minute and a half
  ddct reproduce calibration --quick                  only check that the scenario is the optimum
  ddct reproduce calibration --json -                 the result as JSON on standard output, alone
  ddct reproduce calibration --write my_thesis.yaml   write the calibrated drive
  ddct reproduce calibration --ensemble DIR           search the admissible scenarios, two minutes
  ddct reproduce calibration --predict DIR            only predict in those of DIR, half a minute

The exit code is 1 when a residual is outside its tolerance (5 % of t_a, 10 % of a
sigma), or when --quick finds that the frozen scenario is not the optimum."""


_progress = partial(complain, 'ddct reproduce calibration')


def add_parser(subparsers: Any) -> None:
    """Add `calibration` to the subcommands of `reproduce`."""
    parser = subparsers.add_parser(
        'calibration',
        description=_DESCRIPTION,
        epilog=_EPILOG,
    )
    parser.add_argument('--quick', action='store_true', help='check the frozen scenario only')
    parser.add_argument('--json', metavar='FILE', help="write the result as JSON; '-' is stdout")
    parser.add_argument('--write', metavar='FILE', help="write the drive; '-' is stdout")
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
    parser.set_defaults(run=run, parser=parser)


def run(options: argparse.Namespace) -> int:
    """Fit, print and write as the options request; raise DdctError when no scenario fits."""
    parser = options.parser
    if options.quick and options.write:
        parser.error('--quick finds nothing to write: leave out --write')
    folder = options.ensemble or options.predict
    if folder:
        if options.quick or options.json or options.write:
            parser.error('--ensemble and --predict take no other option: leave it out')
        _make_ensemble(folder, search=bool(options.ensemble))
        return 0
    if options.json == options.write == STDOUT:
        parser.error('--json - and --write - both want standard output: give one a file')
    require_place('--json', options.json)
    require_place('--write', options.write)
    if options.quick:
        check = check_frozen(load_scenario('thesis'), _progress)
        _show_and_write(options, check, check_tables(check))
        _require_within_tolerance(check.residuals)
        _require_optimum(check.moved)
        return 0
    record = calibrate(_progress)
    _show_and_write(options, record, all_tables(record).values())
    _require_within_tolerance(record.residuals)
    if options.write:
        write_text(options.write, drive_text(record))
    return 0


def _show_and_write(
    options: argparse.Namespace, record: CalibrationRecord | CheckRecord, tables: Iterable[Table]
) -> None:
    if STDOUT not in (options.json, options.write):
        print_tables(tables)
    if options.json:
        write_json(options.json, record)


def _make_ensemble(folder: Path, *, search: bool) -> None:
    """Write the admissible scenarios, or keep those in the folder, and their predictions."""
    if not folder.is_dir() or not os.access(folder, os.W_OK):
        raise DdctError(f'{folder} is no folder that can be written: make it first')
    frozen = load_scenario('thesis')
    if search:
        write_members(find_members(frozen, _progress), folder)
    members = members_in(folder)
    write_json(str(folder / PREDICTIONS_FILE), predict(frozen, members, _progress))
    _progress(f'{len(members)} admissible scenarios and {PREDICTIONS_FILE} are in {folder}')


def _require_within_tolerance(residuals: Sequence[ResidualEntry]) -> None:
    outside = outside_tolerance(residuals)
    if outside:
        raise DdctError(f'no scenario fits: {", ".join(outside)} is outside the tolerance')


def _require_optimum(moved: Mapping[str, float]) -> None:
    """Raise DdctError where a refit changes a parameter by more than `RETURN_TOLERANCE`."""
    name, share = max(moved.items(), key=lambda item: abs(item[1]))
    if abs(share) > RETURN_TOLERANCE:
        raise DdctError(
            f'scenario thesis is not the optimum: a refit moves {name} by '
            f'{100.0 * share:+.1f} % of its range; run it again without --quick'
        )
