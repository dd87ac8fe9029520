# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Distribution of one key, as a specification gives it."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from ddct_bringup.campaign.specification.distributions import (
    CHOICE,
    HIGH,
    KIND,
    KINDS,
    LOW,
    STEP,
    VALUES,
    Distribution,
    Kind,
    Numbers,
)
from ddct_plant.base.errors import ParameterError, require_choice, require_number
from ddct_plant.base.options import Option, close_name
from ddct_plant.base.timebase import PERIOD_S

_NAMES = (*KINDS, CHOICE)


def distribution_of(where: str, content: Any, option: Option | None) -> Distribution:
    """
    Return the distribution that a specification gives at the key `where`.

    `option` describes the values of the varied key, None where they are not known. Raise
    ParameterError for an unknown name or parameter, and where the distribution exceeds a bound of
    the key.
    """
    if not isinstance(content, Mapping):
        raise ParameterError(
            f'{where} is {content!r}: give {{{KIND}: uniform, {LOW}: ..., {HIGH}: ...}}', key=where
        )
    kind = content.get(KIND)
    if not isinstance(kind, str):
        raise ParameterError(
            f'{where}.{KIND} is missing: choose from {", ".join(_NAMES)}', key=f'{where}.{KIND}'
        )
    require_choice(f'{where}.{KIND}', kind, _NAMES)
    if kind == CHOICE:
        return _choice(where, content, option)
    numbers = _numbers(where, content, KINDS[kind])
    _require_order(
        where, Distribution(kind, {name: numbers[name] for name in numbers if name != STEP})
    )
    distribution = Distribution(kind, numbers)
    _require_steps(where, numbers)
    if option:
        _require_within(where, distribution, option)
    return distribution


def _numbers(where: str, content: Mapping[str, Any], kind: Kind) -> dict[str, float]:
    known = (*kind.required, *kind.optional, STEP)
    _require_known(where, content, known)
    missing = [name for name in kind.required if name not in content]
    if missing:
        raise ParameterError(
            f'{where}.{missing[0]} is missing: {content[KIND]} needs it',
            key=f'{where}.{missing[0]}',
        )
    return {
        name: require_number(
            f'{where}.{name}',
            content[name],
            above=0.0 if name in (*kind.above_zero, STEP) else None,
        )
        for name in known
        if name in content
    }


def _require_known(where: str, content: Mapping[str, Any], known: Sequence[str]) -> None:
    for name in content:
        if name not in (KIND, *known):
            raise ParameterError(
                f'unknown key {where}.{name}: {close_name(name, known)}', key=f'{where}.{name}'
            )


def _require_order(where: str, distribution: Distribution) -> None:
    """Raise ParameterError for bounds without a value between them."""
    low, high = distribution.ends
    mode = distribution.numbers.get('mode', low)
    if not low < high or not low <= mode <= high:
        raise ParameterError(
            f'{where}: {LOW}, mode and {HIGH} must be in this order: mend them', key=where
        )
    value = distribution.value(0.5)
    if not (math.isfinite(value) and distribution.value(0.25) < distribution.value(0.75)):
        raise ParameterError(
            f'{where}: nothing of the distribution is between {low:g} and {high:g}: give others',
            key=where,
        )


def _require_steps(where: str, numbers: Numbers) -> None:
    """Raise ParameterError for a bound that rounding to the step would exceed."""
    for name in (LOW, HIGH):
        if STEP in numbers and name in numbers:
            parts = numbers[name] / numbers[STEP]
            if abs(parts - round(parts)) > 1e-6:
                raise ParameterError(
                    f'{where}.{name} is {numbers[name]:g}: give a multiple of the {STEP}, '
                    f'{numbers[STEP]:g}',
                    key=f'{where}.{name}',
                )


def _require_within(where: str, distribution: Distribution, option: Option) -> None:
    """Raise ParameterError for a distribution with values outside the range of the key."""
    key = where.rpartition('vary.')[2]
    if option.many or option.choices or option.kind not in (float, int):
        raise ParameterError(
            f'{where}: {key} takes no number: use {{{KIND}: {CHOICE}, values: [...]}}', key=where
        )
    if option.kind is int and not distribution.whole:
        raise ParameterError(
            f'{where}.{STEP}: {key} takes whole numbers: give {STEP}: 1', key=f'{where}.{STEP}'
        )
    if option.whole_periods:
        parts = distribution.numbers.get(STEP, 0.0) / PERIOD_S
        if not parts or abs(parts - round(parts)) > 1e-6:
            raise ParameterError(
                f'{where}.{STEP}: {key} takes multiples of 10 ms: give {STEP}: {PERIOD_S}',
                key=f'{where}.{STEP}',
            )
    low, high = distribution.ends
    bounds = (
        (LOW, low, option.at_least if option.above is None else option.above),
        (HIGH, high, option.at_most),
    )
    for name, end, bound in bounds:
        if math.isfinite(end):
            if end != bound or name in distribution.numbers:
                option.checked(f'{where}.{name}', end)
        elif bound is not None:
            raise ParameterError(
                f'{where}.{name} is missing: {key} must be {option.range_text}, and '
                f'{distribution.kind} has no bound there',
                key=f'{where}.{name}',
            )


def _choice(where: str, content: Mapping[str, Any], option: Option | None) -> Distribution:
    _require_known(where, content, (VALUES, 'weights'))
    values = content.get(VALUES)
    if not isinstance(values, list) or not values:
        raise ParameterError(
            f'{where}.{VALUES}: give a list, [...], that is not empty', key=f'{where}.{VALUES}'
        )
    weights = content.get('weights', [1.0] * len(values))
    if not isinstance(weights, list) or len(weights) != len(values):
        raise ParameterError(
            f'{where}.weights: give a number for each of the values', key=f'{where}.weights'
        )
    parts = [require_number(f'{where}.weights', each, at_least=0.0) for each in weights]
    if not sum(parts):
        raise ParameterError(
            f'{where}.weights are all zero: give one above zero', key=f'{where}.weights'
        )
    if option:
        for value in values:
            option.checked(f'{where}.{VALUES}', value)
    return Distribution(CHOICE, {}, tuple(values), tuple(each / sum(parts) for each in parts))
