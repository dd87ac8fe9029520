# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Result of a fit to a log."""

import math
from dataclasses import dataclass

import numpy as np

from ddct_bringup.identification.from_log.dependence import Dependence
from ddct_bringup.identification.from_log.noise import NoiseModel
from ddct_bringup.identification.from_log.problem import DAMPINGS
from ddct_bringup.logs.wheel_radius import MeasuredRadius
from ddct_plant.models.gearbox import AGREE
from ddct_plant.models.parameters import DrivelineParameters

PARAMETERS = tuple(DrivelineParameters().values())
"""Names of all driveline parameters."""
SLIP = 'slip_speed'
"""Name of the slip among the speeds."""
SIGMAS_95 = 1.96
"""Half-width of a 95 % interval, in standard deviations."""
NO_DAMPING = 1e-6
"""Damping in N m s/rad that counts as zero: 0.001 N m at 1000 rad/s."""
MEASURED, GIVEN, ASSUMED = 'measured', 'given', 'assumed'
"""Origins of a wheel radius: the log, --set, or only the base scenario."""


@dataclass(frozen=True)
class WheelRadius:
    """Wheel radius that drag, mass and new scenario are computed with."""

    value_m: float
    """Radius r_w in m."""
    state: str
    """Origin: MEASURED, GIVEN or ASSUMED."""
    measured: MeasuredRadius | None
    """Radius of V_x over w_r; None where the log does not have both."""

    @property
    def contradiction(self) -> MeasuredRadius | None:
        """Measured radius where a given one is outside its interval; None elsewhere."""
        found = self.measured
        if not found or self.state != GIVEN or found.lowest_m <= self.value_m <= found.highest_m:
            return None
        return None if math.isclose(self.value_m, found.value_m, rel_tol=AGREE) else found


@dataclass(frozen=True)
class LogFit:
    """Driveline parameters and delays that are fitted to a log, with their uncertainty."""

    values: dict[str, float]
    """Values of all parameters in SI units, by name, fitted or kept; a fitted damping may be
    negative."""
    std: dict[str, float]
    """Standard deviation of each fitted parameter, by name: relative, of a damping in SI units."""
    delays: dict[str, float]
    """Delay of each signal in s, by name, fitted or given, relative to the engine speed."""
    delay_std: dict[str, float]
    """Standard deviation of each fitted delay in s, by name."""
    bends: dict[str, float]
    """Shares of the second differences of the torques, by the names of BENDS."""
    undetermined: tuple[str, ...]
    """Parameters and delays that the log does not determine; they keep their start value."""
    noise: NoiseModel
    """Noise model of the residuals."""
    dependences: dict[str, Dependence]
    """Dependence of the residuals on the torques, by speed."""
    spreads: dict[str, float]
    """Standard deviation of each speed and of the slip in the log in rad/s, by name."""
    load_torque: float | None
    """Mean of the fitted constants of C_load in N m; None where C_load was measured."""

    @property
    def parameters(self) -> DrivelineParameters:
        """Parameters of the driveline, with 0 for a negative damping."""
        values = {name: max(each, 0.0) for name, each in self.values.items()}
        return DrivelineParameters.from_values(values)

    def interval(self, name: str) -> tuple[float, float] | None:
        """Return the ends of the 95 % interval of a parameter or delay, None if not fitted."""
        if name in self.delay_std:
            value, reach = self.delays[name], SIGMAS_95 * self.delay_std[name]
            return value - reach, value + reach
        if name not in self.std:
            return None
        value, reach = self.values[name], SIGMAS_95 * self.std[name]
        if name in DAMPINGS:
            return value - reach, value + reach
        return value * float(np.exp(-reach)), value * float(np.exp(reach))
