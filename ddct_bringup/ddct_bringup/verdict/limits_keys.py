# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Checks of the keys, units and texts of a limits file, and the value of a rule."""

from collections.abc import Mapping, Sequence
from typing import Any

from ddct_plant.base.errors import ParameterError, require_number
from ddct_plant.base.options import require_known

MOST = 1e9
"""Largest value of a rule or limit, in its unit."""


def rule_value(path: str, content: Any, unit: str) -> float:
    """Return the value of the rule at `path`, which has `value`, `unit` and `reason`."""
    rule = require_keys(path, content, ('value', 'unit', 'reason'))
    require_text(f'{path}.reason', rule['reason'])
    require_unit(f'{path}.unit', rule['unit'], unit)
    return require_number(f'{path}.value: it', rule['value'], above=0.0, at_most=MOST)


def require_keys(
    path: str, content: Any, required: Sequence[str], optional: Sequence[str] = ()
) -> Mapping[str, Any]:
    """
    Return the mapping at `path`, '' for the whole file.

    Raise ParameterError where it is none, lacks a required key, or has one that is neither.
    """
    where = path or 'line 1'
    if not isinstance(content, dict):
        raise ParameterError(f'{where}: give keys and values')
    require_known(content, (*required, *optional), prefix=f'{path}.' if path else '')
    for key in required:
        if key not in content:
            raise ParameterError(f'{where}: the key {key} is missing', key=key)
    return content


def require_unit(path: str, value: Any, unit: str) -> None:
    """Raise ParameterError where the unit at `path` is not `unit`."""
    if value != unit:
        raise ParameterError(f'{path}: it is {value!r}: give the value in {unit!r}')


def require_text(path: str, value: Any) -> None:
    """Raise ParameterError where the value at `path` is no text, or empty."""
    if not isinstance(value, str) or not value.strip():
        raise ParameterError(f'{path}: it is {value!r}: give text')
