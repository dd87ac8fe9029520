"""Section 3.2.2 synthesised again: what the printed weights lead to, and what Hinf1 came from."""

from ddct_bringup.reproduction.numbers.thesis_number import Finding, Value
from ddct_bringup.reproduction.values.coefficients import coefficients, in_the_form_of
from ddct_bringup.reproduction.values.factors import pair, real
from ddct_bringup.reproduction.values.raw_controller import RAW_CONTROLLER
from ddct_controllers.design.analysis.loops import plant_in_rpm
from ddct_controllers.design.h_infinity.design import design_h_infinity
from ddct_controllers.design.h_infinity.recipes import PRINTED_WEIGHTS
from ddct_controllers.printed import H_INFINITY_CONTROLLERS
from ddct_controllers.synthesised import synthesised_design
from ddct_plant.linear.cascade import Factor
from ddct_plant.linear.lti import FactoredTransferFunction

_SAME = 0.1
"""Relative distance within which a printed factor can be meant to cancel one of the plant."""


def synthesis_values() -> dict[str, Value | None]:
    """Return the values by the ids of the gate's file: whole controllers, no part of one."""
    by_printed, by_fitted = design_h_infinity(PRINTED_WEIGHTS), synthesised_design('hinf_fitted')
    hinf1 = H_INFINITY_CONTROLLERS['hinf1']
    cleaned = coefficients('hinf1 by fitted weights', in_the_form_of(hinf1, by_fitted.cleaned))
    del cleaned['hinf1 by fitted weights.pole 1']  # The pole at 0, which the cleaning puts there.
    return {
        **coefficients('raw by printed weights', in_the_form_of(RAW_CONTROLLER, by_printed.raw)),
        **coefficients('raw by fitted weights', in_the_form_of(RAW_CONTROLLER, by_fitted.raw)),
        **cleaned,
        **_cancelled(),
    }


def _cancelled() -> dict[str, Value | None]:
    """
    Return what an H-infinity controller cancels: all that is stable in G_a P_2.

    Its zeros are the plant's poles without the one at 0, its poles the plant's zeros in the left
    half-plane.
    """
    plant = plant_in_rpm()
    zeros = [factor for factor in plant.numerator if not _grows(factor)]
    poles = [factor for factor in plant.denominator if factor != 0.0]
    whole = FactoredTransferFunction(1.0, tuple(poles), tuple(zeros))
    found: dict[str, Value | None] = dict(coefficients('cancelled', whole))
    del found['cancelled.gain']
    fast = pair(max((factor for factor in poles if isinstance(factor, tuple)), key=lambda f: f[1]))
    numerator = H_INFINITY_CONTROLLERS['hinf2'].numerator
    has = any(isinstance(f, tuple) and abs(f[1] / fast[1] - 1.0) < _SAME for f in numerator)
    return found | {'hinf2 fast pair': Finding(has, f's^2 + {fast[0]:g} s + {fast[1]:g}')}


def _grows(factor: Factor) -> bool:
    return (factor[0] if isinstance(factor, tuple) else real(factor)) < 0.0
