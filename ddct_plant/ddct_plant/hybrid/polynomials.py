# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Polynomials by their coefficients of t^k: values, integrals, and where the sign changes."""

from collections.abc import Iterator, Sequence

ROUNDING = 2.0**-50
"""Value that counts as zero, over the largest coefficient."""
_STEPS = 200
"""Most steps of Newton's rule; bisection alone needs about 60."""


def value_at(powers: Sequence[float], at: float) -> float:
    """Return the value at t = `at` of a polynomial with these coefficients of t^k."""
    value = 0.0
    for coefficient in reversed(powers):
        value = value * at + coefficient
    return value


def integral_with(powers: Sequence[float], line: tuple[float, float], end: float) -> float:
    """Return the integral over t from 0 to `end` of a polynomial times line[0] + line[1] t."""
    constant = rising = 0.0
    for order in range(len(powers), 0, -1):
        constant = constant * end + powers[order - 1] / order
        rising = rising * end + powers[order - 1] / (order + 1)
    return end * (line[0] * constant + line[1] * end * rising)


def first_negative(powers: Sequence[float], nodes: Sequence[float]) -> float | None:
    """
    Return the first t from 0 to the last of `nodes` at which the value becomes negative, or None.

    A constant never does. The nodes are those of `sign_changes`.
    """
    if len(powers) < 2:
        return None
    return 0.0 if _negative(powers[0], powers) else next(sign_changes(powers, nodes), None)


def sign_changes(powers: Sequence[float], nodes: Sequence[float]) -> Iterator[float]:
    """
    Yield each t from 0 to the last of `nodes` at which the value becomes negative or ceases to be.

    The nodes are so close that the slope changes its sign at most once from one to the next. So a
    value with the same sign at two of them changes it between them only if it goes towards zero at
    the first and away from it at the second: then it is checked at its extremum too.
    """
    low, negative, slope = 0.0, _negative(powers[0], powers), powers[1]
    for high in nodes:
        before, towards, side = negative, slope, -1.0 if negative else 1.0
        value, slope = _value_and_slope(powers, high)
        negative = _negative(value, powers)
        if negative != before:
            yield _sign_change(powers, before, low, high)
        elif side * towards < 0.0 < side * slope:
            slopes = [order * powers[order] for order in range(1, len(powers))]
            extremum = _sign_change(slopes, not before, low, high)
            if _negative(value_at(powers, extremum), powers) != before:
                yield _sign_change(powers, before, low, extremum)
                yield _sign_change(powers, not before, extremum, high)
        low = high


def _sign_change(powers: Sequence[float], negative: bool, low: float, high: float) -> float:
    """Return where a value that is `negative` at `low` and not at `high` changes, by Newton."""
    close = 2.0**-52 * high
    at = 0.5 * (low + high)
    for _ in range(_STEPS):
        value, slope = _value_and_slope(powers, at)
        if (value < 0.0) == negative:
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


def _negative(value: float, powers: Sequence[float]) -> bool:
    return value < 0.0 and value < -ROUNDING * max(map(abs, powers))


def _value_and_slope(powers: Sequence[float], at: float) -> tuple[float, float]:
    value = slope = 0.0
    for coefficient in reversed(powers):
        slope = slope * at + value
        value = value * at + coefficient
    return value, slope
