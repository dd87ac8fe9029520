# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
An option: one value that a user can set, described once.

Files, programs, nodes, controllers and pages take default, unit, range and meaning from here.
"""

import dataclasses
import math
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

from ddct_plant.base.errors import ParameterError, require_choice, require_number
from ddct_plant.base.timebase import steps_in

REQUIRED: Any = dataclasses.MISSING
"""Default of a required option."""
Options = Mapping[str, 'Option']
"""Options by name."""
_GIVE = {bool: 'true or false', str: 'text'}
"""Accepted values of an option that is no number, by its kind, for errors."""


@dataclass(frozen=True)
class Option:
    """One value that can be set: its default, meaning, unit, range and source."""

    default: Any
    """Default value; REQUIRED for a required option, None for no value."""
    meaning: str
    """Meaning in a few words, as in help and on pages."""
    unit: str = ''
    """Unit, empty for none."""
    source: str = ''
    """Source of the default: a section of the thesis, a program, or `options.ASSUMED`."""
    otherwise: str = ''
    """Text in place of the default, where no value is given and the default cannot be shown."""
    kind: type = float
    """Type of the value: float, int, bool or str; taken from the default if that is a value."""
    above: float | None = None
    """Exclusive lower bound."""
    at_least: float | None = None
    """Inclusive lower bound."""
    at_most: float | None = None
    """Inclusive upper bound."""
    choices: Sequence[str] = ()
    """Allowed values; empty for any."""
    many: bool = False
    """Whether the value is a list."""
    rising: bool = False
    """Whether the values of the list must rise."""
    whole_periods: bool = False
    """Whether the value is a time in s that must be a multiple of 10 ms."""
    live: bool = False
    """Whether the value of a controller can be changed while it runs."""

    def __post_init__(self) -> None:
        """Set the kind to that of the default."""
        if self.default is not REQUIRED and self.default is not None and not self.many:
            object.__setattr__(self, 'kind', type(self.default))

    def with_default(self, default: Any) -> 'Option':
        """Return the option with another default, whose text is then that of the value."""
        otherwise = self.otherwise if default == self.default else ''
        return dataclasses.replace(self, default=default, otherwise=otherwise)

    def checked(self, name: str, value: Any) -> Any:
        """Return the checked `value` of the option `name`; raise ParameterError for a bad one."""
        if value is None:
            raise ParameterError(f'{name} is empty: give a value', key=name)
        if not self.many:
            return self._checked_one(name, value)
        if not isinstance(value, (list, tuple)):
            raise ParameterError(f'{name} is {value!r}: give a list, [...]', key=name)
        values = [self._checked_one(f'{name}[{i}]', item) for i, item in enumerate(value)]
        if self.rising:
            _require_rising(name, values)
        return tuple(values)

    def _checked_one(self, name: str, value: Any) -> Any:
        if self.kind in _GIVE and not isinstance(value, self.kind):
            raise ParameterError(f'{name} is {value!r}: give {_GIVE[self.kind]}', key=name)
        if self.choices:
            require_choice(name, value, self.choices)
        if self.kind in _GIVE:
            return value
        number = require_number(
            name,
            value,
            unit=self.unit,
            above=self.above,
            at_least=self.at_least,
            at_most=self.at_most,
        )
        if self.whole_periods:
            steps_in(name, number)
        if self.kind is float:
            return number
        if number % 1:
            raise ParameterError(f'{name} is {value!r}: give a whole number', key=name)
        return int(value)

    @cached_property
    def ends(self) -> tuple[float, float]:
        """
        Ends of a range in which every float is valid, both included; (inf, -inf) for none.

        The check of one such value is a comparison, while `checked` converts it and names it.
        """
        if self.kind is not float or self.many or self.choices or self.whole_periods:
            return math.inf, -math.inf
        low = -sys.float_info.max if self.at_least is None else self.at_least
        if self.above is not None:
            low = max(low, math.nextafter(self.above, math.inf))
        return low, sys.float_info.max if self.at_most is None else self.at_most

    @property
    def default_text(self) -> str:
        """Text of the default for pages and terminals."""
        if self.otherwise:
            return self.otherwise
        if self.default is REQUIRED:
            return 'required'
        if self.default is None or self.default == ():
            return 'none'
        return str(self.default).lower() if self.kind is bool else _text(self.default)

    @property
    def range_text(self) -> str:
        """Text of the range: `0 to 3`, `above 0`, the choices; empty for no limit."""
        if self.choices:
            return ', '.join(self.choices)
        if self.kind is bool:
            return 'true, false'
        if self.at_least is not None and self.at_most is not None:
            return f'{_text(self.at_least)} to {_text(self.at_most)}'
        ends = {'above': self.above, 'at least': self.at_least, 'at most': self.at_most}
        return ', '.join(f'{word} {_text(end)}' for word, end in ends.items() if end is not None)

    @property
    def description(self) -> str:
        """Text of meaning, unit and range in one line."""
        unit = f' [{self.unit}]' if self.unit else ''
        limits = f' ({self.range_text})' if self.range_text else ''
        live = '; may be changed while it runs' if self.live else ''
        return f'{self.meaning}{unit}{limits}{live}'


def option_rows(options: Options, prefix: str = '') -> list[tuple[str, ...]]:
    """Return a row of text per option: key, unit, default, range, meaning and source."""
    return [
        (
            f'{prefix}{name}',
            described.unit,
            described.default_text,
            described.range_text,
            described.meaning,
            described.source,
        )
        for name, described in options.items()
    ]


def _require_rising(name: str, values: Sequence[float]) -> None:
    for earlier, later in pairwise(values):
        if later <= earlier:
            raise ParameterError(
                f'{name} goes from {earlier:g} to {later:g}: it must rise', key=name
            )


def _text(value: Any) -> str:
    if isinstance(value, tuple):
        return f'[{", ".join(map(_text, value))}]'
    return f'{value:.6g}' if isinstance(value, float) else str(value)
