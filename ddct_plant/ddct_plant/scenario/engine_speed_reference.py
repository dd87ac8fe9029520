"""Engine speed that controllers with two inputs shall follow, as the scenario gives it."""

from dataclasses import dataclass

import numpy as np

from ddct_plant.base.checks import require_number, require_rising
from ddct_plant.base.errors import ParameterError


@dataclass(frozen=True)
class EngineSpeedReference:
    """
    Engine speed over scenario time, linear between its points and constant outside them.

    Without points the controllers follow what the driver's demand and the slip reference imply.
    """

    time_s: tuple[float, ...] = ()
    """Scenario times in s, strictly increasing."""
    speed_rad_s: tuple[float, ...] = ()
    """w_m in rad/s at those times, not negative."""

    def __post_init__(self) -> None:
        """Check the points; raise ParameterError that names the first bad one."""
        name = 'engine_speed_reference'
        if len(self.time_s) != len(self.speed_rad_s):
            raise ParameterError(
                f'{name} has {len(self.time_s)} times and {len(self.speed_rad_s)} speeds: '
                'give one speed for each time'
            )
        for index, time in enumerate(self.time_s):
            require_number(f'{name}.time_s[{index}]', time)
        require_rising(f'{name}.time_s', self.time_s)
        for index, speed in enumerate(self.speed_rad_s):
            require_number(f'{name}.speed_rad_s[{index}]', speed, at_least=0.0, at_most=1000.0)

    @property
    def given(self) -> bool:
        """Whether it has points."""
        return bool(self.time_s)

    def speed(self, time_s: float) -> float:
        """Return w_m in rad/s at a scenario time; there must be points."""
        return float(np.interp(time_s, self.time_s, self.speed_rad_s))
