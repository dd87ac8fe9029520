"""Section 3.2: the weights, and what the printed and the rescaled Hinf1 make of them."""

import math

from ddct_bringup.reproduction.numbers.thesis_number import Value
from ddct_bringup.reproduction.values.factors import pair
from ddct_bringup.reproduction.values.raw_controller import RAW_CONTROLLER
from ddct_bringup.reproduction.values.step_values import fulfilled, step_figures
from ddct_controllers.design.analysis.loops import continuous_loop
from ddct_controllers.design.analysis.margins import loop_margins
from ddct_controllers.design.h_infinity.cleaning import clean
from ddct_controllers.design.h_infinity.recipes import PRINTED_WEIGHTS, THESIS_SPECIFICATIONS
from ddct_controllers.design.h_infinity.uncertainty import (
    PRINTED_W_U,
    WeightedNorms,
    weighted_norms,
)
from ddct_controllers.printed import H_INFINITY_CONTROLLERS
from ddct_plant.base.units import RAD_S_PER_RPM
from ddct_plant.linear.lti import FactoredTransferFunction

_WORN_ERROR = 0.3
"""|G_p/G_pn - 1| at the ends of 0.7 <= K_usura <= 1.3."""


def norm_values() -> dict[str, Value | None]:
    """Return the values by the ids of the gate's file."""
    hinf1 = H_INFINITY_CONTROLLERS['hinf1']
    cleaned, _ = clean(RAW_CONTROLLER, _epsilon_rad_s())
    rescaled = cleaned.gain / RAD_S_PER_RPM
    return {
        'Butterworth': 2.0 * PRINTED_WEIGHTS.complementary.damping,
        'w_1': PRINTED_WEIGHTS.sensitivity.corner_rad_s,
        'W_u s': _WORN_ERROR,
        'W_u constant': _WORN_ERROR * -float(PRINTED_W_U.poles[0].real),
        'epsilon / w_c': _epsilon_over_crossover(),
        'gain of Hinf1.gain': cleaned.gain,
        **_figures('gain of Hinf1', hinf1),
        'raw gain times 30/pi.gain': rescaled,
        **_figures(
            'raw gain times 30/pi',
            FactoredTransferFunction(rescaled, hinf1.numerator, hinf1.denominator),
        ),
    }


def _figures(name: str, controller: FactoredTransferFunction) -> dict[str, Value | None]:
    """Return every figure that Sections 3.2.2 and 3.3 print for Hinf1, of `controller`."""
    loop = continuous_loop(controller)
    norms = _norms(controller)
    rise_time, percent = step_figures(loop)
    nominal = max(norms.sensitivity, norms.complementary) < 1.0
    return {
        f'{name}.norm W_s S': norms.sensitivity,
        f'{name}.norm W_t T': norms.complementary,
        f'{name}.norm W_u T': norms.uncertainty,
        f'{name}.nominal performance': 'ensured' if nominal else 'not ensured',
        f'{name}.robust stability': 'ensured' if norms.uncertainty < 1.0 else 'not ensured',
        f'{name}.specifications': fulfilled(controller, THESIS_SPECIFICATIONS),
        f'{name}.rise time': rise_time,
        f'{name}.overshoot': percent,
    }


def _epsilon_rad_s() -> float:
    """Return epsilon from the slow pole pair, (s + epsilon)^2, of the raw controller."""
    _, product = pair(RAW_CONTROLLER.denominator[4])
    return math.sqrt(product)


def _epsilon_over_crossover() -> float | None:
    crossover = loop_margins(continuous_loop(RAW_CONTROLLER)).crossover_rad_s
    return _epsilon_rad_s() / crossover if crossover else None


def _norms(controller: FactoredTransferFunction) -> WeightedNorms:
    return weighted_norms(
        continuous_loop(controller),
        PRINTED_WEIGHTS.sensitivity,
        PRINTED_WEIGHTS.complementary,
        PRINTED_W_U,
    )
