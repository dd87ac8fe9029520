# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Least squares in a box with rows and equations, by DAQP.

Like what any solver returns, the multipliers prove nothing until they are checked.
"""

from dataclasses import dataclass

import numpy as np

from ddct_controllers.mpc.qp.backend import solver_package

_EXCEEDED = 1e-3
"""Largest distance of a point outside of a row, in the unit of the row."""
_ROUNDS = 12
"""Number of times that rows are added; it begins without any."""
_SETTINGS = {
    'primal_tol': 1e-9,
    'eps_prox': 0.0,  # the Hessian is positive definite
    'eq_reduction': -1,
    'iter_limit': 20_000,
}
"""Settings of DAQP."""
_SOLVED = 1
"""Number that DAQP gives a solution."""
_ACTIVE, _LOWER = 1, 2
"""Flags by which DAQP starts with a row at its upper or lower end."""
_UNBOUNDED = 1e30
_CONDITION = 1e-9
"""Least eigenvalue of a Hessian over its largest."""
_MORE = 10.0
"""Factor by which the added curvature grows until a Hessian is solvable."""
_CURVATURE = 1e-7
"""Share of the mean curvature that is added where requests have no effect on the cost."""


@dataclass(frozen=True, eq=False)
class LeastSquares:
    """A point with the least sum of squares, and the multipliers of its rows and equations."""

    point: np.ndarray
    """(n,)."""
    rows: np.ndarray
    """Multipliers of the inequalities, (m,), of the slope of the sum of squares at the point."""
    equal: np.ndarray
    """Multipliers of the equations, (p,)."""
    used: np.ndarray
    """Mask of the inequalities that the solver had, (m,)."""


def least_squares(
    target: np.ndarray,
    offset: np.ndarray,
    low: np.ndarray,
    high: np.ndarray,
    rows: np.ndarray,
    limits: np.ndarray,
    equal_rows: np.ndarray,
    equal_values: np.ndarray,
    centre: np.ndarray,
    curvature: float = _CURVATURE,
    used: np.ndarray | None = None,
    steps: int = 0,
) -> LeastSquares | None:
    """
    Return z (n,) with the least |target z + offset|^2 in a box, rows z <= limits and equations.

    `target` is (k, n). A little of |z - centre|^2 is added, `curvature` times the mean of the
    diagonal of the Hessian; in so many further `steps` the centre is the point of the step before,
    so that it hardly costs anything (Rockafellar, SIAM J. Control Optim. 14, 1976). DAQP gets the
    rows of the mask `used` (m,) first, and another one only once a point exceeds it. None where
    there is no such z.
    """
    used = np.zeros(len(limits), dtype=bool) if used is None else used
    if not target.any():  # no variable has an effect, or there is none: it may exceed rows
        return LeastSquares(centre, np.zeros(len(limits)), np.zeros(len(equal_values)), used)
    hessian = target.T @ target
    added = curvature * np.trace(hessian) / len(hessian)
    added = max(added, _CONDITION * float(np.linalg.eigvalsh(hessian)[-1]))
    added = _solvable_with(hessian, added)
    hessian += added * np.eye(len(hessian))
    # In y = z/scale the Hessian has a unit diagonal, and all rows have the length 1.
    scale = 1.0 / np.sqrt(np.diag(hessian))
    every = np.vstack([equal_rows, rows]) * scale
    lengths = np.linalg.norm(every, axis=1)
    lengths = np.where(lengths > 0.0, lengths, 1.0)
    every /= lengths[:, np.newaxis]
    ends = np.concatenate([equal_values, limits]) / lengths
    first, equations = len(low), len(equal_values)
    upper = np.concatenate([high / scale, ends])
    lower = np.concatenate([low / scale, ends[:equations], np.full(len(limits), -_UNBOUNDED)])
    hessian *= scale * scale[:, np.newaxis]
    slope = target.T @ offset
    # Those of the box, the equations and the inequalities, at first of no row.
    multipliers = np.zeros(len(upper))
    model, found = None, None
    for _ in range(_ROUNDS):
        had = np.concatenate([np.ones(first + equations, dtype=bool), used])
        cost = (slope - added * centre) * scale
        if model is None:
            start = _ACTIVE * (multipliers != 0.0) + _LOWER * (multipliers < 0.0)
            model = solver_package('daqp').Model()
            model.settings = _SETTINGS
            ends_had = upper[had], lower[had]
            flag, _ = model.setup(
                hessian, cost, every[had[first:]], *ends_had, start[had].astype(np.intc)
            )
        else:
            flag = model.update(f=cost)
        if flag < 0:
            break
        solution, _, flag, info = model.solve()
        if flag != _SOLVED:
            break
        multipliers[had] = info['lam']
        of_rows = 2.0 * multipliers[first:] / lengths
        found = LeastSquares(scale * solution, of_rows[equations:], of_rows[:equations], used)
        exceeded = (rows @ found.point - limits > _EXCEEDED) & ~used
        if exceeded.any():
            model, used = None, used | exceeded
        elif not steps:
            break
        if steps:
            steps, centre = steps - 1, found.point
    return found


def _solvable_with(hessian: np.ndarray, added: float) -> float:
    """Return what the diagonal of a Hessian needs, at least `added`, for the solver to take it."""
    while True:
        diagonal = np.diag(hessian) + added
        # A unit diagonal, which the solver gets, makes late requests count as much.
        scale = 1.0 / np.sqrt(diagonal)
        scaled = (hessian + added * np.eye(len(hessian))) * scale * scale[:, np.newaxis]
        eigenvalues = np.linalg.eigvalsh(scaled)
        if eigenvalues[0] > _CONDITION * eigenvalues[-1]:
            return added
        added *= _MORE
