"""What holds the wheel by friction: rolling resistance and brake; and the load without them."""

import math
from dataclasses import dataclass, replace

from ddct_plant.base.options import option
from ddct_plant.base.profile import Profile
from ddct_plant.models.load import LoadParameters, RoadLoad, SlopeProfile
from ddct_plant.models.parameters import VehicleParameters


@dataclass(frozen=True)
class BrakeProfile(Profile, prefix='brake.'):
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

    def torque(self, time_s: float) -> float:
        """Return the capacity in N m at a scenario time; the ends hold before and after."""
        return self.at(time_s) if self.given else 0.0


class HoldingTorque:
    """
    Capacity of the friction at the wheel: m g mu_r cos(alpha) r_w of rolling, and the brake.

    It resists whichever way the wheel turns or would turn, so a car at rest stays at rest.
    """

    def __init__(
        self,
        load: LoadParameters,
        vehicle: VehicleParameters,
        brake: BrakeProfile,
        slope: SlopeProfile | None = None,
    ) -> None:
        """Take `slope` in place of the load's constant one where it has points."""
        self._load, self._vehicle, self._brake = load, vehicle, brake
        self._slope = slope if slope and slope.given else None
        self._constant_rolling = self._rolling(load.slope_rad)

    def capacity(self, time_s: float) -> float:
        """Return it in N m, not negative, at a scenario time."""
        rolling = self._constant_rolling
        if self._slope:
            rolling = self._rolling(self._slope.at(time_s))
        return rolling + self._brake.torque(time_s)

    def _rolling(self, slope_rad: float) -> float:
        vehicle = self._vehicle
        normal_force = vehicle.mass_kg * vehicle.gravity_m_s2 * math.cos(slope_rad)
        return normal_force * self._load.rolling_coefficient * vehicle.wheel_radius_m


def air_and_slope(
    load: LoadParameters, vehicle: VehicleParameters, slope: SlopeProfile | None = None
) -> RoadLoad:
    """Return the road load that is left when rolling resistance is friction at the wheel."""
    return RoadLoad(replace(load, rolling_coefficient=0.0), vehicle, slope)
