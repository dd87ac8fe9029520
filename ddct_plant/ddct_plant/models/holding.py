"""What holds the wheel by friction: rolling resistance and brake; and the load without them."""

import math
from dataclasses import dataclass, replace

import numpy as np

from ddct_plant.base.options import OptionGroup, option
from ddct_plant.models.load import LoadParameters, RoadLoad
from ddct_plant.models.parameters import VehicleParameters


@dataclass(frozen=True)
class BrakeProfile(OptionGroup, prefix='brake.'):
    """The brake over scenario time, linear between its points; the ends hold outside."""

    time_s: tuple[float, ...] = option(
        (),
        'scenario times of the points; none: the brake is never applied',
        's',
        many=True,
        rising=True,
    )
    torque_n_m: tuple[float, ...] = option(
        (),
        'torque that the brakes can hold then, at the wheels, linear between the points',
        'N m',
        many=True,
        at_least=0.0,
        at_most=1e5,
    )

    def __post_init__(self) -> None:
        """Check the points; raise ParameterError that names the first bad one."""
        super().__post_init__()
        self.require_pairs('time_s', 'torque_n_m')

    def torque(self, time_s: float) -> float:
        """Return the capacity in N m at a scenario time; the ends hold before and after."""
        return float(np.interp(time_s, self.time_s, self.torque_n_m)) if self.time_s else 0.0


class HoldingTorque:
    """
    Capacity of the friction at the wheel: m g mu_r cos(alpha) r_w of rolling, and the brake.

    It resists whichever way the wheel turns or would turn, so a car at rest stays at rest.
    """

    def __init__(
        self, load: LoadParameters, vehicle: VehicleParameters, brake: BrakeProfile
    ) -> None:
        normal_force = vehicle.mass_kg * vehicle.gravity_m_s2 * math.cos(load.slope_rad)
        self._rolling = normal_force * load.rolling_coefficient * vehicle.wheel_radius_m
        self._brake = brake

    def capacity(self, time_s: float) -> float:
        """Return it in N m, not negative, at a scenario time."""
        return self._rolling + self._brake.torque(time_s)


def air_and_slope(load: LoadParameters, vehicle: VehicleParameters) -> RoadLoad:
    """Return the road load that is left when rolling resistance is friction at the wheel."""
    return RoadLoad(replace(load, rolling_coefficient=0.0), vehicle)
