"""Section 3.2: the weights, and the weighted norms that the thesis prints for Hinf1."""

import math

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from ddct_controllers.design.analysis.loops import continuous_loop
from ddct_controllers.design.analysis.steady_state import poles_at_zero
from ddct_controllers.design.h_infinity.recipes import make_weights
from ddct_controllers.design.h_infinity.uncertainty import PRINTED_W_U
from ddct_controllers.design.h_infinity.weighted_norms import WeightedNorms, weighted_norms
from ddct_controllers.design.thesis.thesis_number import Value
from ddct_controllers.printed import H_INFINITY_CONTROLLERS
from ddct_plant.lti import FactoredTransferFunction

_WEIGHTS = make_weights('thesis')
"""W_s and W_t as printed."""
_WORN_ERROR = 0.3
"""|G_p/G_pn - 1| at the ends of 0.7 <= K_usura <= 1.3."""
_GAIN_LOGARITHMS = (-3.0, 4.0)
"""Natural logarithms of the factors on Hinf1's gain among which the lowest norm is looked for."""


def norm_values() -> dict[str, Value]:
    """Return the values by the ids of the gate's file."""
    hinf1 = H_INFINITY_CONTROLLERS['hinf1']
    norms = _norms(hinf1)
    return {
        'Butterworth': 2.0 * _WEIGHTS.complementary.damping,
        'w_1': _WEIGHTS.sensitivity.corner_rad_s,
        'W_1 poles': poles_at_zero(_WEIGHTS.sensitivity.transfer_function()),
        # Each call of sderiv multiplies the channel by 1 + s/w_2.
        'W_2 of sderiv': float(np.polymul([1.0, 1.0], [1.0, 1.0])[1]),
        # W_u falls evenly from its value at rest to its coefficient of s.
        'W_u cover': PRINTED_W_U.gain / _WORN_ERROR,
        'W_u covers up to': _covered_rad_s(),
        'norm W_s S': norms.sensitivity,
        'norm W_t T': norms.complementary,
        'norm W_u T': norms.uncertainty,
        'lowest norm W_t T': _lowest_complementary_norm(hinf1),
        'gain for W_s S': _gain_for(hinf1, 'sensitivity', 0.97),
        'gain for W_u T': _gain_for(hinf1, 'uncertainty', 0.32),
    }


def _covered_rad_s() -> float:
    """Return the frequency above which |W_u| is below the error of a worn clutch."""

    def excess(omega: float) -> float:
        response = PRINTED_W_U.frequency_response(np.array([omega]))
        return float(np.abs(response)[0]) - _WORN_ERROR

    return float(brentq(excess, 1.0, 1e6))


def _gain_for(controller: FactoredTransferFunction, norm: str, printed: float) -> float:
    """Return the factor on the gain, up to 3, that gives a norm its printed value."""

    def excess(factor: float) -> float:
        return getattr(_norms(controller, factor), norm) - printed

    return float(brentq(excess, 1.0, 3.0, xtol=1e-4))


def _lowest_complementary_norm(controller: FactoredTransferFunction) -> float:
    """Return the least peak of |W_t T| that any factor on the controller's gain reaches."""

    def norm(logarithm: float) -> float:
        return _norms(controller, math.exp(logarithm)).complementary

    return float(minimize_scalar(norm, bounds=_GAIN_LOGARITHMS, method='bounded').fun)


def _norms(controller: FactoredTransferFunction, factor: float = 1.0) -> WeightedNorms:
    """Return the norms of the loop with `factor` on the controller's gain."""
    loop = continuous_loop(FactoredTransferFunction(factor) * controller)
    return weighted_norms(loop, _WEIGHTS.sensitivity, _WEIGHTS.complementary, PRINTED_W_U)
