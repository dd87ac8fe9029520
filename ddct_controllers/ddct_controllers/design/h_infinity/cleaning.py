# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Clean a synthesised controller: drop the traces of epsilon and optimality (Section 3.2.2)."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from ddct_controllers.design.state_space import factors_text
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.cascade import Factor
from ddct_plant.linear.lti import FactoredTransferFunction

FAST_RAD_S = 10.0 * math.pi / PERIOD_S
"""
Magnitude in rad/s beyond which real poles and zeros have no effect at 10 ms.

It is ten times half the sampling rate.
"""
_NEAR_OFFSET = 3.0
"""Largest ratio, either way, of epsilon to the poles that it causes in the controller."""
_SAME = 1e-3
"""Distance, relative, within which a pole and a zero cancel."""


@dataclass(frozen=True)
class CleaningStep:
    """One rule that was applied, and the factors that it removed."""

    rule: str
    removed: str
    """Factors removed from numerator and denominator."""


def clean(
    controller: FactoredTransferFunction, offset_rad_s: float
) -> tuple[FactoredTransferFunction, tuple[CleaningStep, ...]]:
    """
    Return the controller without the traces of the weights, and the steps of the cleaning.

    In this order: (1) real factors faster than `FAST_RAD_S` go by their gain at rest, s + a
    becoming a; (2) of the two poles that W_1* left at -epsilon one becomes s, mu = 1, the other
    goes in zpk form, s + a becoming 1, together with the slowest zero: that one would cancel the
    plant's pole at 0; (3) a pole and a zero within 0.1 % of each other go in zpk form. Raise
    DdctError when there are no two poles near -epsilon.
    """
    steps: list[CleaningStep] = []
    numerator, zeros_gain = _without_fast(controller.numerator, steps, 'zero')
    denominator, poles_gain = _without_fast(controller.denominator, steps, 'pole')
    numerator, denominator = _with_integrator(numerator, denominator, offset_rad_s, steps)
    numerator, denominator = _without_pairs(numerator, denominator, steps)
    gain = controller.gain * zeros_gain / poles_gain
    return FactoredTransferFunction(gain, tuple(numerator), tuple(denominator)), tuple(steps)


def _without_fast(
    factors: Sequence[Factor], steps: list[CleaningStep], kind: str
) -> tuple[list[Factor], float]:
    """Return the factors that stay, and the product of those dropped at s = 0."""
    stay: list[Factor] = []
    gain = 1.0
    for factor in factors:
        if isinstance(factor, tuple) or abs(factor) < FAST_RAD_S:
            stay.append(factor)
        else:
            gain *= factor
            steps.append(CleaningStep(f'fast {kind}, gain at rest kept', factors_text([factor])))
    return stay, gain


def _with_integrator(
    numerator: list[Factor],
    denominator: list[Factor],
    offset: float,
    steps: list[CleaningStep],
) -> tuple[list[Factor], list[Factor]]:
    nearest = sorted(denominator, key=lambda factor: abs(math.log(rate_of(factor) / offset)))
    left = nearest[:1] if nearest and isinstance(nearest[0], tuple) else nearest[:2]
    orders = sum(_order(factor) for factor in left)
    if orders != 2 or any(not 1 / _NEAR_OFFSET < rate_of(f) / offset < _NEAR_OFFSET for f in left):
        raise DdctError(
            f'cleaning: the controller has no two poles near epsilon = {offset:.3g} rad/s, which '
            'W_1* puts there: clean it by hand, or choose another epsilon'
        )
    slowest = min(numerator, key=rate_of, default=(0.0, 0.0))
    if isinstance(slowest, tuple):
        raise DdctError(
            'cleaning: the slowest zero of the controller is not real, so that it is not the '
            "trace of the plant's pole at 0: choose a larger epsilon"
        )
    steps.append(
        CleaningStep(
            'poles at -epsilon: one becomes s, one goes with the slowest zero',
            f'(s + {slowest:.3g}) over (s + {offset:.3g})^2',
        )
    )
    numerator.remove(slowest)
    return numerator, [0.0, *(factor for factor in denominator if factor not in left)]


def _without_pairs(
    numerator: list[Factor], denominator: list[Factor], steps: list[CleaningStep]
) -> tuple[list[Factor], list[Factor]]:
    for zero in list(numerator):
        pole = next((pole for pole in denominator if _cancels(zero, pole)), None)
        if pole is not None:
            numerator.remove(zero)
            denominator.remove(pole)
            steps.append(
                CleaningStep(
                    'pair that cancels', f'{factors_text([zero])} over {factors_text([pole])}'
                )
            )
    return numerator, denominator


def _cancels(zero: Factor, pole: Factor) -> bool:
    if _order(zero) != _order(pole) or 0.0 in (rate_of(zero), rate_of(pole)):
        return False
    return abs(rate_of(zero) / rate_of(pole) - 1.0) < _SAME and (
        not isinstance(zero, tuple)
        or not isinstance(pole, tuple)
        or abs(zero[0] - pole[0]) < _SAME * rate_of(pole)
    )


def _order(factor: Factor) -> int:
    return 2 if isinstance(factor, tuple) else 1


def rate_of(factor: Factor) -> float:
    """Return the magnitude of the factor's roots in rad/s, their geometric mean for two."""
    return math.sqrt(abs(factor[1])) if isinstance(factor, tuple) else abs(factor)
