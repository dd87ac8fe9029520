# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Mass, wheel radius and inertia of a vehicle: two of them give the third."""

import math
from collections.abc import Mapping
from typing import NamedTuple, Self

from ddct_plant.base.errors import ParameterError
from ddct_plant.models.gearbox import AGREE

MASS, RADIUS, INERTIA = 'vehicle.mass_kg', 'vehicle.wheel_radius_m', 'driveline.vehicle_inertia'
"""Keys of the three in a scenario."""
BODY = (MASS, RADIUS, INERTIA)


class Body(NamedTuple):
    """The three values, with J_v = m_v r_w^2: the wheels themselves have no inertia."""

    mass_kg: float
    """m_v in kg."""
    wheel_radius_m: float
    """r_w in m."""
    inertia: float
    """J_v in kg m^2, at the wheels."""

    def require_agreement(self) -> None:
        """Raise ParameterError that names all three unless they agree to a thousandth."""
        mass, radius, inertia = self
        derived = mass * (radius * radius)
        if not math.isclose(inertia, derived, rel_tol=AGREE):
            raise ParameterError(
                f'{MASS} is {mass:g}, {RADIUS} is {radius:g} and {INERTIA} is {inertia:g}, but '
                f'm_v r_w^2 is {derived:g} kg m^2: give two of them',
                key=INERTIA,
            )

    def changed(self, given: Mapping[str, float]) -> Self:
        """
        Return the body with some values by key, all above 0.

        The mass alone keeps the radius and moves the inertia; radius or inertia alone keep the
        mass. Two values give the third. Three stay as they are, also where they disagree.
        """
        mass, radius = given.get(MASS, self.mass_kg), given.get(RADIUS, self.wheel_radius_m)
        if INERTIA not in given:
            inertia = mass * (radius * radius) if given else self.inertia
            return self._replace(mass_kg=mass, wheel_radius_m=radius, inertia=inertia)
        inertia = given[INERTIA]
        square = radius * radius
        if RADIUS not in given:
            radius = math.sqrt(inertia / mass)
        elif MASS not in given and 0.0 < square < math.inf:
            mass = inertia / square
        return self._replace(mass_kg=mass, wheel_radius_m=radius, inertia=inertia)
