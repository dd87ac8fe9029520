# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A fit to a log as JSON and as tables."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

from ddct_bringup.identification.from_log.delays import REFERENCE
from ddct_bringup.identification.from_log.prediction import SpeedPrediction
from ddct_bringup.identification.from_log.result import (
    ASSUMED,
    GIVEN,
    PARAMETERS,
    LogFit,
    WheelRadius,
)
from ddct_bringup.identification.from_log.stretch import LOAD
from ddct_bringup.identification.from_log.verdict import doubts
from ddct_bringup.logs.log import MeasuredLog
from ddct_bringup.logs.wheel_radius import MeasuredRadius
from ddct_plant.models.body import RADIUS
from ddct_plant.models.parameters import SYMBOLS_AND_UNITS
from ddct_plant.program.printed_table import print_note, print_table
from ddct_plant.program.table import Table, Weight, text_or_dash, with_reasons


@dataclass(frozen=True)
class ParameterRow:
    """One parameter of the driveline, in SI units."""

    name: str
    """Name of its key in a scenario."""
    symbol: str
    """Symbol in the thesis."""
    value: float | None
    """Value of the fit; None where the log does not determine it."""
    lowest: float | None
    """Lower end of the 95 % interval; None for a parameter that was not fitted."""
    highest: float | None
    """Upper end of that interval."""
    unit: str
    state: str
    """State of the parameter: `fitted`, `fixed` or `not determined`."""
    used: float
    """Value in the new scenario."""


@dataclass(frozen=True)
class DelayRow:
    """Delay of one signal of the log relative to the engine speed."""

    signal: str
    """Name of the signal."""
    delay_s: float | None
    """Delay in s; None where the log does not determine it."""
    lowest_s: float | None
    """Lower end of the 95 % interval in s; None for a delay that was not fitted."""
    highest_s: float | None
    """Upper end of that interval in s."""
    state: str
    """State of the delay: `fitted`, `given`, `reference` or `not determined`."""


@dataclass(frozen=True)
class LogFitReport:
    """A fit to a log, its prediction of held-out data, and the reasons to refuse it."""

    fit: LogFit
    radius: WheelRadius
    base: str
    """Name of the base scenario."""
    predictions: Sequence[SpeedPrediction]
    """Prediction of each speed and of the slip."""
    reasons: Sequence[str]
    """Reasons to refuse the fit, as sentences; none to accept it."""
    fitted: MeasuredLog
    """Log that was fitted."""
    held_out: MeasuredLog
    """Log that was predicted."""

    @property
    def notes(self) -> list[str]:
        """Notes on the limits of the fit, as sentences."""
        return [*doubts(self.fit, self.predictions), *_on_radius(self.radius, self.base)]

    @property
    def mass_kg(self) -> float:
        """Mass J_v / r_w^2 in kg."""
        return self.fit.parameters.vehicle_inertia / self.radius.value_m**2

    @property
    def parameters(self) -> list[ParameterRow]:
        """Every parameter of the driveline."""
        fit, rows, used = self.fit, [], self.fit.parameters.values()
        for name in PARAMETERS:
            symbol, unit = SYMBOLS_AND_UNITS[name]
            interval = fit.interval(name)
            weak = name in fit.undetermined
            state = 'fitted' if interval else 'not determined' if weak else 'fixed'
            value = None if state == 'not determined' else fit.values[name]
            lowest, highest = interval or (None, None)
            row = ParameterRow(name, symbol, value, lowest, highest, unit, state, used[name])
            rows.append(row)
        return rows

    @property
    def delays(self) -> list[DelayRow]:
        """Delay of every signal of the log."""
        fit, rows = self.fit, []
        for name, value in fit.delays.items():
            interval = fit.interval(name)
            state = 'fitted' if interval else 'given'
            if name in fit.undetermined:
                state = 'not determined'
            elif name == REFERENCE and not value:
                state = 'reference'
            delay = None if name in fit.undetermined else value
            lowest, highest = interval or (None, None)
            rows.append(DelayRow(name, delay, lowest, highest, state))
        return rows


def content_of(report: LogFitReport) -> dict[str, Any]:
    """Return the content of the JSON file; null for a value that does not exist."""
    fit, fitted, held_out = report.fit, report.fitted, report.held_out
    return {
        'verdict': 'refused' if report.reasons else 'accepted',
        'reasons': list(report.reasons),
        'log': str(fitted.path),
        'sha256': fitted.digest,
        'fitted_s': list(_span(fitted)),
        'parameters': [vars(row) for row in report.parameters],
        'delays': [vars(row) for row in report.delays],
        'wheel_radius': {
            'value_m': report.radius.value_m,
            'state': report.radius.state,
            'measured': vars(report.radius.measured) if report.radius.measured else None,
        },
        'mass_kg': report.mass_kg,
        'load_torque_n_m': fit.load_torque,
        'load_torque_measured': LOAD in fitted.signals,
        'noise_lags': fit.noise.order,
        'held_out': {
            'log': str(held_out.path),
            'time_s': list(_span(held_out)),
            'signals': [vars(each) | {'white': each.white} for each in report.predictions],
        },
        'notes': report.notes,
    }


