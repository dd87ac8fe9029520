"""What a log says of a driveline."""

from dataclasses import dataclass

import numpy as np

from ddct_plant.identification.from_log.dependence import Dependence
from ddct_plant.identification.from_log.noise import NoiseModel
from ddct_plant.identification.from_log.problem import DAMPINGS
from ddct_plant.models.parameters import DrivelineParameters

PARAMETERS = tuple(vars(DrivelineParameters()))
SLIP = 'slip_speed'
SIGMAS_95 = 1.96
NO_DAMPING = 1e-6
"""Size of a damping in N m s/rad that is none: 0.001 N m at 1000 rad/s."""


@dataclass(frozen=True)
class LogFit:
    """What a log says of the driveline."""

    values: dict[str, float]
    """Values of all parameters, fitted or held. A fitted damping may be below 0."""
    std: dict[str, float]
    """Standard deviation of each fitted one: of the value of a damping, else relative."""
    delays: dict[str, float]
    """How late the log has each signal in s, fitted or given, against the engine speed."""
    delay_std: dict[str, float]
    """Standard deviation of each fitted one in s."""
    bends: dict[str, float]
    """Shares of the second differences of the torques, as BENDS tells."""
    undetermined: tuple[str, ...]
    """Parameters and delays that the log does not determine; they keep the value of the start."""
    noise: NoiseModel
    dependences: dict[str, Dependence]
    """By speed, how far the residuals of the fit depend on the torques."""
    spreads: dict[str, float]
    """Standard deviation of each speed and of the slip in the log, in rad/s."""
    load_torque: float | None
    """Mean of the constants that were fitted as C_load, in N m; None where it was measured."""

    @property
    def parameters(self) -> DrivelineParameters:
        """The values, dampings below 0 as 0."""
        return DrivelineParameters(**{name: max(each, 0.0) for name, each in self.values.items()})

    def interval(self, name: str) -> tuple[float, float] | None:
        """Return the ends of the 95 % interval of a parameter or delay, None of one not fitted."""
        if name in self.delay_std:
            value, reach = self.delays[name], SIGMAS_95 * self.delay_std[name]
            return value - reach, value + reach
        if name not in self.std:
            return None
        value, reach = self.values[name], SIGMAS_95 * self.std[name]
        if name in DAMPINGS:
            return value - reach, value + reach
        return value * float(np.exp(-reach)), value * float(np.exp(reach))
