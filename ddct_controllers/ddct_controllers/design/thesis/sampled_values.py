"""The printed z-forms: controllers discretised by zero-order hold at 10 ms."""

import numpy as np

from ddct_controllers.design.analysis.pulse_transfer_function import pulse_transfer_function
from ddct_controllers.design.thesis.thesis_number import Value
from ddct_controllers.printed import PRINTED_CONTROLLERS

_AT_ONE = 1e-8
"""Distance from z = 1 below which a pole is an integrator: far below that of any slow pole."""


def sampled_values(name: str) -> dict[str, Value]:
    """
    Return the coefficients of G_c(z) of a printed controller, in its order.

    `NAME(z).zero 1` is a of the first (z + a), `NAME(z).zero 2 b` and `... c` are those of the
    first (z^2 + b z + c) if that is the second factor.
    """
    form = pulse_transfer_function(PRINTED_CONTROLLERS[name])
    found: dict[str, Value] = {f'{name}(z).gain': form.gain}
    for kind, factors in (('zero', form.numerator), ('pole', form.denominator)):
        for index, factor in enumerate(factors, start=1):
            label = f'{name}(z).{kind} {index}'
            if isinstance(factor, tuple):
                found |= {f'{label} b': factor[0], f'{label} c': factor[1]}
            else:
                found[label] = factor
    return found


def sampled_integrators(name: str) -> int:
    """Return how many poles G_c(z) of a printed controller has at z = 1."""
    poles = pulse_transfer_function(PRINTED_CONTROLLERS[name]).poles
    return int(np.count_nonzero(np.abs(poles - 1.0) < _AT_ONE))
