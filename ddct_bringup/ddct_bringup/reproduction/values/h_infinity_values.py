# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Computed values for the numbers of Chapter 3, H-infinity: weights, synthesis, norms of Hinf1."""

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
from ddct_bringup.reproduction.values.loop_shaping_values import translation
from ddct_controllers.design.analysis.loops import continuous_loop, plant_in_rpm
from ddct_controllers.design.analysis.margins import loop_margins
from ddct_controllers.design.h_infinity.cleaning import clean
from ddct_controllers.design.h_infinity.design import design_h_infinity
from ddct_controllers.design.h_infinity.recipes import PRINTED_WEIGHTS, THESIS_SPECIFICATIONS
from ddct_controllers.design.h_infinity.uncertainty import PRINTED_W_U, weighted_norms
from ddct_controllers.design.loop_shaping.design import poles_at_zero
from ddct_controllers.printed import H_INFINITY_CONTROLLERS
from ddct_controllers.synthesised import synthesised_design
from ddct_plant.base.units import RAD_S_PER_RPM
from ddct_plant.linear.lti import FactoredTransferFunction

RAW_CONTROLLER = FactoredTransferFunction(
    gain=-434.85,
    numerator=(0.7567, 0.009368, 0.004946, (82.23, 2563.0), (121.4, 7696.0), (134.1, 4.27e4)),
    denominator=(
        *(1.418e5, 138.0, 89.52, 0.005905),
        (0.01896, 9.053e-5),
        (5.344, 339.4),
        (146.2, 2.914e4),
    ),
)
"""G_c(s) of hinflmi (Section 3.2.2) as printed, before it is cleaned."""
_WORN_ERROR = 0.3
"""Relative error |G_p/G_pn - 1| at the ends of 0.7 <= K_usura <= 1.3."""
_CANCELLATION_TOLERANCE = 0.1
"""Relative distance within which a printed factor may cancel one of the plant."""


def h_infinity_values() -> dict[str, Value | None]:
    """Return the values by the ids of the gate's file."""
    return {
        **translation('3.2', THESIS_SPECIFICATIONS),
        '3.2 w_n': THESIS_SPECIFICATIONS.natural_frequency_rad_s,
        'rise formula': _rise_formula(),
        'W_2 of sderiv': _synthesised_weight(),
        **_norm_values(),
        **_synthesis_values(),
        **step_values({name: H_INFINITY_CONTROLLERS[name] for name in ('hinf2', 'hinf3')}),
        'hinf3 integrators': poles_at_zero(H_INFINITY_CONTROLLERS['hinf3']),
        **sampled_values('hinf1'),
    }


def _rise_formula() -> str:
    """Return the numerator for the printed w_n >= 9.6 rad/s with zeta = 0.63, t_r = 0.3 s."""
    angle = math.acos(THESIS_SPECIFICATIONS.damping)
    numerators = {'pi - arccos(zeta)': math.pi - angle, 'pi arccos(zeta)': math.pi * angle}
    fall = THESIS_SPECIFICATIONS.rise_time_s * math.sin(angle)
    return min(numerators, key=lambda name: abs(numerators[name] / fall - 9.6))


def _synthesised_weight() -> str:
    """Return whether two calls of sderiv, (1 + s/w_2) each, give W_t's polynomial."""
    made = float(np.polymul([1.0, 1.0], [1.0, 1.0])[1])
    printed = 2.0 * PRINTED_WEIGHTS.complementary.damping
    return 'W_t(s)' if math.isclose(made, printed, abs_tol=5e-4) else '(1 + s/w_2)^2/T_p'


