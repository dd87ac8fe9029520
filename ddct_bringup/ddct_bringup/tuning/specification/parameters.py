# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tuned parameters: options of a controller that are numbers, each with a range."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ddct_bringup.campaign.specification.parts import mapping_of
from ddct_controllers.interface import Controller, ControllerSpec
from ddct_plant.base.errors import ParameterError, require_choice, require_number
from ddct_plant.base.options import Option, require_known
from ddct_plant.base.timebase import PERIOD_S

PARAMETERS = 'parameters'
LINEAR, LOG = 'linear', 'log'
_LOW, _HIGH, _SCALE = 'low', 'high', 'scale'
_DIGITS = 6
"""Number of significant digits of a value that is tried, so that files have short numbers."""
Values = Mapping[str, float]
"""Values of parameters by name; whole ones are int."""


@dataclass(frozen=True)
class Parameter:
    """One option of the controller with the range in which it is searched."""

    name: str
    low: float
    high: float
    scale: str
    """LINEAR or LOG: whether differences or ratios count."""
    option: Option

    @property
    def whole(self) -> bool:
        """Whether its values are whole numbers."""
        return self.option.kind is int

    def rounded(self, value: float) -> float:
        """Return a value of the search as it is tried, within the range."""
        if self.whole:
            return int(value)
        if self.option.whole_periods:
            return round(round(value / PERIOD_S) * PERIOD_S, _DIGITS)
        return min(max(float(f'{value:.{_DIGITS}g}'), self.low), self.high)

    def contains(self, value: object) -> bool:
        """Return whether a value is a number in the range."""
        return isinstance(value, (int, float)) and self.low <= value <= self.high


def parameters_of(content: Any, controller: ControllerSpec[Controller]) -> tuple[Parameter, ...]:
    """
    Return the parameters in a specification.

    Raise ParameterError for an option that the controller does not have or that is no number, and
    for an empty range.
    """
    options = controller.options or {}
    if not options:
        raise ParameterError(
            f'{PARAMETERS}: {controller.name} declares no options: declare them as '
            'docs/use/tune.md describes for its kind',
            key=PARAMETERS,
        )
    if not isinstance(content, Mapping) or not content:
        raise ParameterError(
            f'{PARAMETERS} is {content!r}: give options of {controller.name} with their ranges, '
            f'among {", ".join(options)}',
            key=PARAMETERS,
        )
    require_known(content, options, 'parameter', f'{PARAMETERS}.')
    return tuple(_parameter(name, each, options[name]) for name, each in content.items())


def _parameter(name: str, content: Any, option: Option) -> Parameter:
    where = f'{PARAMETERS}.{name}'
    given = mapping_of(where, content, (_LOW, _HIGH, _SCALE), f'{where}.')
    if option.many or option.choices or option.kind not in (float, int):
        raise ParameterError(f'{where}: it is no number, and cannot be searched', key=where)
    ends = []
    for end in (_LOW, _HIGH):
        key = f'{where}.{end}'
        if end not in given:
            raise ParameterError(f'{key} is missing: give the range to search', key=key)
        require_number(key, given[end], unit=option.unit)
        ends.append(option.checked(key, given[end]))
    low, high = ends
    if not low < high:
        raise ParameterError(
            f'{where}: the range from {low:g} to {high:g} is empty: {_LOW} must be below {_HIGH}',
            key=where,
        )
    scale = given.get(_SCALE, LINEAR)
    require_choice(f'{where}.{_SCALE}', scale, (LINEAR, LOG))
    if scale == LOG and low <= 0.0:
        raise ParameterError(
            f'{where}.{_LOW} is {low:g}: a logarithmic range begins above 0', key=f'{where}.{_LOW}'
        )
    return Parameter(name, low, high, scale, option)
