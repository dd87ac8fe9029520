"""
Single-input, single-output state-space systems: series, feedback, response, factored form.

They are ours because run-time controllers are designed and verified with them: python-control
takes a second to load, and its realisation of factors through polynomials is off by percents.
"""

from typing import Any

import numpy as np
import scipy

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace, discretise_zoh

_FAR = 1e8
"""Generalised eigenvalues beyond this, relative to the largest pole, are zeros at infinity."""


def series(*systems: StateSpace) -> StateSpace:
    """
    Return the product of systems in the order of the signal, the first one first.

    Its states are theirs in the same order. Raise ParameterError when the sampling periods
    differ.
    """
    product = systems[0]
    for system in systems[1:]:
        product = _after(product, system)
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

    That is at s = j omega, or at z = exp(j omega T) when the system is sampled.
    """
    _require_one_by_one(system)
    omega = np.asarray(omega, dtype=float)
    variable = 1j * omega if system.period_s is None else np.exp(1j * omega * system.period_s)
    resolvent = variable.reshape(-1, 1, 1) * np.eye(len(system.a)) - system.a
    states = np.linalg.solve(resolvent, np.broadcast_to(system.b, (omega.size, *system.b.shape)))
    return ((system.c @ states)[:, 0, 0] + system.d[0, 0]).reshape(omega.shape)


def to_control(system: StateSpace) -> Any:
    """Return the system as python-control's StateSpace."""
    # Only here: see above.
    import control

    return control.ss(system.a, system.b, system.c, system.d, dt=system.period_s or 0)


def poles_rad_s(system: StateSpace) -> np.ndarray:
    """Return the poles, (n,) complex, in rad/s; those of a sampled system as `to_s_plane` does."""
    return to_s_plane(np.linalg.eigvals(system.a), system.period_s)


def to_s_plane(poles: np.ndarray, period_s: float | None) -> np.ndarray:
    """
    Return s = log(z)/T in rad/s of sampled poles, elementwise; continuous ones as they are.

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
    zeros = _zeros(system, _FAR * size)
    point = 2.0 * max(size, float(np.max(np.abs(zeros), initial=0.0)))
    resolvent = np.linalg.solve(point * np.eye(len(system.a)) - system.a, system.b)
    value = float((system.c @ resolvent + system.d)[0, 0])
    gain = value * float((np.prod(point - poles) / np.prod(point - zeros)).real)
    return FactoredTransferFunction.from_roots(gain, zeros, poles)


def pulse_transfer_function(controller: FactoredTransferFunction) -> FactoredTransferFunction:
    """
    Return the zero-order-hold equivalent at 10 ms, as the thesis's `c2d` gives it (Section 2.2.2).

    The variable of the result is z: a number a stands for (z + a), (b, c) for z^2 + b z + c.
    """
    return factored_form(discretise_zoh(controller.to_state_space(), PERIOD_S))


def _after(first: StateSpace, second: StateSpace) -> StateSpace:
    if first.period_s != second.period_s:
        raise ParameterError(
            f'series: sampling periods {first.period_s} and {second.period_s} s differ: '
            'discretise both alike'
        )
    corner = np.zeros((len(first.a), len(second.a)))
    return StateSpace(
        np.block([[first.a, corner], [second.b @ first.c, second.a]]),
        np.vstack([first.b, second.b @ first.d]),
        np.hstack([second.d @ first.c, second.c]),
        second.d @ first.d,
        first.period_s,
    )


def _require_one_by_one(system: StateSpace) -> None:
    if system.d.shape != (1, 1):
        raise ParameterError(
            f'state space: it has {system.d.shape[1]} inputs and {system.d.shape[0]} outputs, '
            'it must have one of each'
        )


def _zeros(system: StateSpace, far: float) -> np.ndarray:
    pencil = np.block([[system.a, system.b], [system.c, system.d]])
    mass = np.zeros_like(pencil)
    mass[: len(system.a), : len(system.a)] = np.eye(len(system.a))
    with np.errstate(divide='ignore', invalid='ignore'):
        found = scipy.linalg.eigvals(pencil, mass)
    return found[np.isfinite(found) & (np.abs(found) < far)]
