# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`identify --from LOG`: a measured driveline as tables and JSON, its car and drive as files."""

import argparse
import itertools
from collections.abc import Sequence
from pathlib import Path

from ddct_bringup.bag.measured_keys import MeasuredKeys
from ddct_bringup.identification.from_log.base_car import drag_of, radius_of, with_radius
from ddct_bringup.identification.from_log.car_and_drive import OutFolder, write_car_and_drive
from ddct_bringup.identification.from_log.car_of_log import base_of_car
from ddct_bringup.identification.from_log.common_rows import in_common_rows
from ddct_bringup.identification.from_log.drive_of_log import LogDrive
from ddct_bringup.identification.from_log.fit import fit_log
from ddct_bringup.identification.from_log.log_columns import columns_of
from ddct_bringup.identification.from_log.log_fit_report import LogFitReport, print_fit
from ddct_bringup.identification.from_log.prediction import predict
from ddct_bringup.identification.from_log.result import LogFit
from ddct_bringup.identification.from_log.stretches import (
    TORQUES,
    KnownLoad,
    Stretch,
    stretches_of,
)
from ddct_bringup.identification.from_log.unknowns import PARAMETERS
from ddct_bringup.identification.from_log.verdict import reasons_against, reasons_in_log
from ddct_bringup.logs.columns import ColumnMap
from ddct_bringup.logs.log import SPEEDS, MeasuredLog, read_log
from ddct_plant.base.clutch_kinds import STICK_SLIP
from ddct_plant.base.errors import DdctError
from ddct_plant.base.options import options_of, require_known
from ddct_plant.files.output_file import STDOUT, require_place
from ddct_plant.program.command_line import ProgramParser, show_and_write
from ddct_plant.program.printed_table import print_note
from ddct_plant.program.progress import Progress
from ddct_plant.scenario.choices.command_line import add_scenario_options, choice_of
from ddct_plant.scenario.choices.scenarios import DEFAULT_CAR
from ddct_plant.scenario.chosen import scenario_of as base_scenario
from ddct_plant.scenario.nouns.keys import CAR, NOUNS
from ddct_plant.scenario.overrides import parsed_override
from ddct_plant.scenario.scenario import Scenario

NEEDED = (*SPEEDS, *TORQUES)
"""Quantities that a log must have."""
TIMES = ('control_start_s', 'score_window_s')
"""Keys of a drive that --set may give in place of the log's own."""
HOLD_OUT = 0.3
"""Default share of the log that is held out."""


def add_log_options(parser: ProgramParser) -> None:
    """Add the options of `--from LOG`."""
    group = parser.add_argument_group('from a log')
    group.add_argument(
        '--from', dest='log', metavar='LOG', type=Path, help='a log (CSV, MAT, MDF 4) or a bag'
    )
    group.add_argument(
        '--columns',
        metavar='FILE',
        help='column map: which column holds which quantity; default: those of score '
        '--signals-csv, else it is guessed and printed',
    )
    group.add_argument(
        '--dbc',
        metavar='FILE',
        type=Path,
        help='without --columns: the signals in the frames of a CAN bus in an MDF log',
    )
    group.add_argument(
        '--guess',
        metavar='FILE',
        help='write the guessed column map into FILE, to be corrected, and fit nothing',
    )
    group.add_argument(
        '--check', metavar='LOG', type=Path, help='another log of the same columns to predict'
    )
    group.add_argument(
        '--hold-out',
        metavar='SHARE',
        type=float,
        default=HOLD_OUT,
        help='without --check: last share of the log to predict; default: %(default)s',
    )
    group.add_argument(
        '--fix',
        action='append',
        default=[],
        metavar='NAME',
        choices=PARAMETERS,
        help=f'keep this parameter as the car has it; one of {", ".join(PARAMETERS)}',
    )
    group.add_argument(
        '--force',
        action='store_true',
        help='accept a fit that is refused: write car and drive all the same, exit code 0',
    )
    group.add_argument(
        '--out',
        metavar='FOLDER',
        type=Path,
        help='write the car, and a drive that replays the log, into this folder',
    )
    group.add_argument(
        '--overwrite', action='store_true', help='replace an earlier car and drive at --out'
    )
    add_scenario_options(group, set_example='vehicle.wheel_radius_m=0.31')


