# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Single-input, single-output state-space systems: series, feedback, response, factored form.

They are ours because run-time controllers are designed and verified with them: python-control
takes a second to load, and its realisation of factors through polynomials is off by percents.
"""

from collections.abc import Sequence

import numpy as np
import scipy

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.cascade import Factor
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace
from ddct_plant.linear.sampling import discretise_zoh

_FAR = 1e8
"""
Magnitude of an eigenvalue, relative to the largest pole, beyond which it is a zero at infinity.
"""


def series(*systems: StateSpace) -> StateSpace:
    """
    Return the product of systems in the order of the signal, the first one first.

    Its states are theirs in the same order. Raise ParameterError when the sampling periods
    differ.
    """
    product = systems[0]
    for system in systems[1:]:
        if product.period_s != system.period_s:
            raise ParameterError(
                f'series: sampling periods {product.period_s} and {system.period_s} s differ: '
                'discretise both alike'
            )
        corner = np.zeros((len(product.a), len(system.a)))
        product = StateSpace(
            np.block([[product.a, corner], [system.b @ product.c, system.a]]),
            np.vstack([product.b, system.b @ product.d]),
            np.hstack([system.d @ product.c, system.c]),
            system.d @ product.d,
            product.period_s,
        )
    return product


def scaled(system: StateSpace, gain: float) -> StateSpace:
    """Return the system with its output multiplied by `gain`."""
    return StateSpace(system.a, system.b, gain * system.c, gain * system.d, system.period_s)


def close_loop(loop: StateSpace) -> StateSpace:
    """
    Return T = L/(1 + L), the loop closed by unit negative feedback, with the states of L.

    Raise ParameterError when 1 + D is zero: such a loop has no solution.
    """
    _require_one_by_one(loop)
    through = 1.0 + float(loop.d[0, 0])
    if through == 0.0:
        raise ParameterError('loop: its feedthrough is -1: the feedback has no solution')
    a = loop.a - loop.b @ loop.c / through
    return StateSpace(a, loop.b / through, loop.c / through, loop.d / through, loop.period_s)


def frequency_response(system: StateSpace, omega: np.ndarray) -> np.ndarray:
    """
    Return the complex response, the shape of `omega`, at frequencies in rad/s.

    It is evaluated at s = j omega, or at z = exp(j omega T) when the system is sampled.
    """
    _require_one_by_one(system)
    omega = np.asarray(omega, dtype=float)
    variable = 1j * omega if system.period_s is None else np.exp(1j * omega * system.period_s)
    resolvent = variable.reshape(-1, 1, 1) * np.eye(len(system.a)) - system.a
    states = np.linalg.solve(resolvent, system.b)
    return ((system.c @ states)[:, 0, 0] + system.d[0, 0]).reshape(omega.shape)


def poles_rad_s(system: StateSpace) -> np.ndarray:
    """Return the poles, (n,) complex, in rad/s, those of a sampled system by `to_s_plane`."""
    return to_s_plane(np.linalg.eigvals(system.a), system.period_s)


def to_s_plane(poles: np.ndarray, period_s: float | None) -> np.ndarray:
    """
    Return s = log(z)/T in rad/s of sampled poles, elementwise; continuous ones unchanged.

    The imaginary part is within half the sampling rate; z = 0, a delay, gives minus infinity.
    """
    poles = np.asarray(poles, dtype=complex)
    if period_s is None:
        return poles
    rates = np.full(poles.shape, -np.inf, dtype=complex)
    rates[poles != 0.0] = np.log(poles[poles != 0.0]) / period_s
    return rates


def factored_form(system: StateSpace) -> FactoredTransferFunction:
    """
    Return gain, zeros and poles of a system with one input and one output; nothing is cancelled.

    For a sampled system the variable is z: a number a stands for (z + a). The zeros are the finite
    generalised eigenvalues of [[a, b], [c, d]] and [[1, 0], [0, 0]]; the gain follows from the
    value at a point away from zeros and poles. Raise ParameterError for other sizes.
    """
    _require_one_by_one(system)
    poles = np.linalg.eigvals(system.a)
    size = 1.0 + float(np.max(np.abs(poles), initial=0.0))
    pencil = np.block([[system.a, system.b], [system.c, system.d]])
    mass = scipy.linalg.block_diag(np.eye(len(system.a)), 0.0)
    with np.errstate(divide='ignore', invalid='ignore'):
        zeros = scipy.linalg.eigvals(pencil, mass)
    zeros = zeros[np.isfinite(zeros) & (np.abs(zeros) < _FAR * size)]
    point = 2.0 * max(size, float(np.max(np.abs(zeros), initial=0.0)))
    resolvent = np.linalg.solve(point * np.eye(len(system.a)) - system.a, system.b)
    value = float((system.c @ resolvent + system.d)[0, 0])
    gain = value * float((np.prod(point - poles) / np.prod(point - zeros)).real)
    return FactoredTransferFunction.from_roots(gain, zeros, poles)


def factors_text(factors: Sequence[Factor], variable: str = 's', digits: int = 4) -> str:
    """Return factors side by side, as the thesis prints them, which is with 4 digits."""
    return ' '.join(_factor_text(factor, variable, digits) for factor in factors)


def _factor_text(factor: Factor, variable: str, digits: int) -> str:
    if factor == 0.0:
        return variable
    numbers = factor if isinstance(factor, tuple) else (factor,)
    signed = [f'{"-" if x < 0.0 else "+"} {abs(x):.{digits}g}' for x in numbers]
    if len(signed) == 1:
        return f'({variable} {signed[0]})'
    return f'({variable}^2 {signed[0]} {variable} {signed[1]})'


def pulse_transfer_function(controller: FactoredTransferFunction) -> FactoredTransferFunction:
    """
    Return the zero-order-hold equivalent at 10 ms, as the thesis's `c2d` gives it (Section 2.2.2).

    The variable of the result is z: a number a stands for (z + a), (b, c) for z^2 + b z + c.
    """
    return factored_form(discretise_zoh(controller.to_state_space(), PERIOD_S))


def _require_one_by_one(system: StateSpace) -> None:
    if system.d.shape != (1, 1):
        raise ParameterError(
            f'state space: it has {system.d.shape[1]} inputs and {system.d.shape[0]} outputs, '
            'it must have one of each'
        )
