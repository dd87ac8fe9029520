"""Engine speed that controllers and the slip reference follow, as the scenario gives it."""

from dataclasses import dataclass

import numpy as np

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import OptionGroup, option


@dataclass(frozen=True)
class EngineSpeedReference(OptionGroup, prefix='engine_speed_reference.'):
    """
    Engine speed over scenario time, linear between its points and constant outside them.

    Without points the controllers follow what the driver's demand and the slip reference imply.
    """

    time_s: tuple[float, ...] = option(
        (), 'scenario times of the points', 's', many=True, rising=True
    )
    speed_rad_s: tuple[float, ...] = option(
        (),
        'engine speed w_m that `decoupled_pid`, `torque_estimator` and the reference '
        '`engine_speed_target` follow, linear between its points; without points the two derive '
        'it from the demand and the slip reference',
        'rad/s',
        many=True,
        at_least=0.0,
        at_most=1000.0,
    )

    def __post_init__(self) -> None:
        """Check the points; raise ParameterError that names the first bad one."""
        super().__post_init__()
        if len(self.time_s) != len(self.speed_rad_s):
            raise ParameterError(
                f'engine_speed_reference has {len(self.time_s)} times and '
                f'{len(self.speed_rad_s)} speeds: give one speed for each time'
            )

    @property
    def given(self) -> bool:
        """Whether it has points."""
        return bool(self.time_s)

    def speed(self, time_s: float) -> float:
        """Return w_m in rad/s at a scenario time; there must be points."""
        return float(np.interp(time_s, self.time_s, self.speed_rad_s))
