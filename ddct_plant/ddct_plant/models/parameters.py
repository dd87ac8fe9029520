"""Parameters of driveline, with the values that the identification derives, and of vehicle."""

import math
from dataclasses import dataclass, fields

from ddct_plant.base.checks import require_fields

DEFAULT_DIGITS = 8
"""
Significant digits of the defaults below.

More than the 3e-5 to 1e-3 to which each is known: together they reproduce the printed
coefficients, and 8 digits move those by less than a hundredth of the rounding of the print.
"""


@dataclass(frozen=True)
class DrivelineParameters:
    """Parameters of the 4-state driveline of Section 1.5; `identify` derives the defaults."""

    engine_inertia: float = 0.24997592
    """J_m in kg m^2."""
    engine_damping: float = 0.0
    """c_m in N m s/rad; 0 because P1 = 4/s is a pure integrator."""
    shaft_inertia: float = 0.010057366
    """J_p in kg m^2, primary shaft."""
    shaft_damping: float = 0.012002953
    """c_prim in N m s/rad, primary shaft."""
    halfshaft_damping: float = 104.95672
    """c_sa in N m s/rad, at the wheel side of the gears."""
    halfshaft_stiffness: float = 6716.3112
    """k_sa in N m/rad, at the wheel side of the gears."""
    total_ratio: float = 9.3416024
    """tau: second gear times final drive, not the gear number 2 of Section 1.4.5."""
    vehicle_inertia: float = 154.69105
    """J_v in kg m^2, the vehicle seen at the wheels."""

    def __post_init__(self) -> None:
        """Check every value; raise ParameterError that names a bad one."""
        names = [field.name for field in fields(self)]
        dampings = [name for name in names if name.endswith('_damping')]
        require_fields(self, 'driveline', *dampings, at_least=0.0)
        require_fields(
            self, 'driveline', *(name for name in names if name not in dampings), above=0.0
        )


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
        require_fields(self, 'vehicle', *(field.name for field in fields(self)), above=0.0)
