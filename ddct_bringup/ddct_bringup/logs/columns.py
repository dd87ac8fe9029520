# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Column map of a log, used by all programs: the column and the unit of each quantity."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ddct_plant.base.errors import ParameterError, require_number
from ddct_plant.base.options import close_name, require_known
from ddct_plant.base.units import si_values
from ddct_plant.files.input_file import located, user_text
from ddct_plant.files.yaml_text import parse_yaml
from ddct_plant.signals.topic import column_name
from ddct_plant.signals.topics import quantities

TIME = 'time'
DATE_TIME = 'iso8601'
"""Unit of a time in the form of a date with a time of day."""
_NOTHING = np.zeros(0)
PER_CENT = '%'
"""Unit of a torque as a share of another one, `LogColumn.full`."""
_OF_ROLLING = 'm/s'
"""SI unit of a wheel speed that a control unit gives as the speed of the tyre."""
_NUMBERS = ('scale', 'offset', 'full', 'radius_m', 'delay_s')
"""Keys of a column with a number."""
_KEYS = ('column', 'unit', 'between', *_NUMBERS)
LINEAR, HELD = BETWEEN = ('linear', 'held')
"""Interpolation of a signal between its samples: linear, or zero-order hold."""

MOST_DELAY_S = 0.1
"""Largest delay or lead of a signal in a log, in s."""


@dataclass(frozen=True)
class LogQuantity:
    """A quantity that a log may have."""

    symbol: str
    """Symbol of the thesis, empty for none."""
    meaning: str
    """Meaning in a few words."""
    signal: str
    """Name of this quantity among the signals of a run, empty for the time."""

    @property
    def unit(self) -> str:
        """SI unit."""
        return quantities()[self.signal][0].unit if self.signal else 's'

    @property
    def own_column(self) -> str:
        """Name of its column in the output of `score --signals-csv`."""
        return column_name(self.signal or TIME, self.unit)


QUANTITIES: Mapping[str, LogQuantity] = {
    TIME: LogQuantity('t', 'time, from any instant', ''),
    'engine_speed': LogQuantity('w_m', 'engine', 'engine_speed'),
    'shaft_speed': LogQuantity('w_p', 'primary shaft', 'primary_shaft_speed'),
    'wheel_speed': LogQuantity('w_r', 'wheels, their mean', 'wheel_speed'),
    'engine_torque': LogQuantity('C_m', 'at the crankshaft', 'engine_torque'),
    'torque_demand': LogQuantity('C_dem', 'demanded by the driver', 'torque_demand'),
    'clutch_torque': LogQuantity(
        'C_f', 'transmitted, positive towards the wheels', 'primary_shaft_effort'
    ),
    'load_torque': LogQuantity('C_load', 'at the wheels', 'load_torque'),
    'driveshaft_torque': LogQuantity('', 'at the wheels', 'driveshaft_effort'),
    'vehicle_speed': LogQuantity('V_x', 'of the car', 'vehicle_speed'),
    'vehicle_accel': LogQuantity('A_x', 'of the car', 'vehicle_accel'),
    'slip_reference': LogQuantity('', 'what w_m - w_p should be', 'slip_reference'),
    'torque_request': LogQuantity('', 'requested of the clutch', 'torque_request'),
}

OWN_HELD = ('engine_torque', 'load_torque')
"""
Quantities with zero-order hold in our bags and in the output of `score --signals-csv`.

The plant computes C_m and C_load once in a period of 10 ms; the others are linear.
"""


@dataclass(frozen=True)
class LogColumn:
    """Where a quantity is in a log, and what its numbers mean."""

    names: tuple[str, ...]
    """Names of the columns; the quantity is the mean of several."""
    unit: str
    """Unit of the numbers, once they have `scale` and `offset`."""
    delay_s: float | None = None
    """Known delay of the log in s; None for an unknown one."""
    scale: float = 1.0
    """Factor of the numbers in the file."""
    offset: float = 0.0
    """What is added after that, in `unit`."""
    full: float | None = None
    """Value of 100 % in the quantity's SI unit; None of another unit."""
    radius_m: float | None = None
    """Wheel radius in m with which a speed in m/s or km/h is one of a wheel; else None."""

    def si_values(self, table: Mapping[str, np.ndarray], si_unit: str) -> np.ndarray:
        """Return the quantity in its SI unit, (n,), out of the columns of a log by name."""
        found = [table[name] for name in self.names]
        numbers = found[0] if len(found) == 1 else np.mean(found, axis=0)
        numbers = self.scale * numbers + self.offset
        if self.full is not None:
            return numbers * (self.full / 100.0)
        if self.radius_m is not None:
            return si_values(numbers, self.unit, _OF_ROLLING) / self.radius_m
        return si_values(numbers, 's' if self.unit == DATE_TIME else self.unit, si_unit)


@dataclass(frozen=True)
class ColumnMap:
    """Column map of a log, with information on its run."""

    columns: Mapping[str, LogColumn]
    """Columns by quantity."""
    run: Mapping[str, Any]
    """Information on the run for `score`, by key; empty for `identify`."""
    held: tuple[str, ...] = ()
    """
    Quantities with zero-order hold between samples; the others are linear.

    C_load may be among them without a column: then the part of it that is computed is held.
    """
    optional: tuple[str, ...] = ()
    """Quantities that a log without their column lacks; the other columns must be there."""
    bus: Path | None = None
    """DBC file by which the frames of a bus in an MDF file are signals; None for none."""

    @property
    def known_delays(self) -> dict[str, float]:
        """Given delays in s, by quantity."""
        given = {name: each.delay_s for name, each in self.columns.items()}
        return {name: each for name, each in given.items() if each is not None}


