# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Real state-space realisation of a factored transfer function as a cascade of small sections."""

import math
from collections.abc import Sequence

import numpy as np

from ddct_plant.base.errors import ParameterError
from ddct_plant.linear.assignment import least_cost_columns

Factor = float | tuple[float, float]
"""Factor of a transfer function: a number a is (s + a), a pair (b, c) is (s^2 + b s + c)."""
_Polynomial = tuple[float, ...]
_LOWEST_FREQUENCY = 1e-6
"""Least frequency in rad/s of a factor when sections are paired; slower ones count as equal."""


def realise_cascade(
    gain: float, numerator: Sequence[Factor], denominator: Sequence[Factor]
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """
    Return a (n, n), b (n, 1), c (1, n), d (1, 1) of a proper factored transfer function.

    No polynomial above second order is formed. Quadratic factors stay whole; real factors are
    joined two by two in order of magnitude, the largest left alone when their number is odd.
    Each numerator section then goes to the denominator section nearest in frequency (least sum
    of log distances, never a section of lower order). Sections run from slow to fast, the gain
    comes last. Raise ParameterError when there are more zeros than poles.
    """
    zeros, poles = _sections(numerator), _sections(denominator)
    if _order(zeros) > _order(poles):
        raise ParameterError(
            f'transfer function has {_order(zeros)} zeros and {_order(poles)} poles: '
            'only a proper one has a state-space form',
            key='zeros',
        )
    a, b, c, d = np.zeros((0, 0)), np.zeros((0, 1)), np.zeros((1, 0)), np.ones((1, 1))
    for zero, pole in _paired(zeros, poles):
        section_a, section_b, section_c, section_d = _realise_section(zero, pole)
        corner = np.zeros((len(a), len(section_a)))
        a = np.block([[a, corner], [section_b @ c, section_a]])
        b = np.vstack([b, section_b @ d])
        c = np.hstack([section_d @ c, section_c])
        d = section_d @ d
    return a, b, gain * c, gain * d


def _sections(factors: Sequence[Factor]) -> list[_Polynomial]:
    """Return monic polynomials of order 1 or 2 (highest power first), slow to fast."""
    real = sorted((factor for factor in factors if not isinstance(factor, tuple)), key=abs)
    sections: list[_Polynomial] = [(1.0, *f) for f in factors if isinstance(f, tuple)]
    for first, second in zip(real[0::2], real[1::2], strict=False):
        sections.append((1.0, first + second, first * second))
    if len(real) % 2:
        sections.append((1.0, real[-1]))
    return sorted(sections, key=_frequency)


def _order(sections: Sequence[_Polynomial]) -> int:
    return sum(len(section) - 1 for section in sections)


def _frequency(section: _Polynomial) -> float:
    """Return the geometric mean of the root magnitudes in rad/s."""
    return max(abs(section[-1]) ** (1.0 / (len(section) - 1)), _LOWEST_FREQUENCY)


def _paired(
    zeros: Sequence[_Polynomial], poles: Sequence[_Polynomial]
) -> list[tuple[_Polynomial, _Polynomial]]:
    forbidden = 1e6
    distances = [
        [
            abs(math.log(_frequency(zero) / _frequency(pole)))
            if len(zero) <= len(pole)
            else forbidden
            for pole in poles
        ]
        for zero in zeros
    ]
    chosen = dict(zip(least_cost_columns(distances), zeros, strict=True))
    return [(chosen.get(index, (1.0,)), pole) for index, pole in enumerate(poles)]


def _realise_section(
    zero: _Polynomial, pole: _Polynomial
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return a, b, c, d of one section; second-order states are scaled by their frequency."""
    order = len(pole) - 1
    zero = (0.0,) * (len(pole) - len(zero)) + tuple(zero)
    through = zero[0]
    rest = [top - through * bottom for top, bottom in zip(zero[1:], pole[1:], strict=True)]
    if order == 1:
        a, b, c = [[-pole[1]]], [[1.0]], [rest]
    else:
        scale = math.sqrt(abs(pole[2])) or abs(pole[1]) or 1.0
        a = [[0.0, scale], [-pole[2] / scale, -pole[1]]]
        b, c = [[0.0], [1.0]], [[rest[1] / scale, rest[0]]]
    return np.array(a), np.array(b), np.array(c), np.array([[through]])
