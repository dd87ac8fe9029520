"""A value over scenario time, linear between points: of the brake, the road, a slip reference."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ddct_plant.base.options import OptionGroup, option, options_of

TIME = 'time_s'


@dataclass(frozen=True)
class Profile(OptionGroup):
    """Scenario times, and in the field that a subclass adds the values; the ends hold outside."""

    time_s: tuple[float, ...] = option(
        (), 'scenario times of the points', 's', many=True, rising=True
    )

    def __post_init__(self) -> None:
        """Check the points; raise ParameterError that names the first bad one."""
        super().__post_init__()
        self.require_pairs(TIME, value_name(type(self)))

    @property
    def given(self) -> bool:
        """Whether it has points."""
        return bool(self.time_s)

    def at(self, time_s: float) -> float:
        """Return the value at a scenario time; there must be points."""
        return float(np.interp(time_s, self.time_s, self._values))

    def over(self, times_s: np.ndarray) -> np.ndarray:
        """Return the values at scenario times, (n,)."""
        return np.interp(times_s, self.time_s, self._values)

    @cached_property
    def _values(self) -> Any:
        # `at` wants them at every step, and for every step of a preview.
        return getattr(self, value_name(type(self)))


def value_name(group: type) -> str:
    """Return the name of the option of a profile that is not its times."""
    (name,) = (name for name in options_of(group) if name != TIME)
    return name
