# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Result of a fit to a log."""

from dataclasses import dataclass

import numpy as np

from ddct_bringup.identification.from_log.unknowns import DAMPINGS, DELAYED
from ddct_plant.models.parameters import DrivelineParameters

SLIP = 'slip_speed'
"""Name of the slip among the speeds."""
SIGMAS_95 = 2.0
"""
Half-width of a 95 % interval, in standard deviations.

It is not 1.96, because the noise is estimated from the same log.
"""


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
    undetermined: tuple[str, ...]
    """Parameters and delays that the log does not determine; they keep their start value."""
    spreads: dict[str, float]
    """Standard deviation of each speed and of the slip in the log in rad/s, by name."""
    load_torque: float | None
    """Mean of the fitted constants of C_load in N m; None where C_load was measured."""

    @property
    def parameters(self) -> DrivelineParameters:
        """Parameters of the driveline, with 0 for a negative damping."""
        values = {name: max(each, 0.0) for name, each in self.values.items()}
        return DrivelineParameters.from_values(values)

    @property
    def all_values(self) -> dict[str, float]:
        """Parameters and delays together."""
        return self.values | self.delays

    def interval(self, name: str) -> tuple[float, float] | None:
        """Return the ends of the 95 % interval of a parameter or delay, None if not fitted."""
        if name not in self.std and name not in self.delay_std:
            return None
        value, std = self.all_values[name], (self.std | self.delay_std)[name]
        if name in DAMPINGS or name in DELAYED:
            return value - SIGMAS_95 * std, value + SIGMAS_95 * std
        factor = float(np.exp(SIGMAS_95 * std))
        return value / factor, value * factor
