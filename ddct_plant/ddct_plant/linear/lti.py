# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Linear time-invariant systems: two forms, and exact discretisation over a sampling period."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from ddct_plant.base.errors import ParameterError, require_number
from ddct_plant.linear.cascade import Factor, realise_cascade
from ddct_plant.linear.exponentials import exponentials

_REAL = 1e-9
"""Imaginary part, relative to the magnitude, below which a root counts as real."""
_PAIRED = 1e-6
"""Largest distance of a root from the conjugate of another, relative to the magnitude."""


@dataclass(frozen=True, eq=False)
class StateSpace:
    """
    dx/dt = a x + b u, y = c x + d u; with `period_s`, x_(k+1) = a x_k + b u_k instead.

    n states, m inputs, p outputs; the arrays are copied and cannot be written.
    """

    a: np.ndarray
    """State matrix, (n, n)."""
    b: np.ndarray
    """Input matrix, (n, m)."""
    c: np.ndarray
    """Output matrix, (p, n)."""
    d: np.ndarray
    """Feedthrough matrix, (p, m)."""
    period_s: float | None = None
    """Sampling period of a discrete system in s, None for a continuous one."""

    def __post_init__(self) -> None:
        """Check the shapes and that all is finite; raise ParameterError otherwise."""
        own_matrices(self, 'state space', a='nn', b='nm', c='pn', d='pm')


def own_matrices(owner: object, what: str, **letters: str) -> None:
    """
    Copy the matrices of `owner`, called `what`, so that they cannot be written.

    `letters` are names of the numbers of rows and columns of each matrix; equal letters must have
    equal numbers. Raise ParameterError otherwise, and for values that are no matrix of finite
    numbers.
    """
    sizes: dict[str, int] = {}
    for name, rows_and_columns in letters.items():
        matrix = np.array(getattr(owner, name), dtype=float)
        if matrix.ndim != 2 or not np.all(np.isfinite(matrix)):
            raise ParameterError(f'{what}: {name} must be a matrix of finite numbers')
        pairs = zip(rows_and_columns, matrix.shape, strict=True)
        shape = tuple(sizes.setdefault(letter, size) for letter, size in pairs)
        if matrix.shape != shape:
            raise ParameterError(f'{what}: {name} is {matrix.shape}, it must be {shape}')
        matrix.setflags(write=False)
        object.__setattr__(owner, name, matrix)


