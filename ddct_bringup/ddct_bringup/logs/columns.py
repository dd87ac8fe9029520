# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Column map of a log, used by all programs: the column and the unit of each quantity."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ddct_plant.base.errors import ParameterError
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
    """Column of a quantity in a CSV log."""

    column: str
    """Name of the column."""
    unit: str
    """Unit of its values."""
    delay_s: float | None = None
    """Known delay of the log in s; None for an unknown one."""


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

    @property
    def known_delays(self) -> dict[str, float]:
        """Given delays in s, by quantity."""
        given = {name: each.delay_s for name, each in self.columns.items()}
        return {name: each for name, each in given.items() if each is not None}


def own_columns(*names: str, optional: tuple[str, ...] = ()) -> ColumnMap:
    """Return the column map of quantities in the output of `score --signals-csv`."""
    quantities_by_name = {name: QUANTITIES[name] for name in (*names, *optional)}
    columns = {
        name: LogColumn(each.own_column, each.unit) for name, each in quantities_by_name.items()
    }
    return ColumnMap(columns, {}, OWN_HELD, optional)


def load_columns(file: str) -> ColumnMap:
    """Read a column map from a YAML file; raise DdctError that names the file and the error."""
    with located(f'--columns {file}'):
        return _column_map(parse_yaml(user_text(Path(file))))


def _column_map(content: Any) -> ColumnMap:
    if not isinstance(content, dict) or not isinstance(content.get('columns'), dict):
        raise ParameterError('give columns by quantity, columns: {time: {column: t, unit: s}}')
    require_known(content, ('columns', 'run'))
    columns = {str(name): _column(str(name), each) for name, each in content['columns'].items()}
    if TIME not in columns:
        raise ParameterError(f'columns.{TIME} is missing', key=f'columns.{TIME}')
    run = content.get('run') or {}
    if not isinstance(run, dict):
        raise ParameterError('run: give keys and values')
    held = [name for name, each in content['columns'].items() if each.get('between') == HELD]
    return ColumnMap(columns, run, tuple(held))


def _column(name: str, content: Any) -> LogColumn:
    key = f'columns.{name}'
    if name not in QUANTITIES:
        raise ParameterError(f'unknown {key}: {close_name(name, QUANTITIES, "columns.")}')
    if not isinstance(content, dict) or not {'column', 'unit'} <= set(content):
        raise ParameterError(f'{key}: give {{column: NAME, unit: UNIT}}', key=key)
    require_known(content, ('column', 'unit', 'between', 'delay_s'), prefix=f'{key}.')
    delay = content.get('delay_s')
    if delay is not None and (type(delay) not in (int, float) or not abs(delay) <= MOST_DELAY_S):
        raise ParameterError(
            f'{key}.delay_s is {delay!r}: give a number of s up to {MOST_DELAY_S:g} either way',
            key=f'{key}.delay_s',
        )
    for part, value in content.items():
        if part != 'delay_s' and not isinstance(value, str):
            raise ParameterError(f'{key}.{part} is {value!r}: give text', key=f'{key}.{part}')
    between = content.get('between', LINEAR)
    if between not in BETWEEN:
        raise ParameterError(
            f'{key}.between is {between!r}: choose from linear, held', key=f'{key}.between'
        )
    found = LogColumn(content['column'], content['unit'], delay)
    if name != TIME or found.unit != DATE_TIME:
        with located(key):
            _require_unit(name, found.unit)
    return found


def _require_unit(name: str, unit: str) -> None:
    try:
        si_values(_NOTHING, unit, QUANTITIES[name].unit)
    except ParameterError as error:
        raise ParameterError(f'{error}, {DATE_TIME}' if name == TIME else str(error)) from None
