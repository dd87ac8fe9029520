"""Lead and lag networks, the compensators of Section 2.2.2, and the gain for a crossover."""

import math

import numpy as np

from ddct_plant.base.checks import require_number
from ddct_plant.linear.lti import FactoredTransferFunction


def lead_network(zero_rad_s: float, ratio: float) -> FactoredTransferFunction:
    """
    Return R_d(s) = (1 + s/z_d) / (1 + s/(m_d z_d)): phase lead, and gain from z_d on.

    `ratio` is m_d > 1. Raise ParameterError that names a bad number.
    """
    require_number('lead network: z_d', zero_rad_s, unit='rad/s', above=0.0)
    require_number('lead network: m_d', ratio, above=1.0)
    return FactoredTransferFunction(ratio, (zero_rad_s,), (ratio * zero_rad_s,))


def lag_network(pole_rad_s: float, ratio: float) -> FactoredTransferFunction:
    """
    Return R_i(s) = (1 + s/(m_i p_i)) / (1 + s/p_i): attenuation by m_i, and phase lag.

    `ratio` is m_i > 1. Raise ParameterError that names a bad number.
    """
    require_number('lag network: p_i', pole_rad_s, unit='rad/s', above=0.0)
    require_number('lag network: m_i', ratio, above=1.0)
    return FactoredTransferFunction(1.0 / ratio, (ratio * pole_rad_s,), (pole_rad_s,))


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
