# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Road load as a wheel torque (Section 1.4.4), and friction of rolling and brake at the wheel."""

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ddct_plant.base.options import ASSUMED, OptionGroup, option
from ddct_plant.base.profile import Profile
from ddct_plant.models.parameters import VehicleParameters


@dataclass(frozen=True)
class LoadParameters(OptionGroup, prefix='load.'):
    """Parameters of the road load, apart from mass and wheels; the thesis prints no values."""

    air_density_kg_m3: float = option(1.2, 'rho_a', 'kg/m³', source=ASSUMED, at_least=0.0)
    frontal_area_m2: float = option(2.1, 'A_f', 'm²', source=ASSUMED, at_least=0.0)
    drag_coefficient: float = option(0.32, 'C_a', source=ASSUMED, at_least=0.0)
    rolling_coefficient: float = option(0.0125, 'mu_r', source=ASSUMED, at_least=0.0)
    wind_speed_m_s: float = option(
        0.0, 'v_a, positive as a head wind', 'm/s', source=ASSUMED, at_least=-60.0, at_most=60.0
    )
    slope_rad: float = option(
        0.0,
        'slope angle of the road, called alpha and beta in the thesis; positive uphill',
        'rad',
        source=ASSUMED,
        at_least=-0.6,
        at_most=0.6,
    )


@dataclass(frozen=True)
class SlopeProfile(Profile, prefix='slope.'):
    """The slope of the road over scenario time, linear between its points."""

    time_s: tuple[float, ...] = option(
        (),
        'scenario times of the points; none: the slope is `load.slope_rad` throughout',
        's',
        many=True,
        rising=True,
    )
    slope_rad: tuple[float, ...] = option(
        (),
        'slope angle then, in place of `load.slope_rad`; positive uphill',
        'rad',
        many=True,
        at_least=-0.6,
        at_most=0.6,
    )


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
        'holding torque of the brakes then, at the wheels, linear between the points',
        'N m',
        many=True,
        at_least=0.0,
        at_most=1e5,
    )


def resisting_torque(
    drag: Any, wind: Any, force: Any, wheel_radius: Any, vehicle_speed: Any
) -> Any:
    """Return C_load in N m of `RoadLoad`; `force` is F_r + F_g in N, and all may be arrays."""
    air_speed = wind + vehicle_speed
    return (drag * air_speed * abs(air_speed) + force) * wheel_radius


class RoadLoad:
    """
    Wheel torque that resists a vehicle at speed v_v (Section 1.4.4).

    F_a = 0.5 rho_a A_f C_a (v_a + v_v)^2, F_r = m g mu_r cos(alpha), F_g = m g sin(alpha) and
    C_load = (F_a + F_r + F_g) r_w. F_a keeps the sign of the relative wind, which the printed
    square loses for a tail wind faster than the vehicle.
    """

    def __init__(
        self,
        parameters: LoadParameters,
        vehicle: VehicleParameters,
        slope: SlopeProfile | None = None,
    ) -> None:
        """Use `slope` in place of the constant slope where it has points."""
        self._weight = vehicle.mass_kg * vehicle.gravity_m_s2
        self._rolling = parameters.rolling_coefficient
        self._slope = slope if slope and slope.given else None
        self.drag = (
            0.5
            * parameters.air_density_kg_m3
            * parameters.frontal_area_m2
            * parameters.drag_coefficient
        )
        """Drag factor 0.5 rho_a A_f C_a in kg/m."""
        self.wind = parameters.wind_speed_m_s
        """Head wind v_a in m/s."""
        self.wheel_radius = vehicle.wheel_radius_m
        """Wheel radius r_w in m."""
        self._constant_force = self._force(parameters.slope_rad)
        self._constant_rolling: float = self._rolling_torque(parameters.slope_rad)

    def torque(self, vehicle_speed: float, time_s: float = 0.0) -> float:
        """
        Return C_load in N m, positive when it resists.

        `vehicle_speed` is in m/s; the scenario time in s matters for a slope profile only.
        """
        force = self._force(self._slope.at(time_s)) if self._slope else self._constant_force
        return resisting_torque(self.drag, self.wind, force, self.wheel_radius, vehicle_speed)

    def rolling_torque(self, time_s: float) -> float:
        """Return the rolling resistance F_r r_w in N m at a scenario time in s."""
        if self._slope is None:
            return self._constant_rolling
        torque: float = self._rolling_torque(self._slope.at(time_s))
        return torque

    def forces(self, times_s: np.ndarray) -> np.ndarray:
        """Return F_r + F_g in N, (n,), at scenario times in s, (n,)."""
        if self._slope is None:
            return np.full(len(times_s), self._constant_force)
        return self._force(self._slope.over(times_s), np.cos, np.sin)

    def rolling_torques(self, times_s: np.ndarray) -> np.ndarray:
        """Return the rolling resistance F_r r_w in N m, (n,), at scenario times in s, (n,)."""
        if self._slope is None:
            return np.full(len(times_s), self._constant_rolling)
        torques: np.ndarray = self._rolling_torque(self._slope.over(times_s), np.cos)
        return torques

    def _rolling_torque(self, slope_rad: Any, cos: Any = math.cos) -> Any:
        return self._weight * cos(slope_rad) * self._rolling * self.wheel_radius

    def _force(self, slope_rad: Any, cos: Any = math.cos, sin: Any = math.sin) -> Any:
        return self._weight * (self._rolling * cos(slope_rad) + sin(slope_rad))


class HoldingTorque:
    """
    Capacity of the friction at the wheel: m g mu_r cos(alpha) r_w of rolling, and the brake.

    It resists motion in both directions, so that a car at rest stays at rest.
    """

    def __init__(self, load: RoadLoad, brake: BrakeProfile) -> None:
        self._load = load
        self._brake = brake if brake.given else None

    def capacity(self, time_s: float) -> float:
        """Return the capacity in N m, not negative, at a scenario time in s."""
        rolling = self._load.rolling_torque(time_s)
        return rolling + self._brake.at(time_s) if self._brake else rolling

    def over(self, times_s: np.ndarray) -> np.ndarray:
        """Return the capacity in N m, (n,), at scenario times in s, (n,)."""
        rolling = self._load.rolling_torques(times_s)
        return rolling + self._brake.over(times_s) if self._brake else rolling


def air_and_slope(
    load: LoadParameters, vehicle: VehicleParameters, slope: SlopeProfile | None = None
) -> RoadLoad:
    """Return the road load without rolling resistance, which is friction at the wheel then."""
    return RoadLoad(replace(load, rolling_coefficient=0.0), vehicle, slope)
