# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Steps of the predictor-corrector method of Mehrotra (SIAM J. Optim. 2, 1992)."""

import numpy as np

from ddct_bringup.floor.program.linear_program import LinearProgram
from ddct_bringup.floor.program.newton import Iterate, Newton, weighted_square

LEAST_COST = 1e-2
"""Cost below which gaps are shares of this number."""
_TO_EDGE = 0.995
"""Share of the way to the edge of the interior that a step goes."""
_EDGE, _WIDE = 0.05, 1e3
"""Distance of the first point to the edges of its box, as a share of its width, at most this."""


class Mehrotra:
    """The steps of the method for rows x + s = limits, equal_rows x = equal_values in a box."""

    def __init__(self, program: LinearProgram) -> None:
        """Take a program whose boxes all have a width."""
        self._program = program
        self._row_scale = _largest(program.rows, program.limits)
        self._equal_scale = _largest(program.equal_rows, program.equal_values)
        self._width = program.high - program.low
        self._count = len(program.limits) + 2 * len(program.cost)

    def first(self) -> Iterate:
        """Return a point inside of the box, near all rows in least squares."""
        p = self._program
        weights = self._row_scale**-2
        edge = _EDGE * np.minimum(self._width, _WIDE)
        # The middle of the box counts a little, where the rows leave a variable free.
        pull = 1e-3 / np.minimum(self._width, _WIDE) ** 2
        middle = p.low + np.minimum(self._width, _WIDE) / 2.0
        normal = weighted_square(p, weights) + np.diag(pull)
        x = np.linalg.solve(normal, p.combined(weights * p.limits) + pull * middle)
        x = np.clip(x, p.low + edge, p.high - edge)
        distance = p.limits - p.times(x)
        s = (
            np.maximum(distance, 0.1 * np.abs(distance).mean() + 1e-3)
            if len(distance)
            else distance
        )
        cost = np.abs(p.cost) @ np.minimum(self._width, np.abs(x) + 1.0)
        mean = max(float(cost), LEAST_COST) / self._count
        return Iterate(
            x, s, np.zeros(len(p.equal_values)), mean / s, mean / (x - p.low), mean / (p.high - x)
        )

    def violation(self, now: Iterate) -> float:
        """Return the largest violation of a row or equation as a share of its largest number."""
        _, primal, equal = self._residuals(now)
        return max(
            float(np.max(np.abs(primal) / self._row_scale, initial=0.0)),
            float(np.max(np.abs(equal) / self._equal_scale, initial=0.0)),
        )

    def products(self, now: Iterate) -> float:
        """Return the sum of the products of distances and multipliers; zero at an optimum."""
        return sum(float(each.sum()) for each in self._products(now))

    @np.errstate(divide='raise', invalid='raise', over='raise')
    def next(self, now: Iterate) -> Iterate:
        """
        Return the next iterate.

        Raise LinAlgError or FloatingPointError where rounding no longer allows one.
        """
        solver = Newton(self._program, now, *self._residuals(now))
        products = self._products(now)
        mean = self.products(now) / self._count
        predicted = solver.direction([-each for each in products], refined=False)
        share = self.products(self._moved(now, predicted, 1.0)) / self._count / mean
        second = (
            predicted.s * predicted.rows,
            predicted.x * predicted.low,
            -predicted.x * predicted.high,
        )
        wanted = [
            mean * share**3 - each - more for each, more in zip(products, second, strict=True)
        ]
        return self._moved(now, solver.direction(wanted), _TO_EDGE)

    def _residuals(self, now: Iterate) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return what the stationarity, the rows and the equations are off by."""
        p = self._program
        dual = p.cost + p.combined(now.rows) + now.equal @ p.equal_rows - now.low + now.high
        return dual, p.times(now.x) + now.s - p.limits, p.equal_rows @ now.x - p.equal_values

    def _products(self, now: Iterate) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the products of distances and multipliers of rows, lower and upper edges."""
        p = self._program
        return now.s * now.rows, (now.x - p.low) * now.low, (p.high - now.x) * now.high

    def _moved(self, now: Iterate, by: Iterate, share: float) -> Iterate:
        """Return the iterate moved by `share` of the way to the edge, at most the whole way."""
        p = self._program
        primal = min(
            _way(now.s, by.s), _way(now.x - p.low, by.x), _way(p.high - now.x, -by.x), 1.0 / share
        )
        dual = min(
            _way(now.rows, by.rows), _way(now.low, by.low), _way(now.high, by.high), 1.0 / share
        )
        ways = (primal, primal, dual, dual, dual, dual)
        return Iterate(
            *(old + share * way * new for old, way, new in zip(now, ways, by, strict=True))
        )


def _way(distance: np.ndarray, by: np.ndarray) -> float:
    """Return how often a step may be made until a distance is zero."""
    closing = by < 0.0
    return float(np.min(-distance[closing] / by[closing], initial=np.inf))


def _largest(rows: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return the largest magnitude in each row and its value, (m,); 1 for rows of zeros."""
    largest = np.maximum(np.abs(rows).max(axis=1, initial=0.0), np.abs(values))
    return np.where(largest > 0.0, largest, 1.0)
