"""Lead and lag networks, the compensators of Section 2.2.2, and the gain for a crossover."""

import math
from dataclasses import dataclass

import numpy as np

from ddct_plant.base.checks import require_number
from ddct_plant.linear.lti import FactoredTransferFunction


@dataclass(frozen=True)
class LeadNetwork:
    """R_d(s) = (1 + s/z_d) / (1 + s/(m_d z_d)), m_d > 1: phase lead, and gain from z_d on."""

    zero_rad_s: float
    """z_d."""
    ratio: float
    """m_d."""

    def __post_init__(self) -> None:
        """Check both; raise ParameterError that names a bad one."""
        require_number('lead network: z_d', self.zero_rad_s, unit='rad/s', above=0.0)
        require_number('lead network: m_d', self.ratio, above=1.0)

    @property
    def transfer_function(self) -> FactoredTransferFunction:
        """m_d (s + z_d) / (s + m_d z_d)."""
        pole = self.ratio * self.zero_rad_s
        return FactoredTransferFunction(self.ratio, (self.zero_rad_s,), (pole,))

    @property
    def highest_phase(self) -> float:
        """arcsin((m_d - 1)/(m_d + 1)) in rad, at w/z_d = sqrt(m_d)."""
        return highest_phase(self.ratio)

    def phase(self, omega: float) -> float:
        """Return the lead in rad at `omega` in rad/s."""
        return network_phase(self.ratio, omega / self.zero_rad_s)


@dataclass(frozen=True)
class LagNetwork:
    """R_i(s) = (1 + s/(m_i p_i)) / (1 + s/p_i), m_i > 1: attenuation by m_i, and phase lag."""

    pole_rad_s: float
    """p_i."""
    ratio: float
    """m_i."""

    def __post_init__(self) -> None:
        """Check both; raise ParameterError that names a bad one."""
        require_number('lag network: p_i', self.pole_rad_s, unit='rad/s', above=0.0)
        require_number('lag network: m_i', self.ratio, above=1.0)

    @property
    def transfer_function(self) -> FactoredTransferFunction:
        """(s + m_i p_i) / (m_i (s + p_i))."""
        zero = self.ratio * self.pole_rad_s
        return FactoredTransferFunction(1.0 / self.ratio, (zero,), (self.pole_rad_s,))

    @property
    def lowest_phase(self) -> float:
        """-arcsin((m_i - 1)/(m_i + 1)) in rad, at w/p_i = sqrt(m_i)."""
        return -highest_phase(self.ratio)

    def phase(self, omega: float) -> float:
        """Return the phase, negative, in rad at `omega` in rad/s."""
        return -network_phase(self.ratio, omega / self.pole_rad_s)


def highest_phase(ratio: float) -> float:
    """Return the largest phase in rad of a network of this ratio m."""
    return math.asin((ratio - 1.0) / (ratio + 1.0))


def network_phase(ratio: float, normalised_frequency: float) -> float:
    """Return arctan(x) - arctan(x/m) in rad, x = w/z_d of a lead (negated: w/p_i of a lag)."""
    return math.atan(normalised_frequency) - math.atan(normalised_frequency / ratio)


def with_crossover(
    shape: FactoredTransferFunction, plant: FactoredTransferFunction, crossover_rad_s: float
) -> FactoredTransferFunction:
    """Return `shape` with the size of its gain changed so that |shape plant| = 1 there."""
    response = (shape * plant).frequency_response(np.array([crossover_rad_s]))
    gain = shape.gain / float(np.abs(response)[0])
    return FactoredTransferFunction(gain, shape.numerator, shape.denominator)
