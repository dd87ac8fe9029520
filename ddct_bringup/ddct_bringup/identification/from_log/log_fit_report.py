# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A fit to a log as JSON and as tables."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from ddct_bringup.identification.from_log.base_car import ASSUMED, GIVEN, OF_MAP, WheelRadius
from ddct_bringup.identification.from_log.prediction import SpeedPrediction
from ddct_bringup.identification.from_log.result import LogFit
from ddct_bringup.identification.from_log.stretches import LOAD
from ddct_bringup.identification.from_log.unknowns import REFERENCE
from ddct_bringup.identification.from_log.verdict import doubts
from ddct_bringup.logs.log import MeasuredLog
from ddct_bringup.logs.wheel_radius import MeasuredRadius
from ddct_plant.models.body import RADIUS
from ddct_plant.models.parameters import SYMBOLS_AND_UNITS
from ddct_plant.program.printed_table import print_note, print_table
from ddct_plant.program.table import TextTable, Weight, text_or_dash, with_reasons


@dataclass(frozen=True)
class FittedParameter:
    """One parameter of the driveline with its 95 % interval, in SI units."""

    name: str
    """Name of its key in a car."""
    symbol: str
    """Symbol in the thesis."""
    value: float | None
    """None where the log does not determine it."""
    lowest: float | None
    highest: float | None
    unit: str
    state: Literal['fitted', 'fixed', 'not determined']
    used: float
    """Value of the new car."""


@dataclass(frozen=True)
class FittedDelay:
    """Delay of one signal with its 95 % interval."""

    signal: str
    delay_s: float | None
    """None where the log does not determine it."""
    lowest_s: float | None
    highest_s: float | None
    state: Literal['fitted', 'given', 'not determined', 'reference']


@dataclass(frozen=True)
class HeldOut:
    """Held-out data, and how well they are predicted."""

    log: str
    time_s: tuple[float, float]
    """First and last time."""
    signals: Sequence[SpeedPrediction]


@dataclass(frozen=True)
class LogFitDocument:
    """Document of `identify --from LOG --json`."""

    verdict: Literal['accepted', 'refused']
    reasons: Sequence[str]
    """Reasons to refuse the fit; none to accept it."""
    log: str
    sha256: str
    fitted_s: tuple[float, float]
    """First and last time of the log."""
    parameters: Sequence[FittedParameter]
    delays: Sequence[FittedDelay]
    wheel_radius: WheelRadius
    mass_kg: float
    """Mass J_v / r_w^2."""
    load_torque_n_m: float | None
    """Rolling resistance and slope at the wheels; None where C_load was measured."""
    load_torque_measured: bool
    stretches: int
    """Number of parts without a gap that were fitted."""
    held_out: HeldOut
    notes: Sequence[str]
    """Limits of the fit, as sentences."""


