"""Heat of the clutch: three lumped masses that the friction work of each period warms."""

from dataclasses import dataclass, fields

import numpy as np

from ddct_plant.base.checks import require_number
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import StateSpace, discretise_zoh


@dataclass(frozen=True)
class HeatParameters:
    """
    Masses, paths and start temperatures of the clutch, section `heat` of a scenario.

    No figure for the C635 is public. Plate and facing together are chosen so that a hard launch
    of 40 kJ warms them by 30 to 40 K, as published simulations have it.
    """

    plate_j_k: float = 1000.0
    """Heat capacity of the pressure plate and its counterpart in J/K; assumed."""
    facing_j_k: float = 163.0
    """
    Heat capacity of the facings in J/K: 542 J/(kg K) times 0.3 kg.

    The specific heat is that of a new lining (Appl. Sci. 2019, 9, 4287, table A2), the mass
    assumed.
    """
    housing_j_k: float = 10000.0
    """Heat capacity of the bell housing in J/K; assumed."""
    facing_share: float = 0.05
    """
    Share of the friction work that enters the facings, the rest the plate.

    e_f / (e_f + e_p) of the thermal effusivities sqrt(conductivity x density x specific heat):
    716 of a new lining (0.652 W/(m K) and 8.3e-7 m^2/s, table A2 as above), 13400 J/(m^2 K s^0.5)
    of cast iron (50 W/(m K), 7200 kg/m^3, 500 J/(kg K), assumed).
    """
    facing_to_plate_w_k: float = 200.0
    """Conductance between facings and plate in W/K; assumed."""
    plate_to_housing_w_k: float = 8.0
    """Conductance between plate and housing in W/K, air and shaft; assumed."""
    housing_to_ambient_w_k: float = 20.0
    """Conductance between housing and ambient in W/K; assumed."""
    ambient_c: float = 20.0
    """Temperature around the housing in degrees Celsius; assumed."""
    plate_c: float = 20.0
    """Plate at t = 0 in degrees Celsius; assumed."""
    facing_c: float = 20.0
    """Facings at t = 0 in degrees Celsius; assumed."""
    housing_c: float = 20.0
    """Housing at t = 0 in degrees Celsius; assumed."""

    def __post_init__(self) -> None:
        """Check every value; raise ParameterError that names a bad one."""
        for field in fields(self):
            name, value = f'heat.{field.name}', getattr(self, field.name)
            if field.name.endswith('_j_k'):
                require_number(name, value, above=0.0, at_most=1e7)
            elif field.name.endswith('_w_k'):
                require_number(name, value, at_least=0.0, at_most=1e6)
            elif field.name.endswith('_c'):
                require_number(name, value, at_least=-60.0, at_most=1500.0)
        require_number('heat.facing_share', self.facing_share, at_least=0.0, at_most=1.0)


class ClutchHeat:
    """
    Temperatures of plate, facing and housing, exact from period to period.

    C_p T_p' = (1 - s) q - G_fp (T_p - T_f) - G_ph (T_p - T_h),
    C_f T_f' = s q + G_fp (T_p - T_f),
    C_h T_h' = G_ph (T_p - T_h) - G_ha (T_h - T_a),
    with the friction power q held over the period at its mean.
    """

    def __init__(self, parameters: HeatParameters) -> None:
        """Start at the temperatures of the parameters."""
        p = parameters
        plate, facing, housing = p.plate_j_k, p.facing_j_k, p.housing_j_k
        to_plate, to_housing = p.facing_to_plate_w_k, p.plate_to_housing_w_k
        a = np.array(
            [
                [-(to_plate + to_housing) / plate, to_plate / plate, to_housing / plate],
                [to_plate / facing, -to_plate / facing, 0.0],
                [to_housing / housing, 0.0, -(to_housing + p.housing_to_ambient_w_k) / housing],
            ]
        )
        b = np.array([[(1.0 - p.facing_share) / plate], [p.facing_share / facing], [0.0]])
        sampled = discretise_zoh(StateSpace(a, b, np.eye(3), np.zeros((3, 1))), PERIOD_S)
        self._transition, self._of_work = sampled.a, sampled.b[:, 0] / PERIOD_S
        self._ambient_c = p.ambient_c
        self._above_ambient = np.array([p.plate_c, p.facing_c, p.housing_c]) - p.ambient_c

    @property
    def temperatures_c(self) -> tuple[float, float, float]:
        """Plate, facing and housing in degrees Celsius."""
        plate, facing, housing = (self._ambient_c + self._above_ambient).tolist()
        return plate, facing, housing

    @property
    def facing_c(self) -> float:
        """The facing's temperature in degrees Celsius, that friction depends on."""
        return self._ambient_c + float(self._above_ambient[1])

    def advance(self, friction_work: float) -> None:
        """Pass the period of 10 ms in which the plates turned `friction_work` in J to heat."""
        self._above_ambient = (
            self._transition @ self._above_ambient + self._of_work * friction_work
        )
