"""`identify --from LOG`: the driveline of a measured car, as tables, JSON and a scenario."""

import argparse
from pathlib import Path
from typing import Any

from rich.console import Console

from ddct_plant.base.errors import DdctError, require_name
from ddct_plant.files.output_file import require_place, write_text
from ddct_plant.identification.coefficients import SYMBOLS_AND_UNITS
from ddct_plant.identification.log_fit import PARAMETERS, LogFit, Prediction, fit_log, predict
from ddct_plant.identification.log_scenario import load_of, scenario_of
from ddct_plant.identification.log_stretches import LOAD, TORQUES, stretches_of
from ddct_plant.measured.columns import TIME, ColumnMap, load_columns, own_columns
from ddct_plant.measured.log import SPEEDS, MeasuredLog, read_log
from ddct_plant.program.command_line import ProgramParser, show_and_write
from ddct_plant.program.table import Table, print_table, text_or_dash
from ddct_plant.scenario.file import scenario_to_yaml
from ddct_plant.scenario.options import add_scenario_options
from ddct_plant.scenario.options import scenario_of as base_scenario

NEEDED = (*SPEEDS, *TORQUES)
HOLD_OUT = 0.3
USUAL = {
    'engine_inertia': (0.05, 2.0),
    'total_ratio': (2.0, 25.0),
    'vehicle_inertia': (40.0, 800.0),
}
"""Ranges of cars, in SI units. A value far outside was probably measured in other units."""


def add_log_options(parser: ProgramParser) -> None:
    """Add what belongs to --from."""
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
    group.add_argument('--out', metavar='FILE.yaml', help='write a scenario with this driveline')
    add_scenario_options(group, set_example='vehicle.wheel_radius_m=0.31')


def identify_log(options: argparse.Namespace) -> int:
    """Fit, predict, print and write; return the exit code."""
    if not 0.1 <= options.hold_out <= 0.9:
        raise DdctError(f'--hold-out is {options.hold_out:g}: give a share from 0.1 to 0.9')
    for option, file in (('--out', options.out), ('--json', options.json)):
        require_place(option, file)
    if options.out:
        require_name('the name of --out, which names the scenario,', Path(options.out).stem)
    base = base_scenario(options, options.overrides)
    columns = load_columns(options.columns) if options.columns else own_columns(TIME, *NEEDED)
    fitted, held_out = _logs(options, columns)
    known_load = load_of(base)
    with Console(stderr=True).status('fitting the driveline'):
        fit = fit_log(fitted, base.driveline, known_load, options.fix)
    predictions = predict(fit, stretches_of(held_out, known_load))
    content = _content(fit, predictions, fitted, held_out)
    show_and_write(options.json, content, lambda: _print(content))
    if options.out:
        scenario = scenario_of(base, Path(options.out).stem, fit, fitted)
        write_text(options.out, scenario_to_yaml(scenario))
    return 0


def _logs(options: argparse.Namespace, columns: ColumnMap) -> tuple[MeasuredLog, MeasuredLog]:
    """Return the log to fit and the one to predict."""
    log = read_log(options.log, columns, NEEDED)
    if options.check:
        return log, read_log(options.check, columns, NEEDED)
    first, last = float(log.time_s[0]), float(log.time_s[-1])
    parting = last - options.hold_out * (last - first)
    return log.part(first, parting), log.part(parting, last)


def _content(
    fit: LogFit, predictions: list[Prediction], fitted: MeasuredLog, held_out: MeasuredLog
) -> dict[str, Any]:
    rows = []
    for name in PARAMETERS:
        symbol, unit = SYMBOLS_AND_UNITS[name]
        interval = fit.interval(name)
        state = 'fitted' if interval else 'not determined' if name in fit.undetermined else 'fixed'
        lowest, highest = interval or (None, None)
        value = None if state == 'not determined' else fit.values[name]
        rows.append(
            {'name': name, 'symbol': symbol, 'value': value, 'lowest': lowest, 'highest': highest}
            | {'unit': unit, 'state': state, 'used': getattr(fit.parameters, name)}
        )
    return {
        'log': str(fitted.path),
        'sha256': fitted.digest,
        'fitted_s': [float(fitted.time_s[0]), float(fitted.time_s[-1])],
        'parameters': rows,
        'load_torque_n_m': fit.load_torque,
        'load_torque_measured': LOAD in fitted.signals,
        'noise_lags': fit.noise.order,
        'held_out': {
            'log': str(held_out.path),
            'time_s': [float(held_out.time_s[0]), float(held_out.time_s[-1])],
            'signals': [vars(each) | {'white': each.white} for each in predictions],
        },
        'notes': _notes(fit, predictions),
    }


def _notes(fit: LogFit, predictions: list[Prediction]) -> list[str]:
    notes = []
    if fit.undetermined:
        notes.append(
            f'the log does not determine {", ".join(fit.undetermined)}: the scenario keeps its '
            'value, and the other intervals hold for that value'
        )
    coloured = [each.signal for each in predictions if each.white is False]
    if coloured:
        notes.append(
            f'what is left of {", ".join(coloured)} is not white: the model lacks something that '
            'the log has, which the intervals do not count'
        )
    for name, (lowest, highest) in USUAL.items():
        if name in fit.std and not lowest <= fit.values[name] <= highest:
            notes.append(
                f'{name} is {fit.values[name]:.4g}, of cars it is {lowest:g} to {highest:g}: '
                'check the units of the columns'
            )
    return notes


def _print(content: dict[str, Any]) -> None:
    begin, end = content['fitted_s']
    print_table(
        Table(
            f'Driveline from {content["log"]}, {begin:g} to {end:g} s; intervals of 95 %',
            ('parameter', 'symbol', 'value', 'lowest', 'highest', 'unit', 'state', 'in scenario'),
            [
                (
                    row['name'],
                    row['symbol'],
                    *(text_or_dash(row[key], '.5g') for key in ('value', 'lowest', 'highest')),
                    row['unit'],
                    row['state'],
                    text_or_dash(row['used'], '.5g'),
                )
                for row in content['parameters']
            ],
        )
    )
    begin, end = content['held_out']['time_s']
    print_table(
        Table(
            f'Prediction of {content["held_out"]["log"]}, {begin:g} to {end:g} s',
            ('signal', 'RMS rad/s', 'NRMSE', 'whiteness p', 'residual'),
            [
                (
                    each['signal'],
                    text_or_dash(each['rms_rad_s'], '.3g'),
                    text_or_dash(each['nrmse'], '.3g'),
                    text_or_dash(each['whiteness_p'], '.2g'),
                    {None: '-', True: 'white', False: 'not white'}[each['white']],
                )
                for each in content['held_out']['signals']
            ],
        )
    )
    if content['load_torque_n_m'] is not None:
        print(f'Rolling resistance and slope: {content["load_torque_n_m"]:.4g} N m at the wheels.')
    for note in content['notes']:
        print(f'Note: {note}.')