def _norm_values() -> dict[str, Value | None]:
    """Return the values of Section 3.2: weights, and norms of the printed and rescaled Hinf1."""
    hinf1 = H_INFINITY_CONTROLLERS['hinf1']
    # The slow pole pair of the raw controller is (s + epsilon)^2.
    _, square = numbers_of(RAW_CONTROLLER.denominator[4])
    epsilon_rad_s = math.sqrt(square)
    crossover = loop_margins(continuous_loop(RAW_CONTROLLER)).crossover_rad_s
    cleaned, _ = clean(RAW_CONTROLLER, epsilon_rad_s)
    rescaled = cleaned.gain / RAD_S_PER_RPM
    return {
        'Butterworth': 2.0 * PRINTED_WEIGHTS.complementary.damping,
        'w_1': PRINTED_WEIGHTS.sensitivity.corner_rad_s,
        'W_u s': _WORN_ERROR,
        'W_u constant': _WORN_ERROR * -float(PRINTED_W_U.poles[0].real),
        'epsilon / w_c': epsilon_rad_s / crossover if crossover else None,
        'gain of Hinf1.gain': cleaned.gain,
        **_printed_values('gain of Hinf1', hinf1),
        'raw gain times 30/pi.gain': rescaled,
        **_printed_values(
            'raw gain times 30/pi',
            FactoredTransferFunction(rescaled, hinf1.numerator, hinf1.denominator),
        ),
    }


def _printed_values(name: str, controller: FactoredTransferFunction) -> dict[str, Value | None]:
    """Return every value that Sections 3.2.2 and 3.3 print for Hinf1, for `controller`."""
    loop = continuous_loop(controller)
    w_s, w_t = PRINTED_WEIGHTS.sensitivity, PRINTED_WEIGHTS.complementary
    norms = weighted_norms(loop, w_s, w_t, PRINTED_W_U)
    nominal = max(norms.sensitivity, norms.complementary) < 1.0
    return {
        f'{name}.norm W_s S': norms.sensitivity,
        f'{name}.norm W_t T': norms.complementary,
        f'{name}.norm W_u T': norms.uncertainty,
        f'{name}.nominal performance': 'ensured' if nominal else 'not ensured',
        f'{name}.robust stability': 'ensured' if norms.uncertainty < 1.0 else 'not ensured',
        f'{name}.specifications': fulfilled(controller, THESIS_SPECIFICATIONS),
        **step_values({name: controller}),
    }


def _synthesis_values() -> dict[str, Value | None]:
    """Return the values of a new synthesis by Section 3.2.2: whole controllers, no part of one."""
    by_printed, by_fitted = design_h_infinity(PRINTED_WEIGHTS), synthesised_design('hinf_fitted')
    hinf1 = H_INFINITY_CONTROLLERS['hinf1']
    cleaned = coefficients('hinf1 by fitted weights', in_the_form_of(hinf1, by_fitted.cleaned))
    del cleaned['hinf1 by fitted weights.pole 1']  # the pole at 0, which the cleaning adds
    return {
        **coefficients('raw by printed weights', in_the_form_of(RAW_CONTROLLER, by_printed.raw)),
        **coefficients('raw by fitted weights', in_the_form_of(RAW_CONTROLLER, by_fitted.raw)),
        **cleaned,
        **_cancelled(),
    }


def _cancelled() -> dict[str, Value | None]:
    """
    Return the factors that an H-infinity controller cancels: all stable ones of G_a P_2.

    Its zeros are the plant's poles without the one at 0, its poles the plant's zeros in the left
    half-plane.
    """
    plant = plant_in_rpm()
    zeros = [factor for factor in plant.numerator if numbers_of(factor)[0] >= 0.0]
    poles = [factor for factor in plant.denominator if factor != 0.0]
    whole = FactoredTransferFunction(1.0, tuple(poles), tuple(zeros))
    found: dict[str, Value | None] = dict(coefficients('cancelled', whole))
    del found['cancelled.gain']
    fast = max((factor for factor in poles if isinstance(factor, tuple)), key=lambda f: f[1])
    numerator = H_INFINITY_CONTROLLERS['hinf2'].numerator
    has = any(
        isinstance(f, tuple) and abs(f[1] / fast[1] - 1.0) < _CANCELLATION_TOLERANCE
        for f in numerator
    )
    return found | {'hinf2 fast pair': Finding(has, f's^2 + {fast[0]:g} s + {fast[1]:g}')}
