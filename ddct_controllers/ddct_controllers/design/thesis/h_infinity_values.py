"""What we compute for the numbers of Chapter 3, H-infinity."""

import math

from scipy.optimize import brentq

from ddct_controllers.design.analysis.loops import continuous_loop, sampled_loop
from ddct_controllers.design.analysis.margins import loop_margins
from ddct_controllers.design.analysis.steady_state import poles_at_zero
from ddct_controllers.design.h_infinity.cleaning import clean
from ddct_controllers.design.h_infinity.recipes import THESIS_SPECIFICATIONS
from ddct_controllers.design.thesis.factors import pair
from ddct_controllers.design.thesis.loop_shaping_values import translation
from ddct_controllers.design.thesis.norm_values import norm_values
from ddct_controllers.design.thesis.sampled_values import sampled_integrators, sampled_values
from ddct_controllers.design.thesis.step_values import fulfilled, step_figures, step_values
from ddct_controllers.design.thesis.synthesis_values import synthesis_values
from ddct_controllers.design.thesis.thesis_number import Value
from ddct_controllers.printed import H_INFINITY_CONTROLLERS
from ddct_plant.lti import FactoredTransferFunction, discretise_zoh
from ddct_plant.timebase import PERIOD_S

_WORST_WEAR = 1.3
"""K_usura at which a fast loop is nearest to instability, inequality (3.2)."""
_RAW = FactoredTransferFunction(
    gain=-434.85,
    numerator=(0.7567, 0.009368, 0.004946, (82.23, 2563.0), (121.4, 7696.0), (134.1, 4.27e4)),
    denominator=(
        *(1.418e5, 138.0, 89.52, 0.005905),
        (0.01896, 9.053e-5),
        (5.344, 339.4),
        (146.2, 2.914e4),
    ),
)
"""G_c as hinflmi gives it in Section 3.2.2, before it is cleaned."""


def h_infinity_values() -> dict[str, Value | None]:
    """Return the values by the ids of the gate's file."""
    return {
        **translation('3.2', THESIS_SPECIFICATIONS),
        '3.2 w_n': THESIS_SPECIFICATIONS.natural_frequency_rad_s,
        'rise formula': _rise_formula(),
        **norm_values(),
        **synthesis_values(),
        'cleaned gain': clean(_RAW, _epsilon_rad_s())[0].gain,
        'epsilon / w_c': _epsilon_over_crossover(),
        **step_values(H_INFINITY_CONTROLLERS),
        'Hinf1 specifications': fulfilled('hinf1', THESIS_SPECIFICATIONS),
        'gain for t_r': _gain_for_rise_time(),
        **_as_run(),
        'hinf3 integrators': poles_at_zero(H_INFINITY_CONTROLLERS['hinf3']),
        **sampled_values('hinf1'),
        'hinf1(z).integrators': sampled_integrators('hinf1'),
    }


def _rise_formula() -> str:
    """Return which numerator gives the printed w_n >= 9.6 rad/s for zeta = 0.63, t_r = 0.3 s."""
    angle = math.acos(THESIS_SPECIFICATIONS.damping)
    numerators = {'pi - arccos(zeta)': math.pi - angle, 'pi arccos(zeta)': math.pi * angle}
    fall = THESIS_SPECIFICATIONS.rise_time_s * math.sin(angle)
    return min(numerators, key=lambda name: abs(numerators[name] / fall - 9.6))


def _epsilon_rad_s() -> float:
    """Return epsilon from the slow pole pair, (s + epsilon)^2, of the raw controller."""
    _, product = pair(_RAW.denominator[4])
    return math.sqrt(product)


def _epsilon_over_crossover() -> float | None:
    crossover = loop_margins(continuous_loop(_RAW)).crossover_rad_s
    return _epsilon_rad_s() / crossover if crossover else None


def _gain_for_rise_time() -> float:
    """Return the factor on Hinf1's gain that gives the rise time asked for and printed."""

    def excess(factor: float) -> float:
        controller = FactoredTransferFunction(factor) * H_INFINITY_CONTROLLERS['hinf1']
        rise_time, _ = step_figures(continuous_loop(controller))
        return (math.inf if rise_time is None else rise_time) - THESIS_SPECIFICATIONS.rise_time_s

    return float(brentq(excess, 1.0, 4.0, xtol=1e-4))


def _as_run() -> dict[str, Value | None]:
    """Return what Hinf2 does in the loop with its hold and its delay."""
    sampled = discretise_zoh(H_INFINITY_CONTROLLERS['hinf2'].to_state_space(), PERIOD_S)
    worn = loop_margins(sampled_loop(sampled, wear_gain=_WORST_WEAR))
    return {
        'hinf2 sampled.overshoot': step_figures(sampled_loop(sampled))[1],
        'hinf2 sampled.M_s worn': worn.sensitivity_peak,
    }