@dataclass(frozen=True)
class LogFitReport:
    """A fit to a log, its prediction of held-out data, and the reasons to refuse it."""

    fit: LogFit
    radius: WheelRadius
    base: str
    """Name of what the fit started from."""
    stretches: int
    """Number of parts without a gap that were fitted."""
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
        notes = [*doubts(self.fit, self.predictions), *_on_radius(self.radius, self.base)]
        if self.stretches > 1:
            notes.append(f'the log has gaps, and {self.stretches} stretches between them are used')
        return notes

    @property
    def mass_kg(self) -> float:
        """Mass J_v / r_w^2 in kg."""
        return self.fit.parameters.vehicle_inertia / self.radius.value_m**2

    @property
    def parameters(self) -> list[FittedParameter]:
        """Every parameter of the driveline."""
        fit, used, rows = self.fit, self.fit.parameters.values(), []
        for name, (symbol, unit) in SYMBOLS_AND_UNITS.items():
            lowest, highest = fit.interval(name) or (None, None)
            weak = name in fit.undetermined
            rows.append(
                FittedParameter(
                    name,
                    symbol,
                    None if weak else fit.values[name],
                    lowest,
                    highest,
                    unit,
                    'not determined' if weak else 'fixed' if lowest is None else 'fitted',
                    used[name],
                )
            )
        return rows

    @property
    def delays(self) -> list[FittedDelay]:
        """Delay of every signal."""
        return [self._delay(name, value) for name, value in self.fit.delays.items()]

    def _delay(self, name: str, value: float) -> FittedDelay:
        lowest, highest = self.fit.interval(name) or (None, None)
        if name in self.fit.undetermined:
            return FittedDelay(name, None, lowest, highest, 'not determined')
        if name == REFERENCE and not value:
            return FittedDelay(name, value, lowest, highest, 'reference')
        return FittedDelay(name, value, lowest, highest, 'given' if lowest is None else 'fitted')

    @property
    def document(self) -> LogFitDocument:
        """Document of `--json`."""
        fitted, held_out = self.fitted, self.held_out
        return LogFitDocument(
            verdict='refused' if self.reasons else 'accepted',
            reasons=self.reasons,
            log=str(fitted.path),
            sha256=fitted.digest,
            fitted_s=_span(fitted),
            parameters=self.parameters,
            delays=self.delays,
            wheel_radius=self.radius,
            mass_kg=self.mass_kg,
            load_torque_n_m=self.fit.load_torque,
            load_torque_measured=LOAD in fitted.signals,
            stretches=self.stretches,
            held_out=HeldOut(str(held_out.path), _span(held_out), self.predictions),
            notes=self.notes,
        )


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
        TextTable(
            f'Driveline from {report.fitted.path}, {begin:g} to {end:g} s; intervals of 95 %',
            ('parameter', 'symbol', 'value', 'lowest', 'highest', 'unit', 'state', 'new car'),
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
        TextTable(
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
        TextTable(
            f'Prediction of {report.held_out.path}, {begin:g} to {end:g} s',
            ('signal', 'RMS rad/s', 'NRMSE'),
            [
                (
                    each.signal,
                    text_or_dash(each.rms_rad_s, '.3g'),
                    text_or_dash(each.nrmse, '.3g'),
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


def _print_table(table: TextTable) -> None:
    print_table(replace(with_reasons(table, _dash_reason), complete='--json FILE'))


def _dash_reason(header: str, row: Sequence[str]) -> str:
    """Return the reason of a dash, from its column and its row."""
    if 'not determined' in row:
        return 'the log does not determine it'
    if header in ('lowest', 'highest'):
        return 'not fitted'
    return 'it does not vary'


def _radius_text(report: LogFitReport) -> str:
    """Return the wheel radius with its interval and its origin."""
    radius = report.radius
    value, found = f'{radius.value_m:.5g} m', radius.measured
    if radius.state == ASSUMED:
        return f'{value}, assumed: that of {report.base}'
    if radius.state == OF_MAP:
        return f'{value}, by radius_m of the column map: a wheel speed in km/h or m/s has no other'
    if radius.state == GIVEN or not found:
        return f'{value}, given by --set'
    return f'{value} ({_interval(found)}), measured: vehicle_speed over wheel_speed'


def _interval(found: MeasuredRadius) -> str:
    return f'{found.lowest_m:.5g} to {found.highest_m:.5g}'


def _on_radius(radius: WheelRadius, base: str) -> Iterator[str]:
    """Yield notes on a wheel radius that may be wrong."""
    if radius.state == ASSUMED:
        yield (
            f'the wheel radius of {radius.value_m:.5g} m is an assumption, that of {base}: the '
            'mass, and V_x, A_x and jerk of the new car are wrong with it; log '
            f'vehicle_speed too, or give --set {RADIUS}=...'
        )
    if found := radius.contradiction:
        yield (
            f'the wheel radius of {radius.value_m:.5g} m is given, and vehicle_speed over '
            f'wheel_speed is {found.value_m:.5g} m ({_interval(found)})'
        )
