# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Curves of many runs, linear between their points and constant outside."""

from collections.abc import Sequence

import numpy as np

from ddct_bringup.batch.stacks import distinct

Curve = tuple[Sequence[float], Sequence[float]]
"""Abscissas and values of the points; none: a factor of 1 everywhere."""


class Curves:
    """A curve for each of R runs."""

    def __init__(self, curves: Sequence[Curve]) -> None:
        """Take the points of each run's curve."""
        first, places = distinct((tuple(xs), tuple(ys)) for xs, ys in curves)
        self._curves = [(np.array(curves[i][0]), np.array(curves[i][1])) for i in first]
        self._runs = [np.flatnonzero(places == place) for place in range(len(first))]
        self.constant = not any(xs.size for xs, _ in self._curves)
        """Whether no curve has points."""

    def at(self, x: np.ndarray) -> np.ndarray:
        """Return the value of each run's curve at its x, (R,)."""
        if len(self._curves) == 1:
            return _value(*self._curves[0], x)
        values = np.empty_like(x)
        for (xs, ys), runs in zip(self._curves, self._runs, strict=True):
            values[runs] = _value(xs, ys, x[runs])
        return values


def _value(xs: np.ndarray, ys: np.ndarray, x: np.ndarray) -> np.ndarray:
    return np.interp(x, xs, ys) if xs.size else np.ones_like(x)
