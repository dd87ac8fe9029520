# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Options that a user can set, described once for files, programs, nodes, controllers and pages.

An `Option` describes one value. Frozen dataclasses carry it in their fields (`option`, in an
`OptionGroup`, which checks itself when it is built); a controller declares a mapping of them.
"""

import dataclasses
import difflib
import math
import sys
import typing
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from types import MappingProxyType
from typing import Any, ClassVar, TypeVar

from ddct_plant.base.errors import ParameterError, require_choice, require_number, require_rising
from ddct_plant.base.timebase import steps_in

REQUIRED: Any = dataclasses.MISSING
"""Default of a required option."""
ASSUMED = 'assumed'
"""Source of a value that is assumed, because no published value exists."""
Options = Mapping[str, 'Option']
"""Options by name."""
_GIVE = {bool: 'true or false', str: 'text'}
"""Accepted values of an option that is no number, by its kind, for errors."""
OPTION_HEADERS = ('key', 'unit', 'default', 'range', 'meaning', 'source')
"""Headers of the rows that `option_rows` returns."""


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
    """Source of the default: a section of the thesis, a program, or ASSUMED."""
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
            require_rising(name, values)
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


def option(
    default: Any, meaning: str, unit: str = '', *, left_out: bool = False, **description: Any
) -> Any:
    """Return the field of a dataclass with the `Option` of these arguments."""
    return option_field(Option(default, meaning, unit, **description), left_out=left_out)


def option_field(described: Option, *, left_out: bool = False) -> Any:
    """Return the field for an option; with `left_out` files and hashes omit its default."""
    metadata = {'option': described, 'left_out': left_out}
    return dataclasses.field(default=described.default, metadata=metadata)


def section(default: 'OptionGroup | None', *, key: str = '', **marks: bool) -> Any:
    """
    Return the field of a dataclass for a group of options, in files under `key` or its name.

    `marks` are metadata of the field; with `left_out` files and hashes omit the default.
    """
    return dataclasses.field(default=default, metadata={'key': key, **marks})


def key_of(field: 'dataclasses.Field[Any]') -> str:
    """Return the key of a field in files: that of its `section`, else its name."""
    return field.metadata.get('key') or field.name


@cache
def group_of(field: 'dataclasses.Field[Any]') -> type['OptionGroup'] | None:
    """Return the type of a field's group of options, also if it may be None; else None."""
    for kind in (field.type, *typing.get_args(field.type)):
        if isinstance(kind, type) and issubclass(kind, OptionGroup):
            return kind
    return None


def options_of(group: type) -> Options:
    """Return the options in the fields of a dataclass, in their order."""
    if group not in _OPTIONS:
        fields = [each for each in dataclasses.fields(group) if 'option' in each.metadata]
        _OPTIONS[group] = MappingProxyType({each.name: each.metadata['option'] for each in fields})
    return _OPTIONS[group]


_OPTIONS: dict[type, Options] = {}
"""Options of the dataclasses that were requested before."""
_ACCEPTED: dict[type, dict[str, object]] = {}
"""
Last text or list that was accepted for each option of a dataclass.

Runs of a campaign have the same objects, which need no second check.
"""


@dataclass(frozen=True)
class OptionGroup:
    """Base of frozen dataclasses whose fields are options, checked when an instance is made."""

    prefix: ClassVar[str] = ''
    """Prefix of the field names for users, such as `load.`."""

    def __init_subclass__(cls, prefix: str = '') -> None:
        """Set the prefix of the subclass, such as `load.`."""
        cls.prefix = prefix

    def __post_init__(self) -> None:
        """Check every option; raise ParameterError that names a bad one."""
        accepted = _ACCEPTED.setdefault(type(self), {})
        for name, described in options_of(type(self)).items():
            value = getattr(self, name)
            if value is accepted.get(name, REQUIRED):
                continue
            low, high = described.ends
            if type(value) is float and low <= value <= high:
                continue
            if value is not None or described.default is not None:
                described.checked(f'{self.prefix}{name}', value)
                if isinstance(value, (str, tuple)):
                    accepted[name] = value

    def require_pairs(self, xs_name: str, ys_name: str) -> None:
        """Raise ParameterError unless the lists called `xs_name` and `ys_name` have one length."""
        xs, ys = getattr(self, xs_name), getattr(self, ys_name)
        if len(xs) != len(ys):
            raise ParameterError(
                f'{self.prefix}{ys_name} has {len(ys)} values for the {len(xs)} of '
                f'{self.prefix}{xs_name}: give one for each',
                key=f'{self.prefix}{ys_name}',
            )

    @property
    def options(self) -> Options:
        """Options of the group by name, with the values of this instance as defaults."""
        return {
            name: dataclasses.replace(described, default=getattr(self, name))
            for name, described in options_of(type(self)).items()
        }


Group = TypeVar('Group', bound=OptionGroup)


def with_values(group: Group, values: Mapping[str, Any]) -> Group:
    """Return the group with the values whose names are options of it; ignore the others."""
    given = {name: values[name] for name in options_of(type(group)) if name in values}
    return dataclasses.replace(group, **given)


def require_known(
    names: Iterable[object], known: Iterable[str], what: str = 'key', prefix: str = ''
) -> None:
    """Raise ParameterError for the first unknown name, with a hint of a similar one."""
    known = list(known)
    for name in names:
        if name not in known:
            hint = close_name(name, known, prefix)
            raise ParameterError(f'unknown {what} {prefix}{name}: {hint}', key=f'{prefix}{name}')


def close_name(name: object, known: Iterable[str], prefix: str = '') -> str:
    """Return a hint for an unknown name: the closest known one, or else all known names."""
    known = list(known)
    close = difflib.get_close_matches(str(name), known, n=1)
    return f'did you mean {prefix}{close[0]}?' if close else f'known: {", ".join(known)}'


def option_rows(options: Options, prefix: str = '') -> list[tuple[str, ...]]:
    """Return a row of text per option, in the columns OPTION_HEADERS."""
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


def _text(value: Any) -> str:
    return f'{value:.6g}' if isinstance(value, float) else str(value)
