# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Newton directions of the interior-point method."""

from typing import NamedTuple

import numpy as np

from ddct_bringup.floor.program.linear_program import LinearProgram

_REGULAR, _REFINED = 1e-12, 2
"""Addition to the unit diagonal of a system, and number of solutions that undo it."""


class Iterate(NamedTuple):
    """Point x with slacks s of the rows, and multipliers of equations, rows and both edges."""

    x: np.ndarray
    s: np.ndarray
    equal: np.ndarray
    rows: np.ndarray
    low: np.ndarray
    high: np.ndarray


class Newton:
    """Newton directions at one iterate; they differ in the products that are wanted."""

    def __init__(
        self,
        program: LinearProgram,
        now: Iterate,
        dual: np.ndarray,
        primal: np.ndarray,
        equal: np.ndarray,
    ) -> None:
        # Only here: programs that compute no floor need not wait for it.
        from scipy.linalg import cho_factor, cho_solve

        self._cho_solve = cho_solve
        self._program, self._now = program, now
        self._residuals = dual, primal, equal
        self._to_low, self._to_high = now.x - program.low, program.high - now.x
        self._weights = now.rows / now.s
        self._box = now.low / self._to_low + now.high / self._to_high
        matrix = weighted_square(program, self._weights)
        diagonal = np.diag_indices_from(matrix)
        matrix[diagonal] += self._box
        self._scale = 1.0 / np.sqrt(matrix[diagonal])
        matrix *= self._scale
        matrix *= self._scale[:, np.newaxis]
        matrix[diagonal] += _REGULAR
        # The transpose of a symmetric matrix has the order that LAPACK takes without a copy.
        self._factor = cho_factor(matrix.T, lower=True, overwrite_a=True, check_finite=False)
        self._of_equations = np.column_stack(
            [self._solved(row, refined=True) for row in program.equal_rows]
            or [np.zeros((len(now.x), 0))]
        )

    def _solved(self, right: np.ndarray, *, refined: bool) -> np.ndarray:
        """Return the solution of the reduced system for a right-hand side (n,)."""
        p = self._program
        x, rest = np.zeros(len(right)), right
        for step in range(_REFINED if refined else 1):
            if step:
                left = p.combined(self._weights * p.times(x)) + self._box * x
                rest = right - left
            found = self._cho_solve(self._factor, self._scale * rest, check_finite=False)
            x = x + self._scale * found
        return x

    def direction(self, wanted: list[np.ndarray], *, refined: bool = True) -> Iterate:
        """
        Return the direction that changes the products by what is wanted, in first order.

        One that is only a prediction need not be `refined`.
        """
        p, now = self._program, self._now
        dual, primal, equal = self._residuals
        rows, low, high = wanted
        right = -dual - p.combined(rows / now.s + self._weights * primal)
        right += low / self._to_low - high / self._to_high
        x = self._solved(right, refined=refined)
        y = np.zeros(0)
        if len(p.equal_values):
            y = np.linalg.solve(p.equal_rows @ self._of_equations, p.equal_rows @ x + equal)
            x = x - self._of_equations @ y
        s = -primal - p.times(x)
        return Iterate(
            x,
            s,
            y,
            (rows - now.rows * s) / now.s,
            (low - now.low * x) / self._to_low,
            (high + now.high * x) / self._to_high,
        )


def weighted_square(program: LinearProgram, weights: np.ndarray) -> np.ndarray:
    """Return rows^T diag(weights) rows, (n, n); mirrored rows are multiplied once."""
    count = program.mirrored
    rows = program.rows[count:] if count else program.rows
    both = weights[count:]
    if count:
        both = both.copy()
        both[:count] += weights[:count]
    weighted = np.sqrt(both)[:, np.newaxis] * rows
    matrix = weighted.T @ weighted
    if count:
        # What the column of the peak has with the others changes its sign in the mirror.
        last = rows[:count, -1] * weights[:count]
        matrix[:-1, -1] -= 2.0 * (last @ rows[:count, :-1])
        matrix[-1, :-1] = matrix[:-1, -1]
    return np.asarray(matrix)
