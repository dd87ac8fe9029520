# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`identify --from LOG`: the driveline of a measured car, as tables, JSON and a scenario."""

import argparse
import itertools
from collections.abc import Sequence
from pathlib import Path

from ddct_bringup.identification.from_log.fit import fit_log
from ddct_bringup.identification.from_log.log_fit_report import LogFitReport, content_of, print_fit
from ddct_bringup.identification.from_log.prediction import predict
from ddct_bringup.identification.from_log.result import PARAMETERS
from ddct_bringup.identification.from_log.scenario import (
    load_of,
    name_of,
    radius_of,
    replay_of,
    require_new_scenario,
    with_radius,
    write_scenario,
)
from ddct_bringup.identification.from_log.stretch import TORQUES
from ddct_bringup.identification.from_log.stretches import stretches_of
from ddct_bringup.identification.from_log.verdict import reasons_against
from ddct_bringup.logs.columns import TIME, ColumnMap, load_columns, own_columns
from ddct_bringup.logs.log import SPEEDS, MeasuredLog, read_log
from ddct_bringup.logs.wheel_radius import VEHICLE_SPEED
from ddct_plant.base.errors import DdctError
from ddct_plant.files.output_file import require_place
from ddct_plant.program.command_line import ProgramParser, show_and_write
from ddct_plant.program.progress import Progress
from ddct_plant.scenario.choices.command_line import add_scenario_options
from ddct_plant.scenario.chosen import scenario_of as base_scenario

NEEDED = (*SPEEDS, *TORQUES)
"""Quantities that a log must have."""
HOLD_OUT = 0.3
"""Default share of the log that is held out."""


def add_log_options(parser: ProgramParser) -> None:
    """Add the options of `--from LOG`."""
    group = parser.add_argument_group('from a log')
    group.add_argument('--from', dest='log', metavar='LOG', type=Path, help='a CSV log or a bag')
    group.add_argument(
        '--columns',
        metavar='FILE',
        help='column map: which column holds which quantity; default: those of score '
        '--signals-csv',
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
        help=f'keep this parameter as the scenario has it; one of {", ".join(PARAMETERS)}',
    )
    group.add_argument(
        '--force',
        action='store_true',
        help='accept a fit that is refused: write the scenario all the same, exit code 0',
    )
    group.add_argument(
        '--out',
        metavar='FILE.yaml',
        help='write a scenario that replays the log, and its car and drive beside it',
    )
    group.add_argument(
        '--overwrite', action='store_true', help='replace an earlier scenario at --out'
    )
    add_scenario_options(group, set_example='vehicle.wheel_radius_m=0.31')


def identify_log(options: argparse.Namespace) -> int:
    """Fit the log, predict held-out data, print and write the result; return the exit code."""
    if not 0.1 <= options.hold_out <= 0.9:
        raise DdctError(f'--hold-out is {options.hold_out:g}: give a share from 0.1 to 0.9')
    for option, file in (('--out', options.out), ('--json', options.json)):
        require_place(option, file)
    require_new_scenario(options.out, overwrite=options.overwrite)
    start = base_scenario(options, options.overrides)
    columns = (
        load_columns(options.columns)
        if options.columns
        else own_columns(TIME, *NEEDED, optional=(VEHICLE_SPEED,))
    )
    fitted, held_out = _logs(options, columns)
    radius = radius_of(start, options.overrides, fitted)
    base = with_radius(start, radius)
    known_load, known_delays = load_of(base), columns.known_delays
    # Before the fit, which takes long, because it raises the errors of the held-out data.
    predicted = stretches_of(held_out, known_load)
    count = itertools.count(1)
    with Progress('fitting the driveline, evaluations') as progress:
        fit = fit_log(
            fitted,
            start.driveline,
            known_load,
            options.fix,
            known_delays,
            lambda: progress.update(next(count)),
        )
    predictions = predict(fit, predicted)
    reasons = reasons_against(fit, predictions, stretches_of(fitted, known_load))
    report = LogFitReport(fit, radius, start.name, predictions, reasons, fitted, held_out)
    show_and_write(options.json, content_of(report), lambda: print_fit(report))
    if reasons and not options.force:
        kept = '; no scenario is written' if options.out else ''
        raise DdctError(
            f'{options.log}: the fit is refused: {reasons[0]}{_more(reasons)}{kept}: mend the log '
            'or its column map, or accept the fit with --force'
        )
    if options.out:
        whole = read_log(options.log, columns, NEEDED)
        write_scenario(options.out, replay_of(base, name_of(options.log), fit, whole))
    return 0


def _more(reasons: Sequence[str]) -> str:
    return f', and {len(reasons) - 1} more' if len(reasons) > 1 else ''


def _logs(options: argparse.Namespace, columns: ColumnMap) -> tuple[MeasuredLog, MeasuredLog]:
    """Return the log to fit and the held-out log to predict."""
    log = read_log(options.log, columns, NEEDED)
    if options.check:
        return log, read_log(options.check, columns, NEEDED)
    first, last = float(log.time_s[0]), float(log.time_s[-1])
    parting = last - options.hold_out * (last - first)
    return log.part(first, parting), log.part(parting, last)
