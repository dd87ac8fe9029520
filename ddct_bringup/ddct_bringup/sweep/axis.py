# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Axis of a sweep, given by `--over`: a key and its values."""

import math
import re
from dataclasses import dataclass
from typing import Any

import numpy as np

from ddct_bringup.campaign.keys import option_of
from ddct_plant.base.errors import ParameterError, printable
from ddct_plant.files.input_file import located
from ddct_plant.files.yaml_text import parse_yaml
from ddct_plant.scenario.choices.scenarios import CHOICES

MOST = 10_000
"""Largest number of values of one key and of points of a sweep; use a campaign for more."""
_HOW = 'write KEY=START:STOP:COUNT, such as wear_gain=0.5:1.5:11, or KEY=A,B,C'
_WHOLE = re.compile(r'[+-]?\d+')
_DIGITS = 12
"""Significant digits of a value between START and STOP, so that the printed value is exact."""


@dataclass(frozen=True)
class Axis:
    """A key and its values."""

    key: str
    """Setting of a run, such as `wear_gain`, or a dotted scenario key."""
    values: tuple[Any, ...]
    unit: str = ''

    def __post_init__(self) -> None:
        """Check the values; raise ParameterError if there are none, too many or equal ones."""
        where = f'--over {printable(self.key)}'
        if not 1 <= len(self.values) <= MOST:
            raise ParameterError(f'{where}: {len(self.values)} values: give 1 to {MOST}')
        for value in self.values:
            if isinstance(value, (list, tuple, dict)) or value is None:
                raise ParameterError(f'{where}: {value!r} is no single value: {_HOW}', key=where)
            if self.values.count(value) > 1:
                raise ParameterError(
                    f'{where}: {value} is there twice: give each value once', key=where
                )

    @property
    def heading(self) -> str:
        """Key with its unit."""
        return f'{self.key}, {self.unit}' if self.unit else self.key

    @property
    def numeric(self) -> bool:
        """Whether every value is a number."""
        return all(type(value) in (int, float) for value in self.values)


def axis_of(text: str) -> Axis:
    """Return the axis for `KEY=START:STOP:COUNT` or `KEY=A,B,C`, else raise ParameterError."""
    key, _, given = text.partition('=')
    if not key or not given:
        raise ParameterError(f'--over {printable(text)}: {_HOW}', key='--over')
    parts = [part.strip() for part in given.split(':')]
    values = [_value(part, key) for part in given.split(',')] if len(parts) == 1 else None
    return axis(key, _range(text, parts) if values is None else values)


def axis(key: str, values: Any) -> Axis:
    """
    Return the axis of a key; whole numbers are converted to the type of the key.

    Raise ParameterError for an unknown key, or one that a sweep cannot vary.
    """
    if key in CHOICES:
        raise ParameterError(f'--over {key}: give one by --{key}, or a campaign', key='--over')
    described = option_of('--over', key)
    if described is not None and described.kind is float:
        values = [float(value) if type(value) is int else value for value in values]
    return Axis(key, tuple(values), described.unit if described else '')


def value_text(value: Any) -> str:
    """Return a value as text for tables and messages."""
    return f'{value:.{_DIGITS}g}' if type(value) in (int, float) else printable(value)


def _range(text: str, parts: list[str]) -> list[float | int]:
    try:
        start, stop, count = (*map(float, parts[:2]), int(parts[2]))
        if len(parts) != 3 or not math.isfinite(start) or not math.isfinite(stop):
            raise ValueError
    except (ValueError, IndexError) as error:
        raise ParameterError(f'--over {printable(text)}: {_HOW}', key='--over') from error
    if not 1 <= count <= MOST:
        raise ParameterError(
            f'--over {printable(text)}: COUNT is {count}: give 1 to {MOST}', key='--over'
        )
    if start == stop and count > 1:
        raise ParameterError(
            f'--over {printable(text)}: START and STOP are the same: give two values, or COUNT 1',
            key='--over',
        )
    values = [float(f'{value:.{_DIGITS}g}') for value in np.linspace(start, stop, count)]
    if all(map(_WHOLE.fullmatch, parts[:2])) and all(value.is_integer() for value in values):
        return [int(value) for value in values]
    return values


def _value(text: str, key: str) -> Any:
    text = text.strip()
    if _WHOLE.fullmatch(text):
        return int(text)
    try:
        number = float(text)
    except ValueError:
        with located(f'--over {printable(key)}'):
            return parse_yaml(text)
    if not math.isfinite(number):
        raise ParameterError(
            f'--over {printable(key)}: {text} is not finite: give a number', key='--over'
        )
    return number
