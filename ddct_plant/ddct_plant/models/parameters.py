# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Parameters of the driveline, with identified values, and of the vehicle."""

import math
from dataclasses import dataclass
from functools import partial

from ddct_plant.base.options import ASSUMED, OptionGroup, option

_positive = partial(option, source='`identify`', above=0.0)
_damping = partial(option, unit='N m s/rad', source='`identify`', at_least=0.0)


@dataclass(frozen=True)
class DrivelineParameters(OptionGroup, prefix='driveline.'):
    """
    Parameters of the 4-state driveline of Section 1.5; `identify` derives the defaults.

    They have 8 significant digits, more than their uncertainty of 3e-5 to 1e-3: together
    they reproduce the printed coefficients, and 8 digits move those by less than a hundredth of
    the rounding of the print.
    """

    engine_inertia: float = _positive(0.24997592, 'J_m', 'kg m²')
    engine_damping: float = _damping(0.0, 'c_m; 0 because P1 = 4/s is a pure integrator')
    shaft_inertia: float = _positive(0.010057366, 'J_p, primary shaft', 'kg m²')
    shaft_damping: float = _damping(0.012002953, 'c_prim, primary shaft')
    halfshaft_damping: float = _damping(104.95672, 'c_sa, at the wheel side of the gears')
    halfshaft_stiffness: float = _positive(
        6716.3112, 'k_sa, at the wheel side of the gears', 'N m/rad'
    )
    total_ratio: float = _positive(
        9.3416024, 'tau: second gear times final drive, not the gear number 2 of Section 1.4.5'
    )
    vehicle_inertia: float = _positive(
        154.69105, 'J_v, inertia of the vehicle at the wheels', 'kg m²'
    )


_MASS_KG = 1500.0
_WHEEL_RADIUS_M = math.sqrt(DrivelineParameters().vehicle_inertia / _MASS_KG)


@dataclass(frozen=True)
class VehicleParameters(OptionGroup, prefix='vehicle.'):
    """
    Mass, wheel radius and gravity.

    The thesis prints none of them. With J_v = m r_w^2 (no inertia of the wheels themselves) the
    identified J_v fixes only the product: 1500 kg is our choice, the radius follows from it.
    """

    mass_kg: float = option(_MASS_KG, 'm_v', 'kg', source=ASSUMED, above=0.0)
    wheel_radius_m: float = option(
        _WHEEL_RADIUS_M,
        'r_w, rolling radius: sqrt(J_v / m_v) of the default driveline and mass',
        'm',
        source='from J_v and m_v',
        above=0.0,
    )
    gravity_m_s2: float = option(9.81, 'g', 'm/s²', source='standard gravity', above=0.0)
