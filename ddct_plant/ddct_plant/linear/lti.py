# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Linear time-invariant systems in two forms: state space, and factored transfer function."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from ddct_plant.base.errors import ParameterError, require_number
from ddct_plant.linear.cascade import Factor, realise_cascade

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
            raise ParameterError(f'{what}: {name} must be a matrix of finite numbers', key=name)
        pairs = zip(rows_and_columns, matrix.shape, strict=True)
        shape = tuple(sizes.setdefault(letter, size) for letter, size in pairs)
        if matrix.shape != shape:
            raise ParameterError(f'{what}: {name} is {matrix.shape}, it must be {shape}', key=name)
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
            f'transfer function: its {name} {roots.tolist()} are not in conjugate pairs', key=name
        )
    return (
        *(float(a) for a in singles),
        *((float(-2.0 * root.real), float(abs(root) ** 2)) for root in upper),
    )


def _roots(factors: Sequence[Factor]) -> np.ndarray:
    roots = [np.roots((1.0, *f)) if isinstance(f, tuple) else np.array([-f]) for f in factors]
    return np.concatenate([np.zeros(0, dtype=complex), *roots])