def _span(log: MeasuredLog) -> tuple[float, float]:
    """Return the first and the last time of a log in s."""
    return float(log.time_s[0]), float(log.time_s[-1])


def print_fit(report: LogFitReport) -> None:
    """Print the result as tables, with reasons against the fit first."""
    if report.reasons:
        print('REFUSED. Do not use this fit:')
        for reason in report.reasons:
            print_note(f'- {reason}')
    begin, end = _span(report.fitted)
    _print_table(
        Table(
            f'Driveline from {report.fitted.path}, {begin:g} to {end:g} s; intervals of 95 %',
            ('parameter', 'symbol', 'value', 'lowest', 'highest', 'unit', 'state', 'new scenario'),
            [
                (
                    row.name,
                    row.symbol,
                    *(text_or_dash(each, '.5g') for each in (row.value, row.lowest, row.highest)),
                    row.unit,
                    row.state,
                    text_or_dash(row.used, '.5g'),
                )
                for row in report.parameters
            ],
            weights=(
                *(Weight.IDENTIFYING, Weight.USEFUL, Weight.NEEDED, Weight.NEEDED, Weight.NEEDED),
                *(Weight.NEEDED, Weight.NEEDED, Weight.USEFUL),
            ),
        )
    )
    _print_table(
        Table(
            'How late the log has each signal, against the engine speed',
            ('signal', 'delay ms', 'lowest', 'highest', 'state'),
            [
                (
                    row.signal,
                    *(
                        text_or_dash(None if each is None else 1e3 * each, '.3f')
                        for each in (row.delay_s, row.lowest_s, row.highest_s)
                    ),
                    row.state,
                )
                for row in report.delays
            ],
        )
    )
    begin, end = _span(report.held_out)
    _print_table(
        Table(
            f'Prediction of {report.held_out.path}, {begin:g} to {end:g} s',
            ('signal', 'RMS rad/s', 'NRMSE', 'whiteness p', 'torque p', 'residual'),
            [
                (
                    each.signal,
                    text_or_dash(each.rms_rad_s, '.3g'),
                    text_or_dash(each.nrmse, '.3g'),
                    text_or_dash(each.whiteness_p, '.2g'),
                    text_or_dash(each.torque_p, '.2g'),
                    {None: '-', True: 'noise', False: 'not noise'}[each.white],
                )
                for each in report.predictions
            ],
        )
    )
    print_note(
        f'Wheel radius: {_radius_text(report)}. Mass: {report.mass_kg:.5g} kg, J_v / r_w^2.'
    )
    if report.fit.load_torque is not None:
        print_note(
            f'Rolling resistance and slope: {report.fit.load_torque:.4g} N m at the wheels.'
        )
    for note in report.notes:
        print_note(f'Note: {note}.')


def _print_table(table: Table) -> None:
    print_table(replace(with_reasons(table, _dash_reason), complete='--json FILE'))


def _dash_reason(header: str, row: Sequence[str]) -> str:
    """Return the reason of a dash, from its column and its row."""
    if 'not determined' in row:
        return 'the log does not determine it'
    if header in ('lowest', 'highest'):
        return 'not fitted'
    return 'the log has too few values for this test'


def _radius_text(report: LogFitReport) -> str:
    """Return the wheel radius with its interval and its origin."""
    radius = report.radius
    value, found = f'{radius.value_m:.5g} m', radius.measured
    if radius.state == ASSUMED:
        return f'{value}, assumed: that of the scenario {report.base}'
    if radius.state == GIVEN or not found:
        return f'{value}, given by --set'
    return f'{value} ({_interval(found)}), measured: vehicle_speed over wheel_speed'


def _interval(found: MeasuredRadius) -> str:
    return f'{found.lowest_m:.5g} to {found.highest_m:.5g}'


def _on_radius(radius: WheelRadius, base: str) -> Iterator[str]:
    """Yield notes on a wheel radius that may be wrong."""
    if radius.state == ASSUMED:
        yield (
            f'the wheel radius of {radius.value_m:.5g} m is an assumption, that of the scenario '
            f'{base}: the mass, and V_x, A_x and jerk of the new scenario are wrong with it; log '
            f'vehicle_speed too, or give --set {RADIUS}=...'
        )
    if found := radius.contradiction:
        yield (
            f'the wheel radius of {radius.value_m:.5g} m is given, and vehicle_speed over '
            f'wheel_speed is {found.value_m:.5g} m ({_interval(found)})'
        )