@dataclass(frozen=True)
class FactoredTransferFunction:
    """
    gain times a product of (s + a) and (s^2 + b s + c), over another: the form the thesis prints.

    A number a in `numerator` or `denominator` stands for (s + a), a pair (b, c) for
    (s^2 + b s + c); so 0.0 is the factor s.
    """

    gain: float
    """Gain of the product."""
    numerator: tuple[Factor, ...] = field(default=())
    """Factors of the numerator."""
    denominator: tuple[Factor, ...] = field(default=())
    """Factors of the denominator."""

    def __post_init__(self) -> None:
        """Check that every number is finite; raise ParameterError otherwise."""
        require_number('transfer function: gain', self.gain)
        for factor in (*self.numerator, *self.denominator):
            for number in factor if isinstance(factor, tuple) else (factor,):
                require_number('transfer function: a coefficient', number)

    @classmethod
    def from_roots(
        cls, gain: float, zeros: ArrayLike, poles: ArrayLike
    ) -> 'FactoredTransferFunction':
        """
        Return gain times a product of (s - zero), over that of (s - pole), all complex, in rad/s.

        Raise ParameterError for a complex root whose conjugate is not there too.
        """
        return cls(gain, _factors('zeros', zeros), _factors('poles', poles))

    @classmethod
    def from_polynomials(
        cls, numerator: ArrayLike, denominator: ArrayLike
    ) -> 'FactoredTransferFunction':
        """
        Return a ratio of polynomials, each with its highest power first.

        Raise ParameterError for one of zeros alone, or whose roots cannot be computed.
        """
        sides = {'numerator': numerator, 'denominator': denominator}
        num, den = (np.trim_zeros(np.asarray(side, dtype=float), 'f') for side in sides.values())
        for name, side in zip(sides, (num, den), strict=True):
            if not len(side):
                raise ParameterError(f'transfer function: its {name} is zero')
        try:
            with np.errstate(over='ignore', invalid='ignore'):
                return cls.from_roots(float(num[0] / den[0]), np.roots(num), np.roots(den))
        except np.linalg.LinAlgError as error:
            raise ParameterError(
                'transfer function: its coefficients are too far apart to have roots'
            ) from error

    @property
    def zeros(self) -> np.ndarray:
        """Zeros in rad/s, complex, (number of zeros,)."""
        return _roots(self.numerator)

    @property
    def poles(self) -> np.ndarray:
        """Poles in rad/s, complex, (number of poles,)."""
        return _roots(self.denominator)

    def __mul__(self, other: 'FactoredTransferFunction') -> 'FactoredTransferFunction':
        """Return the product with every factor of both; none is cancelled."""
        return FactoredTransferFunction(
            self.gain * other.gain,
            self.numerator + other.numerator,
            self.denominator + other.denominator,
        )

    def faster(self, factor: float) -> 'FactoredTransferFunction':
        """Return G(s / factor), which is `factor` times as fast."""
        excess = len(self.poles) - len(self.zeros)
        sides = (
            tuple(
                (f[0] * factor, f[1] * factor**2) if isinstance(f, tuple) else f * factor
                for f in side
            )
            for side in (self.numerator, self.denominator)
        )
        return FactoredTransferFunction(self.gain * factor**excess, *sides)

    def at(self, s: np.ndarray) -> np.ndarray:
        """Return the complex value, the shape of `s`, at points of the complex plane in rad/s."""
        s = np.asarray(s, dtype=complex)
        return self.gain * _product(self.numerator, s) / _product(self.denominator, s)

    def frequency_response(self, omega: ArrayLike) -> np.ndarray:
        """Return the complex response, the shape of `omega`, at frequencies in rad/s."""
        return self.at(1j * np.asarray(omega, dtype=float))

    def to_state_space(self) -> StateSpace:
        """Return a real cascade realisation; raise ParameterError when it is not proper."""
        return StateSpace(*realise_cascade(self.gain, self.numerator, self.denominator))


def _product(factors: Sequence[Factor], s: np.ndarray) -> np.ndarray:
    product = np.ones_like(s)
    for factor in factors:
        if isinstance(factor, tuple):
            product = product * (s * s + factor[0] * s + factor[1])
        else:
            product = product * (s + factor)
    return product


def _factors(name: str, roots: ArrayLike) -> tuple[Factor, ...]:
    """Return real roots as numbers a, slow to fast, then pairs as (b, c) in the same order."""
    roots = np.asarray(roots, dtype=complex)
    real = np.abs(roots.imag) <= _REAL * np.abs(roots)
    singles = sorted(0.0 - roots[real].real, key=abs)
    upper = sorted(roots[~real & (roots.imag > 0.0)], key=abs)
    lower = roots[~real & (roots.imag < 0.0)]
    far = [root for root in upper if np.all(np.abs(lower.conj() - root) > _PAIRED * abs(root))]
    if far or len(upper) != len(lower):
        raise ParameterError(
            f'transfer function: its {name} {roots.tolist()} are not in conjugate pairs'
        )
    return (
        *(float(a) for a in singles),
        *((float(-2.0 * root.real), float(abs(root) ** 2)) for root in upper),
    )


def _roots(factors: Sequence[Factor]) -> np.ndarray:
    roots = [np.roots((1.0, *f)) if isinstance(f, tuple) else np.array([-f]) for f in factors]
    return np.concatenate([np.zeros(0, dtype=complex), *roots])


