"""Every coefficient of a transfer function by name, so that none is left out of a group."""

import math
from collections.abc import Sequence

import numpy as np

from ddct_plant.base.errors import ParameterError
from ddct_plant.linear.cascade import Factor
from ddct_plant.linear.lti import FactoredTransferFunction


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
    Return the computed transfer function in the factors that the print has.

    Slowest with slowest: its roots, by magnitude, go to the printed factors, by magnitude, two to
    each pair. Raise ParameterError when one has more roots than the other.
    """
    return FactoredTransferFunction(
        computed.gain,
        _dealt(printed.numerator, computed.zeros),
        _dealt(printed.denominator, computed.poles),
    )


def _dealt(form: Sequence[Factor], roots: np.ndarray) -> tuple[Factor, ...]:
    if sum(2 if isinstance(factor, tuple) else 1 for factor in form) != len(roots):
        raise ParameterError(f'{len(roots)} roots do not fill {len(form)} printed factors')
    left = list(roots[np.argsort(np.abs(roots), kind='stable')])
    found: list[Factor] = list(form)
    for index in sorted(range(len(form)), key=lambda index: _rate(form[index])):
        root = left.pop(0)
        if isinstance(form[index], tuple):
            other = left.pop(0)
            found[index] = (float(-(root + other).real), float((root * other).real))
        else:
            found[index] = float(-root.real) + 0.0  # no minus zero
    return tuple(found)


def _rate(factor: Factor) -> float:
    return math.sqrt(abs(factor[1])) if isinstance(factor, tuple) else abs(factor)