def identify_log(options: argparse.Namespace) -> int:
    """Fit the log, predict held-out data, print and write the result; return the exit code."""
    if not 0.1 <= options.hold_out <= 0.9:
        raise DdctError(f'--hold-out is {options.hold_out:g}: give a share from 0.1 to 0.9')
    require_place('--json', options.json)
    out = OutFolder(options.out, options.log) if options.out else None
    if out:
        out.require_new(overwrite=options.overwrite)
        base_of_car(choice_of(options))
    start = base_scenario(options, options.overrides)
    columns = columns_of(options, start, NEEDED)
    if options.guess:
        return 0
    require_known(columns.run, options_of(MeasuredKeys), prefix='run.')
    fitted, held_out = _logs(options, columns)
    radius = radius_of(start, options.overrides, fitted, columns)
    base = with_radius(start, radius)
    drag = drag_of(base)
    # Before the fit, which takes long, because they raise the errors of the logs.
    stretches, predicted = stretches_of(fitted, drag), stretches_of(held_out, drag)
    fit = _fitted(options, columns, start, drag, fitted, stretches)
    predictions = predict(fit, predicted)
    reasons = reasons_against(fit, predictions, stretches)
    report = LogFitReport(
        fit, radius, start.name, len(stretches), predictions, reasons, fitted, held_out
    )
    show_and_write(options.json, report.document, lambda: print_fit(report))
    if reasons and not options.force:
        kept = '; nothing is written' if out else ''
        raise DdctError(
            f'{options.log}: the fit is refused: {reasons[0]}{_more(reasons)}{kept}: mend the log '
            'or its column map, or accept the fit with --force'
        )
    if out:
        whole = in_common_rows(read_log(options.log, columns, NEEDED))
        set_times = dict(map(parsed_override, options.overrides))
        given = {key: set_times[key] for key in TIMES if key in set_times}
        drive = LogDrive(base, fit, whole, given or columns.run, stretches_of(whole, drag))
        found = write_car_and_drive(out, choice_of(options), options.overrides, drive)
        if options.json != STDOUT:
            _print_written(out, drive, found)
    return 0


def _fitted(
    options: argparse.Namespace,
    columns: ColumnMap,
    start: Scenario,
    drag: KnownLoad,
    log: MeasuredLog,
    stretches: Sequence[Stretch],
) -> LogFit:
    """Return the fit; where there is none, raise DdctError with what is wrong with the log."""
    count = itertools.count(1)
    try:
        with Progress('fitting the driveline, evaluations') as progress:
            return fit_log(
                log,
                start.driveline,
                drag,
                options.fix,
                columns.known_delays,
                lambda: progress.update(next(count)),
            )
    except DdctError as error:
        if reasons := reasons_in_log(stretches):
            text = str(error).rstrip('.')
            raise DdctError(f'{text}: {reasons[0]}', place=options.log) from error
        raise


def _print_written(out: OutFolder, drive: LogDrive, origins: Sequence[str]) -> None:
    """Print where the values of the new car are from, and what it can be used for."""
    car, replay = (f'--{noun} {out.files[noun]}' for noun in NOUNS)
    print(f'{out.files[CAR]}:')
    for each in origins:
        print_note(f'- {each}')
    for note in drive.notes:
        print_note(f'Note: {note}.')
    compare = 'ddct compare --controllers pi,ls8 --headless'
    print_note(f'Replay the log: {compare} {car} {replay} --out runs/replay')
    if drive.base.clutch == STICK_SLIP:
        print_note(f'Launch it: {compare} {car} --drive launch --out runs/launch')
    else:
        print_note(
            f'Note: the clutch of the car is {drive.base.clutch}, which cannot lock. Launches, '
            f'shifts and a benchmark need clutch: {STICK_SLIP}: give a car with it, such as '
            f'--car {DEFAULT_CAR}, or a file with your gears and engine.'
        )


def _more(reasons: Sequence[str]) -> str:
    return f', and {len(reasons) - 1} more' if len(reasons) > 1 else ''


def _logs(options: argparse.Namespace, columns: ColumnMap) -> tuple[MeasuredLog, MeasuredLog]:
    """Return the log to fit and the held-out log to predict."""
    log = in_common_rows(read_log(options.log, columns, NEEDED))
    if options.check:
        return log, in_common_rows(read_log(options.check, columns, NEEDED))
    first, last = float(log.time_s[0]), float(log.time_s[-1])
    parting = last - options.hold_out * (last - first)
    return log.part(first, parting), log.part(parting, last)
