"""Section 3.2.2 synthesised again: what the printed weights lead to, and what Hinf1 came from."""

from ddct_controllers.design.analysis.loops import plant_in_rpm
from ddct_controllers.design.h_infinity.controllers import synthesised_design
from ddct_controllers.design.thesis.factors import pair, real
from ddct_controllers.design.thesis.thesis_number import Value
from ddct_plant.cascade import Factor
from ddct_plant.lti import FactoredTransferFunction

_SLOW_RAD_S, _FAST_RAD_S = 0.1, 10.0
"""Only one real zero of Hinf1 is between: the others cancel slow poles."""


def synthesis_values() -> dict[str, Value]:
    """Return the values by the ids of the gate's file."""
    printed, fitted = synthesised_design('hinf_thesis'), synthesised_design('hinf_fitted')
    controller = fitted.raw
    b, c = pair(controller.denominator[-1])
    return {
        'least norm': printed.synthesis.optimum,
        'zero with printed weights': _middle_zero(printed.raw),
        'zero with fitted weights': _middle_zero(controller),
        'fast pair b with fitted weights': b,
        'fast pair c with fitted weights': c,
        **_cancelling_factors(controller),
    }


def _cancelling_factors(controller: FactoredTransferFunction) -> dict[str, Value]:
    """
    Return the controller's factors that cancel what is stable in G_a P_2.

    Its slow pole is that of the plant's zero, and taken from there: next to the shifted pole at 0
    a synthesis gives it with three digits only.
    """
    plant = plant_in_rpm()
    zero, _, slow_zero, locked = plant.numerator
    actuator_slow, actuator_fast, _, _, free = plant.denominator
    found: dict[str, Value] = {
        'actuator zero': _nearest_real(controller.denominator, real(zero)),
        'slow zero': real(slow_zero),
    }
    for name, factors, cancelled in (
        ('actuator slow pole', controller.numerator, actuator_slow),
        ('actuator fast pole', controller.numerator, actuator_fast),
        ('free driveline pole', controller.numerator, free),
        ('locked driveline zero', controller.denominator, locked),
    ):
        b, c = _nearest_pair(factors, pair(cancelled))
        found |= {f'{name} b': b, f'{name} c': c}
    return found


def _nearest_real(factors: tuple[Factor, ...], wanted: float) -> float:
    reals = [factor for factor in factors if isinstance(factor, float)]
    return min(reals, key=lambda a: abs(a - wanted))


def _nearest_pair(factors: tuple[Factor, ...], wanted: tuple[float, float]) -> tuple[float, float]:
    pairs = [factor for factor in factors if isinstance(factor, tuple)]
    return min(pairs, key=lambda one: abs(one[1] - wanted[1]))


def _middle_zero(controller: FactoredTransferFunction) -> float:
    """Return a of the zero (s + a) that shapes the loop below the crossover."""
    (found,) = (
        factor
        for factor in controller.numerator
        if isinstance(factor, float) and _SLOW_RAD_S < factor < _FAST_RAD_S
    )
    return found
