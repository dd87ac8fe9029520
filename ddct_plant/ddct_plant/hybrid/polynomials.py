# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Polynomials on an interval in Bernstein form: where one turns negative, and exact integrals.

A polynomial lies within the hull of its Bernstein coefficients. Without a negative coefficient it
is nowhere negative, so an interior extremum cannot be missed; with one change of sign among the
coefficients it has exactly one root.
"""

from collections.abc import Sequence
from functools import lru_cache
from math import comb

import numpy as np

ROUNDING = 2.0**-50
"""Coefficient that counts as zero, over the largest one."""
_STEPS = 200
"""Most steps of Newton's rule; bisection alone needs about 60."""


@lru_cache
def bernstein_of_powers(degree: int) -> np.ndarray:
    """Return the matrix (d+1, d+1) from coefficients of t^k to those of Bernstein on [0, 1]."""
    size = range(degree + 1)
    return np.array([[comb(j, k) / comb(degree, k) for k in size] for j in size])


@lru_cache
def _from_powers(degree: int) -> np.ndarray:
    """Return the matrix from rows of coefficients of t^k."""
    return bernstein_of_powers(degree).T.copy()


@lru_cache
def linear_weights(degree: int) -> np.ndarray:
    """Return the weights (2, d+1) of coefficients in the integrals of p (1 - t) and p t."""
    rising = np.arange(1.0, degree + 2.0) / ((degree + 1.0) * (degree + 2.0))
    return np.stack([rising[::-1], rising])


@lru_cache
def _left_half(degree: int) -> np.ndarray:
    size = range(degree + 1)
    return np.array([[comb(j, k) / 2.0**j for k in size] for j in size])


def on_interval(powers: np.ndarray, end: float) -> np.ndarray:
    """Return the Bernstein coefficients on [0, end] of polynomials (..., d+1) in t^k."""
    # Products, not numpy's power, whose rounding depends on the processor.
    ends = np.full(powers.shape[-1], end)
    ends[0] = 1.0
    return (powers * np.multiply.accumulate(ends)).dot(_from_powers(powers.shape[-1] - 1))


def first_negative(powers: np.ndarray, end: float) -> float | None:
    """Return the first t in [0, end] at which the polynomial (d+1,) becomes negative, or None."""
    coefficients = on_interval(powers, end)
    zero = ROUNDING * max(map(abs, coefficients.tolist()))
    pending = [(0.0, end, coefficients)]
    while pending:
        low, high, coefficients = pending.pop()
        negative = [coefficient < -zero for coefficient in coefficients.tolist()]
        if True not in negative:
            continue
        if negative[0]:
            return low
        if False not in negative[negative.index(True) :]:
            return _root(powers, low, high)
        left, middle = _left_half(len(powers) - 1), 0.5 * (low + high)
        pending.append((middle, high, (left @ coefficients[::-1])[::-1]))
        pending.append((low, middle, left @ coefficients))
    return None


def value_at(powers: Sequence[float], at: float) -> float:
    """Return the value at t = `at` of a polynomial with these coefficients of t^k."""
    value = 0.0
    for coefficient in reversed(powers):
        value = value * at + coefficient
    return value


def roots(powers: Sequence[float], end: float) -> list[float]:
    """
    Return where in (0, end) a polynomial with these coefficients of t^k may change its sign.

    `end` is at most 1. They are the real parts of all roots there: two equal ones may be complex
    by rounding.
    """
    if sum(map(abs, powers)) < 2.0 * abs(powers[0]):
        return []  # the first coefficient outweighs all others
    sizes = [abs(coefficient) * end**order for order, coefficient in enumerate(powers)]
    kept = [order for order, size in enumerate(sizes) if size > 2.0**-60 * max(sizes)]
    found = np.polynomial.polynomial.polyroots(powers[: max(kept, default=0) + 1])
    return [root.real for root in found.tolist() if 0.0 < root.real < end]


def _root(powers: np.ndarray, low: float, high: float) -> float:
    """Return the one root in [low, high], by Newton's rule kept within its bracket."""
    falling = powers[::-1].tolist()
    close = 2.0**-52 * high
    at = 0.5 * (low + high)
    for _ in range(_STEPS):
        value = slope = 0.0
        for coefficient in falling:
            slope = slope * at + value
            value = value * at + coefficient
        if value >= 0.0:
            low = at
        else:
            high = at
        following = at - value / slope if slope else low
        # Before the check of the bracket: at a root at its end the step is zero.
        if abs(following - at) <= close:
            break
        if not low < following < high:
            following = 0.5 * (low + high)
        at = following
    return min(max(following, low), high)
