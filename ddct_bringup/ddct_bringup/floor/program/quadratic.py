# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Least squares in a box with rows and equations, by DAQP."""

import numpy as np

from ddct_controllers.mpc.qp.backend import make_backend
from ddct_controllers.mpc.qp.problem import QpStructure

_EXCEEDED = 1e-3
"""Largest distance of a point outside of a row, in the unit of the row."""
_ROUNDS = 12
"""Number of times that rows are added; it begins without any."""
_ITERATIONS = 20_000
"""Iteration limit of DAQP."""
_CONDITION = 1e-9
"""Least eigenvalue of a Hessian over its largest."""
_MORE = 10.0
"""Factor by which the added curvature grows until a Hessian is solvable."""
_CURVATURE = 1e-7
"""Share of the mean curvature that is added where requests have no effect on the cost."""


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
) -> np.ndarray | None:
    """
    Return z (n,) with the least |target z + offset|^2 in a box, rows z <= limits and equations.

    `target` is (k, n). A little of |z - centre|^2 is added, `curvature` times the mean of the
    diagonal of the Hessian. DAQP gets a row only once a point exceeds it. None where there is no
    such z.
    """
    if not target.any():
        return centre  # no variable has an effect, or there is none
    hessian = target.T @ target
    added = curvature * np.trace(hessian) / len(hessian)
    added = max(added, _CONDITION * float(np.linalg.eigvalsh(hessian)[-1]))
    added = _solvable_with(hessian, added)
    hessian += added * np.eye(len(hessian))
    used = np.zeros(len(limits), dtype=bool)
    point = None
    for _ in range(_ROUNDS):
        every = np.vstack([np.eye(len(low)), equal_rows, rows[used]])
        backend = make_backend('daqp', QpStructure(hessian, every), _ITERATIONS)
        solution = backend.solve(
            target.T @ offset - added * centre,
            np.concatenate([low, equal_values, np.full(used.sum(), -np.inf)]),
            np.concatenate([high, equal_values, limits[used]]),
        )
        if solution.status != 'solved':
            break
        point = solution.z
        exceeded = (rows @ point - limits > _EXCEEDED) & ~used
        if not exceeded.any():
            break
        used |= exceeded
    return point


def _solvable_with(hessian: np.ndarray, added: float) -> float:
    """Return what the diagonal of a Hessian needs, at least `added`, for the solver to take it."""
    while True:
        diagonal = np.diag(hessian) + added
        # A unit diagonal, which the solver gives the Hessian, makes late requests count as much.
        scale = 1.0 / np.sqrt(diagonal)
        scaled = (hessian + added * np.eye(len(hessian))) * scale * scale[:, np.newaxis]
        eigenvalues = np.linalg.eigvalsh(scaled)
        if eigenvalues[0] > _CONDITION * eigenvalues[-1]:
            return added
        added *= _MORE
