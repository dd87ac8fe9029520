# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Parameters of the driveline, with identified values, and of the vehicle."""

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import Self

from ddct_plant.base.options import ASSUMED, Option, OptionGroup, option, option_field
from ddct_plant.models.gearbox import IDENTIFIED_RATIO, EngagedGear

_positive = partial(option, source='`identify`', above=0.0)
_damping = partial(option, unit='N m s/rad', source='`identify`', at_least=0.0)
IDENTIFIED_VEHICLE_INERTIA = 154.69105
"""Inertia of the vehicle at the wheels J_v in kg m^2, from `identify`."""
_VEHICLE_INERTIA = Option(
    IDENTIFIED_VEHICLE_INERTIA,
    'J_v, inertia of the vehicle at the wheels',
    'kg m²',
    source='`identify`',
    above=0.0,
)
SYMBOLS_AND_UNITS = {
    'engine_inertia': ('J_m', 'kg m^2'),
    'engine_damping': ('c_m', 'N m s/rad'),
    'shaft_inertia': ('J_p', 'kg m^2'),
    'shaft_damping': ('c_prim', 'N m s/rad'),
    'halfshaft_damping': ('c_sa', 'N m s/rad'),
    'halfshaft_stiffness': ('k_sa', 'N m/rad'),
    'total_ratio': ('tau', '1'),
    'vehicle_inertia': ('J_v', 'kg m^2'),
}
"""Symbol and unit of every number of `DrivelineParameters.values`, for tables."""


@dataclass(frozen=True)
class DrivelineShafts(OptionGroup, prefix='driveline.'):
    """
    Inertias, damping and stiffness that depend neither on the gear nor on the vehicle.

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


@dataclass(frozen=True)
class DrivelineParameters(DrivelineShafts, prefix='driveline.'):
    """Parameters of the 4-state driveline of Section 1.5 in one gear; `identify` derives them."""

    gear: EngagedGear = EngagedGear()
    vehicle_inertia: float = option_field(_VEHICLE_INERTIA)

    @property
    def vehicle_side_inertia(self) -> float:
        """Inertia J_eq = J_p + J_v/tau^2 in kg m^2 of the rigid car at the primary shaft."""
        return self.shaft_inertia + self.gear.at_shaft(self.vehicle_inertia)

    def in_gear(self, gear: EngagedGear) -> 'DrivelineParameters':
        """Return the driveline with another gear engaged."""
        return dataclasses.replace(self, gear=gear)

    def values(self) -> dict[str, float]:
        """Return the eight numbers by the names of their keys in a scenario, in SI units."""
        shafts = {field.name: getattr(self, field.name) for field in _SHAFT_FIELDS}
        return {
            **shafts,
            'total_ratio': self.gear.total_ratio,
            'vehicle_inertia': self.vehicle_inertia,
        }

    def with_values(self, **values: float) -> Self:
        """Return the driveline with other numbers, by the names of their keys in a scenario."""
        return self.from_values({**self.values(), **values})

    @classmethod
    def from_values(cls, values: Mapping[str, float]) -> Self:
        """Return the driveline of numbers by key; raise ParameterError that names a bad one."""
        others = dict(values)
        gear = EngagedGear(others.pop('total_ratio', IDENTIFIED_RATIO))
        return cls(gear=gear, **others)


_SHAFT_FIELDS = dataclasses.fields(DrivelineShafts)


@dataclass(frozen=True)
class DrivelineSection(DrivelineShafts, prefix='driveline.'):
    """Section `driveline` of a scenario: J_v may be left out, and follows from mass and radius."""

    vehicle_inertia: float | None = option_field(
        dataclasses.replace(_VEHICLE_INERTIA, default=None, otherwise='m_v r_w²')
    )

    @classmethod
    def of(cls, parameters: DrivelineParameters) -> Self:
        """Return the section that gives every value of a driveline but that of its gear."""
        values = parameters.values()
        return cls(**{field.name: values[field.name] for field in dataclasses.fields(cls)})

    def engaged(self, gear: EngagedGear, vehicle_inertia: float) -> DrivelineParameters:
        """Return the driveline in a gear; J_v in kg m^2 holds where the section gives none."""
        given = {name: value for name, value in vars(self).items() if value is not None}
        return DrivelineParameters(gear=gear, **{'vehicle_inertia': vehicle_inertia} | given)


_MASS_KG = 1500.0
_WHEEL_RADIUS_M = math.sqrt(IDENTIFIED_VEHICLE_INERTIA / _MASS_KG)


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
    driven_share: float = option(
        0.6,
        'share of the weight on the driven front axle at rest, for the limit of the traction',
        source=ASSUMED,
        above=0.0,
        at_most=1.0,
        left_out=True,
    )
    height_over_wheelbase: float = option(
        0.2,
        'height of the centre of gravity over the wheelbase, for that limit',
        source=ASSUMED,
        at_least=0.0,
        at_most=1.0,
        left_out=True,
    )
    gravity_m_s2: float = option(9.81, 'g', 'm/s²', source='standard gravity', above=0.0)

    @property
    def inertia(self) -> float:
        """Inertia of the vehicle at the wheels J_v = m_v r_w^2 in kg m^2."""
        return self.mass_kg * (self.wheel_radius_m * self.wheel_radius_m)
