"""Vehicle: what turns wheel speed and torque into road speed, acceleration and load."""

import math
from dataclasses import dataclass

from ddct_plant.base.checks import require_number
from ddct_plant.models.parameters import DrivelineParameters

_MASS_KG = 1500.0
_WHEEL_RADIUS_M = math.sqrt(DrivelineParameters().vehicle_inertia / _MASS_KG)


@dataclass(frozen=True)
class VehicleParameters:
    """
    Mass, wheel radius and gravity.

    The thesis prints none of them. With J_v = m r_w^2 (no inertia of the wheels themselves) the
    identified J_v fixes only the product: 1500 kg is our choice, the radius follows from it.
    """

    mass_kg: float = _MASS_KG
    """m_v."""
    wheel_radius_m: float = _WHEEL_RADIUS_M
    """r_w, rolling radius: sqrt(J_v / m_v) of the default driveline and mass."""
    gravity_m_s2: float = 9.81
    """g."""

    def __post_init__(self) -> None:
        """Check every value; raise ParameterError that names a bad one."""
        require_number('vehicle.mass_kg', self.mass_kg, above=0.0)
        require_number('vehicle.wheel_radius_m', self.wheel_radius_m, above=0.0)
        require_number('vehicle.gravity_m_s2', self.gravity_m_s2, above=0.0)
