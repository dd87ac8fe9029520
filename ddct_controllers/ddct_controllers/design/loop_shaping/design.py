# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The thesis's loop shaping (Section 2.2): sign, integrators, networks and gain.

G_c1 is made of networks, G_c2 by placing poles and zeros.
"""

import numpy as np
import scipy

from ddct_controllers.design.analysis.loops import continuous_loop, plant_in_rpm
from ddct_controllers.design.analysis.step_response import overshoot, step_response
from ddct_controllers.design.loop_shaping.specifications import TimeSpecifications
from ddct_plant.base.errors import ParameterError, require_number
from ddct_plant.linear.lti import FactoredTransferFunction
from ddct_plant.models.driveline_model import clutch_to_slip
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.models.printed import ACTUATOR

NETWORK_SPECIFICATIONS = TimeSpecifications(rise_time_s=0.25, overshoot=0.14)
"""Time specifications for which the thesis designs G_c1."""
PLACEMENT_SPECIFICATIONS = TimeSpecifications(rise_time_s=0.6, overshoot=0.14)
"""Time specifications for which the thesis designs G_c2."""
PLACEMENT_CROSSOVER_RAD_S = 3.5
"""Crossover w_c in rad/s that the thesis takes for t_r = 0.6 s."""
_SLOW = 1e-7
"""Frequency below all others of a plant, relative to its slowest pole or zero."""


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
            f'disturbance order is {disturbance_order}: it must be 0 (a step), 1 (a ramp) or more',
            key='disturbance order',
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


_LEAD = lead_network(zero_rad_s=1.0, ratio=16.0)
"""
Lead network of G_c1: its printed zeros and poles are 1 and 16 rad/s.

The text has z_d = w_c = 8 rad/s instead.
"""
_LAG = lag_network(pole_rad_s=0.6, ratio=16.0)
_GAIN = 0.3
"""Gain |K_c| of G_c1."""


def network_steps() -> dict[str, FactoredTransferFunction]:
    """Return the stages from K_c/s to G_c1, equation (2.1), which is the last one, by name."""
    networks = integrators(1.0, 1) * _LEAD * _LEAD * _LAG
    return {
        '-1/s': integrators(-1.0, 1),
        'and one lead': integrators(-1.0, 1) * _LEAD,
        'and two leads': integrators(-1.0, 1) * _LEAD * _LEAD,
        'and the lag': integrators(-1.0, 1) * _LEAD * _LEAD * _LAG,
        '|K_c| = 0.3: G_c1': integrators(-_GAIN, 0) * networks,
    }


def placement(
    crossover_rad_s: float,
    zero_rad_s: float,
    parameters: DrivelineParameters,
    integrator_count: int = 1,
) -> FactoredTransferFunction:
    """
    Return a controller of G_c2's structure, equation (2.2), with the gain for the crossover.

    G_c = -k (s + z)^mu (slow poles of G_a) / (s^mu (locked-driveline zeros of P_2)): the
    cancellation leaves a loop that falls evenly around w_c. The thesis prints s^2 + 74.29 s + 2393
    for the pair that is s^2 + 82.23 s + 2563 in G_a, as drawn by hand in Control System Designer.
    """
    driveline_zeros = next(f for f in clutch_to_slip(parameters).numerator if isinstance(f, tuple))
    actuator_poles = min(
        (f for f in ACTUATOR.denominator if isinstance(f, tuple)), key=lambda pair: pair[1]
    )
    shape = FactoredTransferFunction(
        -1.0,
        (zero_rad_s,) * integrator_count + (actuator_poles,),
        (0.0,) * integrator_count + (driveline_zeros,),
    )
    return with_crossover(shape, plant_in_rpm(parameters), crossover_rad_s)


def largest_zero_rad_s(
    crossover_rad_s: float, largest_overshoot: float, parameters: DrivelineParameters
) -> float:
    """
    Return the largest z of `placement` that keeps the overshoot, as the thesis's loop has it.

    A loop with two integrators overshoots, the more the larger z is; but the integrators work up
    to z only, so that a disturbance dies out the sooner the larger it is. Without delay and hold.
    """
    duration_s = 30.0 / crossover_rad_s

    def excess(zero_rad_s: float) -> float:
        controller = placement(crossover_rad_s, zero_rad_s, parameters)
        loop = continuous_loop(controller, parameters)
        return overshoot(*step_response(loop, duration_s)) - largest_overshoot

    return float(scipy.optimize.brentq(excess, 0.01 * crossover_rad_s, crossover_rad_s, rtol=1e-6))
