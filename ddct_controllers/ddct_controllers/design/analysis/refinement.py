# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Zeros and maxima of a real function in several intervals at once, from the values on a grid."""

from collections.abc import Callable

import numpy as np

Function = Callable[[np.ndarray], np.ndarray]
"""Real function of places in k intervals, elementwise, (..., k) to (..., k)."""
_MOST_STEPS = 60
_RELATIVE = 1e-12
"""Relative change of a zero below which it is found."""
_PARTS = 16
"""Number of parts of an interval of which the two beside the highest point are kept."""
_NARROW = 1e-7
"""Width of an interval, relative to its lower end, at which its maximum is found."""


def zeros(
    function: Function, low: np.ndarray, high: np.ndarray, at_low: np.ndarray, at_high: np.ndarray
) -> np.ndarray:
    """
    Return a zero (k,) in each of k intervals with values of opposite signs at their ends.

    By the method of Ridders (IEEE Trans. Circuits Syst. 26(11), 1979). A value of 0 counts as
    negative.
    """
    point, every = low, np.arange(low.size)
    for _ in range(_MOST_STEPS if low.size else 0):
        middle = 0.5 * (low + high)
        at_middle = function(middle)
        spread = np.sqrt(at_middle**2 - at_low * at_high)
        share = np.divide(at_middle, spread, out=np.zeros_like(spread), where=spread > 0.0)
        before, point = point, middle + (middle - low) * np.where(at_low > 0.0, share, -share)
        at_point = function(point)
        if np.all(np.abs(point - before) <= _RELATIVE * np.abs(point)):
            break
        places = np.stack([low, middle, point, high])
        values = np.stack([at_low, at_middle, at_point, at_high])
        order = np.argsort(places, axis=0, kind='stable')
        places, values = places[order, every], values[order, every]
        first = np.argmax((values[1:] > 0.0) != (values[0] > 0.0), axis=0)
        low, high = places[first, every], places[first + 1, every]
        at_low, at_high = values[first, every], values[first + 1, every]
    return point


def maxima(function: Function, low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the place and the value, both (k,), of the one maximum in each of k intervals."""
    places, values, every = low, function(low), np.arange(low.size)
    while np.any(high - low > _NARROW * np.abs(low)):
        points = np.linspace(low, high, _PARTS + 1)
        found = function(points)
        best = np.argmax(found, axis=0)
        places, values = points[best, every], found[best, every]
        low = points[np.maximum(best - 1, 0), every]
        high = points[np.minimum(best + 1, _PARTS), every]
    return places, values
