# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Thermal model of the clutch: three lumped masses that the friction work of a period warms."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import Any, Self

import numpy as np

from ddct_plant.base.options import ASSUMED, OptionGroup, option
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import StateSpace
from ddct_plant.linear.sampling import discretise_zoh

_capacity = partial(option, unit='J/K', source=ASSUMED, at_least=1.0, at_most=1e7)
_conductance = partial(option, unit='W/K', source=ASSUMED, at_least=0.0, at_most=1e6)
_temperature = partial(option, 20.0, unit='°C', source=ASSUMED, at_least=-60.0, at_most=1500.0)


@dataclass(frozen=True)
class HeatParameters(OptionGroup, prefix='heat.'):
    """
    Heat capacities, conductances and initial temperatures of the clutch.

    No value for the C635 is public. Plate and facing together are chosen so that a hard launch
    of 40 kJ warms them by 30 to 40 K, as published simulations have it.
    The share of the facings is e_f / (e_f + e_p) of the thermal effusivities
    sqrt(conductivity x density x specific heat): 716 of a new lining (0.652 W/(m K) and
    8.3e-7 m^2/s, Appl. Sci. 2019, 9, 4287, table A2), 13400 J/(m^2 K s^0.5) of cast iron
    (50 W/(m K), 7200 kg/m^3, 500 J/(kg K), assumed).
    """

    plate_j_k: float = _capacity(1000.0, 'heat capacity of pressure plate and counterpart')
    facing_j_k: float = _capacity(
        163.0,
        'heat capacity of the facings: 542 J/(kg K) times 0.3 kg',
        source='Appl. Sci. 2019, 9, 4287, table A2; 0.3 kg assumed',
    )
    housing_j_k: float = _capacity(10000.0, 'heat capacity of the bell housing')
    facing_share: float = option(
        0.05,
        'share of the friction work that enters the facings, the rest the plate',
        source='thermal effusivities: table A2 as above, cast iron assumed',
        at_least=0.0,
        at_most=1.0,
    )
    facing_to_plate_w_k: float = _conductance(200.0, 'conductance between facings and plate')
    plate_to_housing_w_k: float = _conductance(
        8.0, 'conductance between plate and housing, by air and shaft'
    )
    housing_to_ambient_w_k: float = _conductance(20.0, 'conductance between housing and ambient')
    ambient_c: float = _temperature('temperature around the housing')
    plate_c: float = _temperature('plate at t = 0')
    facing_c: float = _temperature('facings at t = 0')
    housing_c: float = _temperature('housing at t = 0')


class ClutchHeat:
    """
    Temperatures of plate, facing and housing, exact from period to period.

    C_p T_p' = (1 - s) q - G_fp (T_p - T_f) - G_ph (T_p - T_h),
    C_f T_f' = s q + G_fp (T_p - T_f),
    C_h T_h' = G_ph (T_p - T_h) - G_ha (T_h - T_a),
    with the friction power q held over the period at its mean.
    """

    def __init__(self, parameters: HeatParameters) -> None:
        """Start at the initial temperatures of the parameters."""
        self._update: Sequence[Any] = _update_of(parameters)
        self._ambient_c: Any = parameters.ambient_c
        self._above_ambient: list[Any] = _above_ambient(parameters)

    @classmethod
    def of_many(cls, parameters: Sequence[HeatParameters]) -> Self:
        """Return the temperatures of R clutches, whose values are arrays, (R,)."""
        heat = cls(parameters[0])
        heat._update = list(np.transpose([_update_of(each) for each in parameters]))
        heat._ambient_c = np.array([each.ambient_c for each in parameters])
        heat._above_ambient = list(np.transpose([_above_ambient(each) for each in parameters]))
        return heat

    @property
    def facing_c(self) -> float:
        """Temperature of the facing in degrees Celsius, on which the friction depends."""
        return self._ambient_c + self._above_ambient[1]

    def advance(self, friction_work: float) -> None:
        """Advance the temperatures by 10 ms with the heat `friction_work` in J of the period."""
        p, f, h = self._above_ambient
        pp, pf, ph, pw, fp, ff, fh, fw, hp, hf, hh, hw = self._update
        self._above_ambient = [
            pp * p + pf * f + ph * h + pw * friction_work,
            fp * p + ff * f + fh * h + fw * friction_work,
            hp * p + hf * f + hh * h + hw * friction_work,
        ]


def _above_ambient(parameters: HeatParameters) -> list[float]:
    p = parameters
    return [t - p.ambient_c for t in (p.plate_c, p.facing_c, p.housing_c)]


@lru_cache
def _update_of(parameters: HeatParameters) -> tuple[float, ...]:
    """Return the rows of the map from temperatures and friction work to those 10 ms later."""
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
    # Plain numbers: for so small a product numpy takes longer.
    return tuple(np.hstack([sampled.a, sampled.b / PERIOD_S]).ravel().tolist())
