# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A profile over scenario time, linear between points: engine, brake, road, slip reference."""

from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ddct_plant.base.options import OptionGroup, option, options_of

TIME = 'time_s'
"""Name of the option with the times of a profile."""


@dataclass(frozen=True)
class Profile(OptionGroup):
    """
    Points over scenario time; a subclass adds the field of values. The ends hold outside.

    A subclass may have values in several quantities, of which an instance gives one.
    """

    time_s: tuple[float, ...] = option(
        (), 'scenario times of the points', 's', many=True, rising=True
    )

    def __post_init__(self) -> None:
        """Check the points; raise ParameterError that names the first bad one."""
        super().__post_init__()
        self.require_pairs(TIME, self.quantity)

    @property
    def quantity(self) -> str:
        """Name of the option with the values that are given, the first one if none are."""
        names = value_names(type(self))
        return next((name for name in names if getattr(self, name)), names[0])

    @property
    def given(self) -> bool:
        """Whether the profile has points."""
        return bool(self.time_s)

    def at(self, time_s: float) -> float:
        """Return the value at a scenario time in s; the profile must have points."""
        times, values = self.time_s, self._values
        if time_s <= times[0]:
            return values[0]
        if time_s >= times[-1]:
            return values[-1]
        after = bisect_right(times, time_s)
        return _between(time_s, times[after - 1], times[after], values[after - 1], values[after])

    def over(self, times_s: np.ndarray) -> np.ndarray:
        """Return the values (n,) of `at` at scenario times (n,) in s, to the last bit."""
        times, values = np.array(self.time_s), np.array(self._values)
        first, last = times_s <= times[0], times_s >= times[-1]
        found = np.where(first, values[0], values[-1])
        within = ~(first | last)
        inner = times_s[within]
        after = np.searchsorted(times, inner, 'right')
        before = after - 1
        found[within] = _between(inner, times[before], times[after], values[before], values[after])
        return found

    @cached_property
    def _values(self) -> tuple[float, ...]:
        # `at` needs them at every step, and for every step of a preview.
        values: tuple[float, ...] = getattr(self, self.quantity)
        return values


def _between(time: Any, start: Any, end: Any, first: Any, last: Any) -> Any:
    """Return the values at times between a start and an end, all numbers or all arrays."""
    return first + (time - start) / (end - start) * (last - first)


def value_names(group: type) -> tuple[str, ...]:
    """Return the names of the options with the values of a profile, of which one is given."""
    return tuple(name for name in options_of(group) if name != TIME)
