# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Groups of options: frozen dataclasses whose fields are options, and that check themselves.

An `Option` describes one value. A dataclass has it in its fields (`option`), a controller declares
a mapping of options.
"""

import dataclasses
import typing
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType
from typing import Any, ClassVar, TypeVar

from ddct_plant.base.errors import ParameterError, did_you_mean
from ddct_plant.base.option import REQUIRED, Option, Options

ASSUMED = 'assumed'
"""Source of a value that is assumed, because no published value exists."""


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
            name: described.with_default(getattr(self, name))
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
    return did_you_mean(name, known, prefix) or f'known: {", ".join(known)}'
