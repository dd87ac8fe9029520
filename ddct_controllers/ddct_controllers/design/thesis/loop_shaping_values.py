"""What we compute for the numbers of Chapter 2, loop shaping."""

import math
from collections.abc import Mapping

import numpy as np
from scipy.optimize import brentq

from ddct_controllers.design.analysis.loop_curve import LoopCurve
from ddct_controllers.design.analysis.loops import continuous_loop, plant_in_rpm
from ddct_controllers.design.analysis.margins import loop_margins
from ddct_controllers.design.analysis.steady_state import poles_at_zero, required_integrators
from ddct_controllers.design.loop_shaping.design import (
    NETWORK_SPECIFICATIONS,
    PLACEMENT_CROSSOVER_RAD_S,
    PLACEMENT_SPECIFICATIONS,
    integrators,
    largest_zero_rad_s,
    placement,
)
from ddct_controllers.design.loop_shaping.networks import network_phase
from ddct_controllers.design.loop_shaping.nichols import contours
from ddct_controllers.design.loop_shaping.nyquist import nyquist_count, stabilising_sign
from ddct_controllers.design.loop_shaping.specifications import (
    TimeSpecifications,
    prototype_phase_margin,
    rise_time_crossover_product,
)
from ddct_controllers.design.thesis.factors import pair, real
from ddct_controllers.design.thesis.sampled_values import sampled_values
from ddct_controllers.design.thesis.step_values import (
    fulfilled,
    rise_time_without_rpm,
    step_values,
)
from ddct_controllers.design.thesis.thesis_number import Value
from ddct_controllers.printed import LOOP_SHAPING_CONTROLLERS
from ddct_plant.driveline_model import engine_to_slip, load_to_slip
from ddct_plant.parameters import DrivelineParameters

_DRIVELINE = DrivelineParameters()
_CROSSOVER_RAD_S = 8.0
"""w_c that Section 2.2 designs G_c1 for."""
_PRINTED_PRODUCT = 2.02
"""t_r w_c that Section 2.2 reads off Figure 2.2."""
_SAMPLED_PAIR = 0.9481
"""c of the pole pair of G_c2(z) as printed."""


def loop_shaping_values() -> dict[str, Value | None]:
    """Return the values by the ids of the gate's file."""
    return {
        **translation('2.2', NETWORK_SPECIFICATIONS),
        '2.2 t_r w_c': rise_time_crossover_product(NETWORK_SPECIFICATIONS.damping),
        '2.2 zeta of 2.02': _damping_of_product(_PRINTED_PRODUCT),
        '2.2 w_c': NETWORK_SPECIFICATIONS.crossover_rad_s,
        '2.2 w_c of G_c2': PLACEMENT_SPECIFICATIONS.crossover_rad_s,
        **_steady_state(),
        **_sign(),
        **_networks(),
        **_placement(),
        **_table_2_1(),
        'ls8.rise time in rad/s': rise_time_without_rpm(),
        'G_c2 specifications': fulfilled('ls7', PLACEMENT_SPECIFICATIONS),
        **sampled_values('ls7'),
        'sampling period': 1e3 * _sampling_period_s(),
    }


def translation(section: str, specifications: TimeSpecifications) -> dict[str, Value | None]:
    """Return zeta, S_p and T_p of an overshoot."""
    return {
        f'{section} zeta': specifications.damping,
        f'{section} S_p': specifications.sensitivity_peak,
        f'{section} T_p': specifications.complementary_peak,
    }


def _damping_of_product(product: float) -> float:
    """Return the zeta at which the prototype has this t_r w_c."""
    return float(brentq(lambda zeta: rise_time_crossover_product(zeta) - product, 0.4, 0.9))


def _steady_state() -> dict[str, Value | None]:
    plant = plant_in_rpm(_DRIVELINE)
    mu = required_integrators(plant, engine_to_slip(_DRIVELINE))
    return {
        '2.2 mu': mu,
        '2.2 p': poles_at_zero(plant),
        '2.2 mu + p': mu + poles_at_zero(plant),
        '2.2 mu for C_load': required_integrators(plant, load_to_slip(_DRIVELINE)),
    }


def _sign() -> dict[str, Value | None]:
    found: dict[str, Value | None] = {}
    for gain in (1.0, -1.0):
        count = nyquist_count(continuous_loop(integrators(gain, 1)))
        found |= {
            f'K_c {gain:+g} P_ol': count.open_loop_unstable,
            f'K_c {gain:+g} N': count.encirclements,
            f'K_c {gain:+g} P_cl': count.closed_loop_unstable,
        }
    sign = stabilising_sign(plant_in_rpm(), 1)
    return found | {'sign of K_c': 'positive' if sign > 0 else 'negative'}


def _networks() -> dict[str, Value | None]:
    """Return the phase that -1/s lacks at w_c, and what G_c1 is made of."""
    g_c1 = LOOP_SHAPING_CONTROLLERS['ls2']
    response = continuous_loop(integrators(-1.0, 1)).response(np.array([_CROSSOVER_RAD_S]))[0]
    wanted = prototype_phase_margin(NETWORK_SPECIFICATIONS.damping)
    lead_zero, lead_pole = real(g_c1.numerator[1]), real(g_c1.denominator[1])
    ratio = lead_pole / lead_zero
    loop = continuous_loop(g_c1)
    s_peak, t_peak = contours(LoopCurve(loop), NETWORK_SPECIFICATIONS)
    return {
        'missing phase': math.degrees(wanted - float(np.angle(-response))),
        'lead phase': math.degrees(network_phase(ratio, 1.0)),
        'lead ratio': ratio,
        'lead zero': lead_pole / ratio,
        # s G_c1 at 0: the steady-state gain of Section 2.2.
        'K_c of G_c1': abs(g_c1.gain * np.prod(-g_c1.zeros) / np.prod(-g_c1.poles[1:])),
        'G_c1 crossover': loop_margins(loop).crossover_rad_s,
        'G_c1 in Nichols': 'out of the circles'
        if s_peak.respected and t_peak.respected
        else 'crosses the circle',
    }


def _placement() -> dict[str, Value | None]:
    """Return what a placement like G_c2 comes to when its zero is the largest allowed."""
    crossover, allowed = PLACEMENT_CROSSOVER_RAD_S, PLACEMENT_SPECIFICATIONS.overshoot
    zero = largest_zero_rad_s(crossover, allowed, _DRIVELINE)
    b, c = pair(placement(crossover, zero, _DRIVELINE).denominator[-1])
    return {'G_c2 zero': zero, 'G_c2 pole b': b, 'G_c2 pole c': c}


def _table_2_1() -> Mapping[str, Value | None]:
    found = step_values(LOOP_SHAPING_CONTROLLERS)
    rise_time_s, percent = found['ls2.rise time'], found['ls7.overshoot']
    quick = rise_time_s is not None and rise_time_s < NETWORK_SPECIFICATIONS.rise_time_s
    return found | {
        'ls7.peak': None if percent is None else 1.0 + percent / 100.0,
        'G_c1 rise time': 'fulfilled' if quick else 'missed',
    }


def _sampling_period_s() -> float:
    """Return T of the printed pole pairs s^2 + b s + ... and z^2 + ... + c: c = exp(-b T)."""
    b, _ = pair(LOOP_SHAPING_CONTROLLERS['ls7'].denominator[-1])
    return -math.log(_SAMPLED_PAIR) / b
