# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Computed values for the numbers of Chapter 2, loop shaping."""

import math

import numpy as np

from ddct_bringup.reproduction.numbers.thesis_number import Finding, Value
from ddct_bringup.reproduction.values.controller_values import (
    coefficients,
    fulfilled,
    in_the_form_of,
    numbers_of,
    sampled_values,
    step_values,
)
from ddct_controllers.design.analysis.loop_curve import LoopCurve
from ddct_controllers.design.analysis.loops import continuous_loop, plant_in_rpm
from ddct_controllers.design.analysis.nyquist import nyquist_count
from ddct_controllers.design.loop_shaping.design import (
    NETWORK_SPECIFICATIONS,
    PLACEMENT_CROSSOVER_RAD_S,
    PLACEMENT_SPECIFICATIONS,
    integrators,
    largest_zero_rad_s,
    lead_network,
    network_steps,
    placement,
    poles_at_zero,
    required_integrators,
    stabilising_sign,
)
from ddct_controllers.design.loop_shaping.specifications import (
    TimeSpecifications,
    prototype_phase_margin,
    rise_time_crossover_product,
)
from ddct_controllers.design.loop_shaping.verification import contours
from ddct_controllers.printed import LOOP_SHAPING_CONTROLLERS
from ddct_plant.models.driveline_model import engine_to_slip, load_to_slip
from ddct_plant.models.parameters import DrivelineParameters

_DRIVELINE = DrivelineParameters()
_CROSSOVER_RAD_S = 8.0
"""Crossover frequency w_c in rad/s that Section 2.2 designs G_c1 for."""
_PRINTED_PRODUCT = 2.02
"""Product t_r w_c that Section 2.2 reads off Figure 2.2."""
_LEAD_RATIO = 16.0
"""Lead ratio m_d as printed."""
_INTEGRATORS = {0: '1', 1: 's'}
"""Printed factor of mu poles at 0, by mu."""
_SAMPLED_PAIR = 0.9481
"""Coefficient c of the pole pair of G_c2(z) as printed."""


def loop_shaping_values() -> dict[str, Value | None]:
    """Return the values by the ids of the gate's file."""
    steps = step_values(LOOP_SHAPING_CONTROLLERS)
    percent = steps['ls7.overshoot']
    # t_r w_c is the lower bound of the chosen crossover.
    bound = _PRINTED_PRODUCT / PLACEMENT_SPECIFICATIONS.rise_time_s
    # The printed pole pairs are s^2 + b s + ... and z^2 + ... + c: c = exp(-b T).
    b, _ = numbers_of(LOOP_SHAPING_CONTROLLERS['ls7'].denominator[-1])
    return {
        **translation('2.2', NETWORK_SPECIFICATIONS),
        '2.2 t_r w_c': rise_time_crossover_product(NETWORK_SPECIFICATIONS.damping),
        '2.2 w_c': _PRINTED_PRODUCT / NETWORK_SPECIFICATIONS.rise_time_s,
        '2.2 w_c of G_c2': Finding(bound <= PLACEMENT_CROSSOVER_RAD_S, f'at least {bound:.2f}'),
        **_steady_state(),
        **_sign(),
        **_networks(),
        **_placement(),
        **steps,
        'ls7.peak': None if percent is None else 1.0 + percent / 100.0,
        'G_c2 specifications': fulfilled(
            LOOP_SHAPING_CONTROLLERS['ls7'], PLACEMENT_SPECIFICATIONS
        ),
        **sampled_values('ls7'),
        'sampling period': 1e3 * (-math.log(_SAMPLED_PAIR) / b),
    }


def translation(section: str, specifications: TimeSpecifications) -> dict[str, Value | None]:
    """Return zeta, S_p and T_p of an overshoot."""
    return {
        f'{section} zeta': specifications.damping,
        f'{section} S_p': specifications.sensitivity_peak,
        f'{section} T_p': specifications.complementary_peak,
    }


def _steady_state() -> dict[str, Value | None]:
    plant = plant_in_rpm(_DRIVELINE)
    mu = required_integrators(plant, engine_to_slip(_DRIVELINE))
    for_load = required_integrators(plant, load_to_slip(_DRIVELINE))
    return {
        '2.2 mu': mu,
        '2.2 integrator': _INTEGRATORS.get(mu, f's^{mu}'),
        '2.2 p': poles_at_zero(plant),
        '2.2 mu + p': mu + poles_at_zero(plant),
        '2.2 mu for C_load': 'does not change' if for_load == mu else f'mu >= {for_load}',
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
    """Return the phase that -1/s lacks at w_c, and the effect of the networks on G_c1."""
    g_c1 = LOOP_SHAPING_CONTROLLERS['ls2']
    response = continuous_loop(integrators(-1.0, 1)).response(np.array([_CROSSOVER_RAD_S]))[0]
    specified = prototype_phase_margin(NETWORK_SPECIFICATIONS.damping)
    s_peak, t_peak = contours(LoopCurve(continuous_loop(g_c1)), NETWORK_SPECIFICATIONS)
    (lead_zero,) = numbers_of(g_c1.numerator[1])
    lead = lead_network(1.0, _LEAD_RATIO).frequency_response(np.ones(1))[0]
    made = in_the_form_of(g_c1, list(network_steps().values())[-1])
    put_in = {'G_c1.zero 2', 'G_c1.zero 3', 'G_c1.pole 1', 'G_c1.pole 4'}
    return {
        'missing phase': math.degrees(specified - float(np.angle(-response))),
        'lead phase': math.degrees(float(np.angle(lead))),
        # w_c = 8 rad/s divided by the printed zero of the leads
        'lead zero': f'w_c / {_CROSSOVER_RAD_S / lead_zero:g}',
        **{name: x for name, x in coefficients('G_c1', made).items() if name not in put_in},
        'G_c1 in Nichols': 'out of the circles'
        if s_peak.respected and t_peak.respected
        else 'crosses the circle',
        'G_c1 specifications': fulfilled(g_c1, NETWORK_SPECIFICATIONS),
    }


def _placement() -> dict[str, Value | None]:
    """Return G_c2 by our placement: its zero is the largest allowed, its pairs are the plant's."""
    crossover, allowed = PLACEMENT_CROSSOVER_RAD_S, PLACEMENT_SPECIFICATIONS.overshoot
    zero = largest_zero_rad_s(crossover, allowed, _DRIVELINE)
    placed = placement(crossover, zero, _DRIVELINE)
    found = coefficients('G_c2', in_the_form_of(LOOP_SHAPING_CONTROLLERS['ls7'], placed))
    # The pole at 0 follows from mu.
    return {name: value for name, value in found.items() if name != 'G_c2.pole 1'}