def discretise_zoh(system: StateSpace, period_s: float) -> StateSpace:
    """
    Return the exact sampled system for inputs held over each period of `period_s` seconds.

    exp([[a, b], [0, 0]] T) = [[a_d, b_d], [0, 1]].
    """
    if system.period_s is not None:
        raise ParameterError(f'state space is already sampled at {system.period_s:g} s')
    require_number('period_s', period_s, above=0.0)
    a_d, b_d = hold_inputs(system.a, system.b, period_s)
    return StateSpace(a_d, b_d, system.c, system.d, period_s)


def hold_inputs(a: np.ndarray, b: np.ndarray, period_s: float) -> tuple[np.ndarray, np.ndarray]:
    """Return a_d and b_d of `discretise_zoh`; a (..., n, n) and b (..., n, m) may be stacks."""
    states, inputs = b.shape[-2:]
    block = np.zeros((*a.shape[:-2], states + inputs, states + inputs))
    block[..., :states, :states], block[..., :states, states:] = a, b
    transition = _exponential(block * period_s)[..., :states, :]
    return transition[..., :states], transition[..., states:]


def lift_piecewise_linear(
    a: np.ndarray, b: np.ndarray, period_s: float, intervals: int
) -> tuple[np.ndarray, np.ndarray]:
    """
    Return a_d (n, n) and gamma (n, intervals + 1), so that x_(k+1) = a_d x_k + gamma @ nodes.

    `b` is the column of one input, (n,) or (n, 1); `nodes` are its values at the ends of
    `intervals` equal parts of the period, between which it is linear. Exact: over one part of
    length h, u(t) = u_0 + (u_1 - u_0) t / h makes (x, u, u_1 - u_0) an autonomous linear system.
    Of stacks, a (..., n, n) and b (..., n, 1), both results are stacks.
    """
    require_number('intervals', intervals, at_least=1)
    require_number('period_s', period_s, above=0.0)
    stack, states = a.shape[:-2], a.shape[-1]
    part_s = period_s / intervals
    block = np.zeros((*stack, states + 2, states + 2))
    block[..., :states, :states] = a
    block[..., :states, states] = np.reshape(b, (*stack, states))
    block[..., states, states + 1] = 1.0 / part_s
    transition = _exponential(block * part_s)[..., :states, :]
    step, level, change = transition[..., :states], transition[..., -2], transition[..., -1]
    a_d, gamma = np.eye(states), np.zeros((*stack, states, intervals + 1))
    for part in reversed(range(intervals)):
        gamma[..., part : part + 2] += a_d @ np.stack([level - change, change], axis=-1)
        a_d = a_d @ step
    return a_d, gamma


def lift_zoh_dense(
    system: StateSpace, period_s: float, intervals: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """
    Return a_d, b_d and the outputs within a period for an input u held over it.

    x_(k+1) = a_d x_k + b_d u; the outputs at i period_s / intervals, i = 0..intervals, stacked
    node after node, are outputs @ x_k + feedthrough @ u with outputs (nodes p, n) and feedthrough
    (nodes p, m), nodes = intervals + 1. Node 0 has the input of this period already.
    """
    require_number('intervals', intervals, at_least=1)
    part = discretise_zoh(system, period_s / intervals)
    a_d, b_d = np.eye(len(part.a)), np.zeros(part.b.shape)
    outputs, feedthrough = [system.c], [system.d]
    for _ in range(intervals):
        b_d = b_d + a_d @ part.b
        a_d = a_d @ part.a
        outputs.append(system.c @ a_d)
        feedthrough.append(system.c @ b_d + system.d)
    return a_d, b_d, np.vstack(outputs), np.vstack(feedthrough)


def _exponential(matrix: np.ndarray) -> np.ndarray:
    if matrix.ndim > 2:
        return exponentials(matrix)
    # Only here: most of the graph's nodes do without scipy, whose import would double their start.
    from scipy.linalg import expm

    return expm(matrix)
