# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Computed values of a controller: coefficients by name, z-form, rise time, overshoot."""

from collections.abc import Mapping, Sequence

import numpy as np

from ddct_bringup.reproduction.numbers.thesis_number import Value
from ddct_controllers.design.analysis.loops import continuous_loop
from ddct_controllers.design.analysis.step_response import rise_time_and_overshoot
from ddct_controllers.design.h_infinity.cleaning import rate_of
from ddct_controllers.design.loop_shaping.specifications import TimeSpecifications
from ddct_controllers.design.state_space import pulse_transfer_function
from ddct_controllers.mpc.costs import TABLE_4_1
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_plant.base.errors import ParameterError
from ddct_plant.linear.cascade import Factor
from ddct_plant.linear.lti import FactoredTransferFunction

_DURATION_S = 8.0
_RISE_TOLERANCE = (0.08, 0.02)
_OVERSHOOT_TOLERANCE = 1.5
"""
Tolerances of Tables 2.1 and 3.1, which are read off a plot: rise time as a fraction or in s,
overshoot in points.
"""
_OUTPUT_WEIGHT, _RATE_WEIGHT = 1.0, 0.1
"""
Default weights of MATLAB's mpcDesigner; its slider multiplies the first and divides the other.
"""


def coefficients(name: str, transfer_function: FactoredTransferFunction) -> dict[str, float]:
    """
    Return the gain and all coefficients by `NAME.gain`, `NAME.zero 1`, `NAME.pole 2 b` and so on.

    The number counts the factors of the numerator or the denominator; (s + a) has no letter.
    """
    found = {f'{name}.gain': transfer_function.gain}
    for kind, factors in (
        ('zero', transfer_function.numerator),
        ('pole', transfer_function.denominator),
    ):
        for index, factor in enumerate(factors, start=1):
            label = f'{name}.{kind} {index}'
            if isinstance(factor, tuple):
                found |= {f'{label} b': factor[0], f'{label} c': factor[1]}
            else:
                found[label] = factor
    return found


def in_the_form_of(
    printed: FactoredTransferFunction, computed: FactoredTransferFunction
) -> FactoredTransferFunction:
    """
    Return the computed transfer function in factors of the printed form.

    Its roots, sorted by magnitude, are assigned to the printed factors, sorted by magnitude, two
    to each pair. Raise ParameterError when one has more roots than the other.
    """
    return FactoredTransferFunction(
        computed.gain,
        _dealt(printed.numerator, computed.zeros),
        _dealt(printed.denominator, computed.poles),
    )


def _dealt(form: Sequence[Factor], roots: np.ndarray) -> tuple[Factor, ...]:
    if sum(len(numbers_of(factor)) for factor in form) != len(roots):
        raise ParameterError(f'{len(roots)} roots do not fill {len(form)} printed factors')
    left = list(roots[np.argsort(np.abs(roots), kind='stable')])
    found: list[Factor] = list(form)
    for index in sorted(range(len(form)), key=lambda index: rate_of(form[index])):
        root = left.pop(0)
        if isinstance(form[index], tuple):
            other = left.pop(0)
            found[index] = (float(-(root + other).real), float((root * other).real))
        else:
            found[index] = float(-root.real) + 0.0  # no minus zero
    return tuple(found)


def numbers_of(factor: Factor) -> tuple[float, ...]:
    """Return a of a factor (s + a), or b and c of (s^2 + b s + c)."""
    return factor if isinstance(factor, tuple) else (factor,)


def step_values(
    controllers: Mapping[str, FactoredTransferFunction],
) -> dict[str, float | None]:
    """Return `NAME.rise time` in s and `NAME.overshoot` in % of these controllers."""
    found: dict[str, float | None] = {}
    for name, controller in controllers.items():
        rise_time, over = rise_time_and_overshoot(continuous_loop(controller), _DURATION_S)
        found |= {f'{name}.rise time': rise_time, f'{name}.overshoot': 100.0 * over}
    return found


def fulfilled(controller: FactoredTransferFunction, specifications: TimeSpecifications) -> str:
    """Return the specifications that the step response meets, within plotting accuracy."""
    rise_time, over = rise_time_and_overshoot(continuous_loop(controller), _DURATION_S)
    limit = specifications.rise_time_s
    quick = rise_time is not None and rise_time <= limit + max(
        _RISE_TOLERANCE[0] * limit, _RISE_TOLERANCE[1]
    )
    low = 100.0 * over <= 100.0 * specifications.overshoot + _OVERSHOOT_TOLERANCE
    if quick and low:
        return 'both'
    return 'only the rise time' if quick else 'only the overshoot' if low else 'none'


def sampled_values(name: str) -> dict[str, float]:
    """
    Return the coefficients of G_c(z) of a printed controller, in its order, by `NAME(z)...`.

    It is discretised by zero-order hold at 10 ms.
    """
    return coefficients(f'{name}(z)', pulse_transfer_function(PRINTED_CONTROLLERS[name]))


def predictive_values() -> dict[str, Value | None]:
    """Return R of Table 4.1 by the ids of the gate's file, for one position of the slider."""
    return {
        f'4.1 {name} R': _OUTPUT_WEIGHT * _RATE_WEIGHT / row.output_weight
        for name, row in TABLE_4_1.items()
    }
