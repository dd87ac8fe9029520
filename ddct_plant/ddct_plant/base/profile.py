# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A profile over scenario time, linear between points: engine, brake, road, slip reference."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ddct_plant.base.options import OptionGroup, option, options_of

TIME = 'time_s'
"""Name of the option with the times of a profile."""


@dataclass(frozen=True)
class Profile(OptionGroup):
    """Points over scenario time; a subclass adds the field of values. The ends hold outside."""

    time_s: tuple[float, ...] = option(
        (), 'scenario times of the points', 's', many=True, rising=True
    )

    def __post_init__(self) -> None:
        """Check the points; raise ParameterError that names the first bad one."""
        super().__post_init__()
        self.require_pairs(TIME, value_name(type(self)))

    @property
    def given(self) -> bool:
        """Whether the profile has points."""
        return bool(self.time_s)

    def at(self, time_s: float) -> float:
        """Return the value at a scenario time in s; the profile must have points."""
        return float(np.interp(time_s, self.time_s, self._values))

    def over(self, times_s: np.ndarray) -> np.ndarray:
        """Return the values (n,) at scenario times (n,) in s; the profile must have points."""
        return np.interp(times_s, self.time_s, self._values)

    @cached_property
    def _values(self) -> Any:
        # `at` needs them at every step, and for every step of a preview.
        return getattr(self, value_name(type(self)))


def value_name(group: type) -> str:
    """Return the name of the option with the values of a profile."""
    (name,) = (name for name in options_of(group) if name != TIME)
    return name
