# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A fit to a log as JSON and as tables."""

from collections.abc import Sequence
from typing import Any

from ddct_plant.identification.coefficients import SYMBOLS_AND_UNITS
from ddct_plant.identification.from_log.delays import REFERENCE
from ddct_plant.identification.from_log.prediction import Prediction
from ddct_plant.identification.from_log.result import PARAMETERS, LogFit
from ddct_plant.identification.from_log.stretch import LOAD
from ddct_plant.identification.from_log.verdict import doubts
from ddct_plant.measured.log import MeasuredLog
from ddct_plant.program.table import Table, print_table, text_or_dash


def content_of(
    fit: LogFit,
    predictions: Sequence[Prediction],
    reasons: Sequence[str],
    fitted: MeasuredLog,
    held_out: MeasuredLog,
) -> dict[str, Any]:
    """Return the result for tables and JSON; null for a value that does not exist."""
    rows, used = [], fit.parameters.values()
    for name in PARAMETERS:
        symbol, unit = SYMBOLS_AND_UNITS[name]
        interval = fit.interval(name)
        state = 'fitted' if interval else 'not determined' if name in fit.undetermined else 'fixed'
        lowest, highest = interval or (None, None)
        value = None if state == 'not determined' else fit.values[name]
        rows.append(
            {'name': name, 'symbol': symbol, 'value': value, 'lowest': lowest, 'highest': highest}
            | {'unit': unit, 'state': state, 'used': used[name]}
        )
    return {
        'verdict': 'refused' if reasons else 'accepted',
        'reasons': list(reasons),
        'log': str(fitted.path),
        'sha256': fitted.digest,
        'fitted_s': [float(fitted.time_s[0]), float(fitted.time_s[-1])],
        'parameters': rows,
        'delays': _delays(fit),
        'load_torque_n_m': fit.load_torque,
        'load_torque_measured': LOAD in fitted.signals,
        'noise_lags': fit.noise.order,
        'held_out': {
            'log': str(held_out.path),
            'time_s': [float(held_out.time_s[0]), float(held_out.time_s[-1])],
            'signals': [vars(each) | {'white': each.white} for each in predictions],
        },
        'notes': doubts(fit, predictions),
    }


def _delays(fit: LogFit) -> list[dict[str, Any]]:
    rows = []
    for name, value in fit.delays.items():
        interval = fit.interval(name)
        state = 'fitted' if interval else 'given'
        if name in fit.undetermined:
            state = 'not determined'
        elif name == REFERENCE and not value:
            state = 'reference'
        lowest, highest = interval or (None, None)
        rows.append(
            {
                'signal': name,
                'delay_s': None if name in fit.undetermined else value,
                'lowest_s': lowest,
                'highest_s': highest,
                'state': state,
            }
        )
    return rows


def print_fit(content: dict[str, Any]) -> None:
    """Print the result as tables, with reasons against the fit first."""
    if content['reasons']:
        print('REFUSED. Do not use this fit:')
        for reason in content['reasons']:
            print(f'- {reason}')
    begin, end = content['fitted_s']
    print_table(
        Table(
            f'Driveline from {content["log"]}, {begin:g} to {end:g} s; intervals of 95 %',
            ('parameter', 'symbol', 'value', 'lowest', 'highest', 'unit', 'state', 'new scenario'),
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
    print_table(
        Table(
            'How late the log has each signal, against the engine speed',
            ('signal', 'delay ms', 'lowest', 'highest', 'state'),
            [
                (
                    row['signal'],
                    *(
                        text_or_dash(None if row[key] is None else 1e3 * row[key], '.3f')
                        for key in ('delay_s', 'lowest_s', 'highest_s')
                    ),
                    row['state'],
                )
                for row in content['delays']
            ],
        )
    )
    begin, end = content['held_out']['time_s']
    print_table(
        Table(
            f'Prediction of {content["held_out"]["log"]}, {begin:g} to {end:g} s',
            ('signal', 'RMS rad/s', 'NRMSE', 'whiteness p', 'torque p', 'residual'),
            [
                (
                    each['signal'],
                    text_or_dash(each['rms_rad_s'], '.3g'),
                    text_or_dash(each['nrmse'], '.3g'),
                    text_or_dash(each['whiteness_p'], '.2g'),
                    text_or_dash(each['torque_p'], '.2g'),
                    {None: '-', True: 'noise', False: 'not noise'}[each['white']],
                )
                for each in content['held_out']['signals']
            ],
        )
    )
    if content['load_torque_n_m'] is not None:
        print(f'Rolling resistance and slope: {content["load_torque_n_m"]:.4g} N m at the wheels.')
    for note in content['notes']:
        print(f'Note: {note}.')
