"""What we compute for the numbers of Chapter 3, H-infinity."""

import math

import numpy as np

from ddct_bringup.reproduction.numbers.thesis_number import Value
from ddct_bringup.reproduction.values.loop_shaping_values import translation
from ddct_bringup.reproduction.values.norm_values import norm_values
from ddct_bringup.reproduction.values.sampled_values import sampled_values
from ddct_bringup.reproduction.values.step_values import step_values
from ddct_bringup.reproduction.values.synthesis_values import synthesis_values
from ddct_controllers.design.h_infinity.recipes import PRINTED_WEIGHTS, THESIS_SPECIFICATIONS
from ddct_controllers.design.loop_shaping.networks import poles_at_zero
from ddct_controllers.printed import H_INFINITY_CONTROLLERS


def h_infinity_values() -> dict[str, Value | None]:
    """Return the values by the ids of the gate's file."""
    return {
        **translation('3.2', THESIS_SPECIFICATIONS),
        '3.2 w_n': THESIS_SPECIFICATIONS.natural_frequency_rad_s,
        'rise formula': _rise_formula(),
        'W_2 of sderiv': _synthesised_weight(),
        **norm_values(),
        **synthesis_values(),
        **step_values(('hinf2', 'hinf3')),
        'hinf3 integrators': poles_at_zero(H_INFINITY_CONTROLLERS['hinf3']),
        **sampled_values('hinf1'),
    }


def _rise_formula() -> str:
    """Return which numerator gives the printed w_n >= 9.6 rad/s for zeta = 0.63, t_r = 0.3 s."""
    angle = math.acos(THESIS_SPECIFICATIONS.damping)
    numerators = {'pi - arccos(zeta)': math.pi - angle, 'pi arccos(zeta)': math.pi * angle}
    fall = THESIS_SPECIFICATIONS.rise_time_s * math.sin(angle)
    return min(numerators, key=lambda name: abs(numerators[name] / fall - 9.6))


def _synthesised_weight() -> str:
    """Return whether two calls of sderiv, (1 + s/w_2) each, make W_t's polynomial."""
    made = float(np.polymul([1.0, 1.0], [1.0, 1.0])[1])
    printed = 2.0 * PRINTED_WEIGHTS.complementary.damping
    return 'W_t(s)' if math.isclose(made, printed, abs_tol=5e-4) else '(1 + s/w_2)^2/T_p'
