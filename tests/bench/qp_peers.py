# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Peers that solve the same programs: OSQP without our backend, and cvxpy with parameters."""

from collections.abc import Callable
from typing import Any

import numpy as np
import osqp
from qp_programs import LIMIT
from scipy import sparse

from ddct_controllers.mpc.qp.problem import QpStructure

Solve = Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]

_ACCURACY = {'eps_abs': 1e-6, 'eps_rel': 1e-6, 'max_iter': LIMIT}
_EXACT = {'tol_gap_abs': 1e-11, 'tol_gap_rel': 1e-11, 'tol_feas': 1e-11}


def bare_osqp(structure: QpStructure) -> Solve:
    """Return OSQP with a slack for each soft row; all settings but the accuracy are defaults."""
    rows, size = structure.constraints.shape
    slacks = len(structure.soft_rows)
    weights = np.full(slacks, structure.soft_weight or 0.0)  # None without soft rows
    cost = sparse.block_diag([structure.hessian, np.diag(weights)])
    constraints = np.hstack([structure.constraints, np.eye(rows)[:, structure.soft_rows]])
    f, none = np.zeros(size + slacks), np.full(rows, np.inf)
    solver = osqp.OSQP()
    solver.setup(
        sparse.triu(cost, format='csc'),
        f,
        sparse.csc_matrix(constraints),
        -none,
        none,
        verbose=False,
        **_ACCURACY,
    )

    def solve(f_z: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
        f[:size] = f_z
        solver.update(q=f, l=lower, u=upper)
        return solver.solve(raise_error=True).x[:size]

    return solve


def cvxpy_osqp_and_clarabel(cvxpy: Any, structure: QpStructure) -> tuple[Solve, Solve]:
    """Return cvxpy with OSQP, warm-started, and the same program with Clarabel at 1e-11."""
    rows, size = structure.constraints.shape
    z, slack = cvxpy.Variable(size), cvxpy.Variable(rows)
    root = np.linalg.cholesky(structure.hessian).T
    f, lower, upper = (cvxpy.Parameter(count) for count in (size, rows, rows))
    cost = 0.5 * cvxpy.sum_squares(root @ z) + f @ z
    cost += 0.5 * (structure.soft_weight or 0.0) * cvxpy.sum_squares(slack)
    values = structure.constraints @ z + slack
    hard = np.flatnonzero(~structure.soft)
    problem = cvxpy.Problem(
        cvxpy.Minimize(cost), [values >= lower, values <= upper, slack[hard] == 0.0]
    )

    def solve_with(**settings: Any) -> Solve:
        def solve(f_z: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
            f.value, lower.value, upper.value = f_z, low, high
            problem.solve(**settings)
            return z.value

        return solve

    return (
        solve_with(solver=cvxpy.OSQP, warm_start=True, **_ACCURACY),
        solve_with(solver=cvxpy.CLARABEL, **_EXACT),
    )
