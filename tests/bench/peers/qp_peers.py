# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Peers that solve the same programs: DAQP and OSQP without our backends, and cvxpy."""

from collections.abc import Callable
from typing import Any

import daqp
import numpy as np
import osqp
from bench.peers.qp_programs import LIMIT
from scipy import sparse

from ddct_controllers.mpc.qp.problem import QpStructure

Solve = Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]

_ACCURACY = {'eps_abs': 1e-6, 'eps_rel': 1e-6, 'max_iter': LIMIT}
_SOFT, _UNBOUNDED = 8, 1e30
"""DAQP's flag of a soft row, and its infinity."""


def bare_daqp(structure: QpStructure) -> Solve:
    """Return DAQP with warm-started active sets and nothing around it; settings are defaults."""
    rows, size = structure.constraints.shape
    sense = np.zeros(rows, dtype=np.intc)
    sense[structure.soft_rows] = _SOFT
    unbounded = np.full(rows, _UNBOUNDED)
    model = daqp.Model()
    # DAQP refuses arrays that it may not write into.
    hessian, constraints = np.array(structure.hessian), np.array(structure.constraints)
    model.setup(hessian, np.zeros(size), constraints, unbounded, -unbounded, sense)
    if len(structure.soft_rows):
        reciprocal = np.zeros(rows)
        reciprocal[structure.soft_rows] = 1.0 / (structure.soft_weight or 1.0)
        model.soft_weights(rho_l=reciprocal, rho_u=reciprocal)

    def solve(f: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
        model.update(f=f, bupper=upper, blower=lower)
        return model.solve()[0]

    return solve


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


def cvxpy_osqp(cvxpy: Any, structure: QpStructure) -> Solve:
    """Return cvxpy with OSQP, warm-started; vectors are parameters of one problem."""
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

    def solve(f_z: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        f.value, lower.value, upper.value = f_z, low, high
        problem.solve(solver=cvxpy.OSQP, warm_start=True, **_ACCURACY)
        return z.value

    return solve