def own_columns(*names: str, optional: tuple[str, ...] = ()) -> ColumnMap:
    """Return the column map of quantities in the output of `score --signals-csv`."""
    quantities_by_name = {name: QUANTITIES[name] for name in (*names, *optional)}
    columns = {
        name: LogColumn((each.own_column,), each.unit) for name, each in quantities_by_name.items()
    }
    return ColumnMap(columns, {}, OWN_HELD, optional)


def load_columns(file: str) -> ColumnMap:
    """Read a column map from a YAML file; raise DdctError that names the file and the error."""
    path = Path(file)
    with located(f'--columns {file}'):
        return _column_map(parse_yaml(user_text(path)), path.parent)


def _column_map(content: Any, folder: Path) -> ColumnMap:
    if not isinstance(content, dict) or not isinstance(content.get('columns'), dict):
        raise ParameterError('give columns by quantity, columns: {time: {column: t, unit: s}}')
    require_known(content, ('columns', 'run', 'dbc'))
    columns = {str(name): _column(str(name), each) for name, each in content['columns'].items()}
    if TIME not in columns:
        raise ParameterError(f'columns.{TIME} is missing', key=f'columns.{TIME}')
    run = content.get('run') or {}
    if not isinstance(run, dict):
        raise ParameterError('run: give keys and values')
    held = [name for name, each in content['columns'].items() if each.get('between') == HELD]
    bus = content.get('dbc')
    if bus is not None and not isinstance(bus, str):
        raise ParameterError(f'dbc is {bus!r}: give the name of a file', key='dbc')
    return ColumnMap(columns, run, tuple(held), bus=None if bus is None else folder / bus)


def _column(name: str, content: Any) -> LogColumn:
    key = f'columns.{name}'
    if name not in QUANTITIES:
        raise ParameterError(f'unknown {key}: {close_name(name, QUANTITIES, "columns.")}')
    if not isinstance(content, dict) or not {'column', 'unit'} <= set(content):
        raise ParameterError(f'{key}: give {{column: NAME, unit: UNIT}}', key=key)
    require_known(content, _KEYS, prefix=f'{key}.')
    numbers = {part: _number(f'{key}.{part}', part, content) for part in _NUMBERS}
    for part in ('unit', 'between'):
        if not isinstance(content.get(part, ''), str):
            raise ParameterError(
                f'{key}.{part} is {content[part]!r}: give text', key=f'{key}.{part}'
            )
    between = content.get('between', LINEAR)
    if between not in BETWEEN:
        raise ParameterError(
            f'{key}.between is {between!r}: choose from linear, held', key=f'{key}.between'
        )
    found = LogColumn(
        _names(f'{key}.column', content['column']),
        content['unit'],
        delay_s=numbers['delay_s'],
        scale=numbers['scale'] or 1.0,
        offset=numbers['offset'] or 0.0,
        full=numbers['full'],
        radius_m=numbers['radius_m'],
    )
    if name != TIME or found.unit != DATE_TIME:
        with located(key):
            _require_unit(name, found)
    return found


def _names(key: str, given: Any) -> tuple[str, ...]:
    names = given if isinstance(given, list) else [given]
    if not names or not all(isinstance(each, str) for each in names):
        raise ParameterError(f'{key} is {given!r}: give text, or a list of names', key=key)
    return tuple(names)


def _number(key: str, part: str, content: Mapping[str, Any]) -> float | None:
    """Return the number at a key of a column, None where it is not given."""
    value = content.get(part)
    if value is None:
        return None
    if part == 'delay_s':
        if type(value) not in (int, float) or not abs(value) <= MOST_DELAY_S:
            raise ParameterError(
                f'{key} is {value!r}: give a number of s up to {MOST_DELAY_S:g} either way',
                key=key,
            )
        return float(value)
    found = require_number(key, value, above=0.0 if part in ('full', 'radius_m') else None)
    if part == 'scale' and not found:
        raise ParameterError(f'{key} is 0: give a factor', key=key)
    return found


def _require_unit(name: str, column: LogColumn) -> None:
    """Raise ParameterError for a unit that the quantity cannot have, or that lacks a number."""
    si_unit, unit = QUANTITIES[name].unit, column.unit
    rolling = si_unit == 'rad/s' and name == 'wheel_speed' and column.radius_m is not None
    if unit == PER_CENT and si_unit == 'N m':
        if column.full is None:
            raise ParameterError(
                f'unit {unit}: give full, the value of 100 % in {si_unit}', key='full'
            )
        return
    for part, given in (('full', column.full), ('radius_m', column.radius_m and not rolling)):
        if given:
            raise ParameterError(f'unit {unit}: {part} is of another unit or quantity', key=part)
    try:
        si_values(_NOTHING, unit, _OF_ROLLING if rolling else si_unit)
    except ParameterError as error:
        advice = ''
        if name == 'wheel_speed' and not rolling and unit in ('m/s', 'km/h'):
            advice = ', or give radius_m, the wheel radius of whoever computed it'
        raise ParameterError(
            f'{error}, {DATE_TIME}' if name == TIME else f'{error}{advice}'
        ) from None
