"""What a controller of Section 2.2 is made of: sign, integrators, networks and gain."""

import numpy as np

from ddct_plant.base.errors import ParameterError, require_number
from ddct_plant.linear.lti import FactoredTransferFunction

_SLOW = 1e-7
"""A frequency below all others of a plant, relative to its slowest pole or zero."""


def integrators(gain: float, count: int) -> FactoredTransferFunction:
    """Return K_c / s^mu."""
    return FactoredTransferFunction(gain, (), (0.0,) * count)


def poles_at_zero(transfer_function: FactoredTransferFunction) -> int:
    """Return the number of poles at s = 0, less that of zeros there."""
    poles = np.count_nonzero(transfer_function.poles == 0.0)
    return int(poles - np.count_nonzero(transfer_function.zeros == 0.0))


def required_integrators(
    plant: FactoredTransferFunction,
    disturbance_path: FactoredTransferFunction,
    disturbance_order: int = 0,
) -> int:
    """
    Return mu, the least number of poles at 0 in G_c for no error from a disturbance at t = inf.

    The disturbance is D_p0 / s^(h + 1), h = `disturbance_order`: 0 a step, 1 a ramp. It reaches
    the output through `disturbance_path` with q poles at 0 (P_1: q = 1), the loop through `plant`
    with p. e = s |path / (1 + L)| D_p0 / s^(h + 1) goes as s^(mu + p - q - h), so that
    mu + p >= q + h + 1; Section 2.2 writes it for P_1, mu + p >= 2.
    """
    if disturbance_order < 0:
        raise ParameterError(
            f'disturbance order is {disturbance_order}: it must be 0 (a step), 1 (a ramp) or more'
        )
    needed = poles_at_zero(disturbance_path) + disturbance_order + 1
    return max(0, needed - poles_at_zero(plant))


def stabilising_sign(plant: FactoredTransferFunction, integrators: int) -> int:
    """
    Return the only sign of K_c in K_c/s^mu times networks that can stabilise the loop, +1 or -1.

    On the positive real axis a network is positive, so L(s) = K_c/s^mu R(s) G(s) has one sign
    from some s down to 0. If it is negative there, 1 + L goes from minus infinity to 1 and has a
    positive root, and P_cl is odd, whatever the networks: then K_c has the wrong sign.
    """
    corners = np.abs(np.concatenate([plant.zeros, plant.poles]))
    slow = _SLOW * np.min(corners[corners > 0.0], initial=1.0)
    value = plant * FactoredTransferFunction(1.0, (), (0.0,) * integrators)
    return 1 if value.at(np.array(slow)).real > 0.0 else -1


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


def with_crossover(
    shape: FactoredTransferFunction, plant: FactoredTransferFunction, crossover_rad_s: float
) -> FactoredTransferFunction:
    """Return `shape` with the size of its gain changed so that |shape plant| = 1 there."""
    response = (shape * plant).frequency_response(np.array([crossover_rad_s]))
    gain = shape.gain / float(np.abs(response)[0])
    return FactoredTransferFunction(gain, shape.numerator, shape.denominator)
