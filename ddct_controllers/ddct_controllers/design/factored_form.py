"""Back from state space to the factored form that the thesis prints, in s or in z."""

import numpy as np
from scipy.linalg import eigvals

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.cascade import Factor
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace, discretise_zoh

_REAL = 1e-9
"""Imaginary part, relative to the magnitude, below which a root counts as real."""
_FAR = 1e8
"""Generalised eigenvalues beyond this, relative to the largest pole, are zeros at infinity."""


def factored_form(system: StateSpace) -> FactoredTransferFunction:
    """
    Return gain, zeros and poles of a system with one input and one output; nothing is cancelled.

    For a sampled system the variable is z: a number a stands for (z + a). The zeros are the finite
    generalised eigenvalues of [[a, b], [c, d]] and [[1, 0], [0, 0]]; the gain follows from the
    value at a point away from zeros and poles. Raise ParameterError for other sizes.
    """
    if system.d.shape != (1, 1):
        raise ParameterError('factored form: the system must have one input and one output')
    poles = np.linalg.eigvals(system.a)
    size = 1.0 + float(np.max(np.abs(poles), initial=0.0))
    zeros = _zeros(system, _FAR * size)
    point = 2.0 * max(size, float(np.max(np.abs(zeros), initial=0.0)))
    resolvent = np.linalg.solve(point * np.eye(len(system.a)) - system.a, system.b)
    value = float((system.c @ resolvent + system.d)[0, 0])
    gain = value * float((np.prod(point - poles) / np.prod(point - zeros)).real)
    return FactoredTransferFunction(gain, _factors(zeros), _factors(poles))


def pulse_transfer_function(controller: FactoredTransferFunction) -> FactoredTransferFunction:
    """
    Return the zero-order-hold equivalent at 10 ms, as the thesis's `c2d` gives it (Section 2.2.2).

    The variable of the result is z: a number a stands for (z + a), (b, c) for z^2 + b z + c.
    """
    return factored_form(discretise_zoh(controller.to_state_space(), PERIOD_S))


def _zeros(system: StateSpace, far: float) -> np.ndarray:
    pencil = np.block([[system.a, system.b], [system.c, system.d]])
    mass = np.zeros_like(pencil)
    mass[: len(system.a), : len(system.a)] = np.eye(len(system.a))
    with np.errstate(divide='ignore', invalid='ignore'):
        found = eigvals(pencil, mass)
    return found[np.isfinite(found) & (np.abs(found) < far)]


def _factors(roots: np.ndarray) -> tuple[Factor, ...]:
    """Return real roots as numbers a, slow to fast, then pairs as (b, c) in the same order."""
    real = np.abs(roots.imag) <= _REAL * np.abs(roots)
    singles = sorted(0.0 - roots[real].real, key=abs)
    upper = sorted(roots[~real & (roots.imag > 0.0)], key=abs)
    return (
        *(float(a) for a in singles),
        *((float(-2.0 * root.real), float(abs(root) ** 2)) for root in upper),
    )
