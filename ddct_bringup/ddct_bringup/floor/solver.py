# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Solutions of the programs by HiGHS and DAQP; `program.py` checks them."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy

from ddct_bringup.floor.program import RAY, WEAK_DUALITY, Certificate, LinearProgram, certified
from ddct_controllers.mpc.qp.backend import make_backend
from ddct_controllers.mpc.qp.problem import QpStructure
from ddct_plant.base.errors import DdctError

_NEGLIGIBLE = 1e-7
"""Share of the largest entry of a row below which HiGHS gets a zero instead."""
_OPTIONS = {
    'primal_feasibility_tolerance': 1e-7,
    'dual_feasibility_tolerance': 1e-9,
    'presolve': False,
}
"""Options of HiGHS. Every inexact multiplier costs a bound its share of the box; without presolve
a program takes two thirds of the time."""
_EXCEEDED = 1e-3
"""Largest violation of a deferred row by a point, in the unit of the row."""
_ROUNDS = 4
"""Number of times that rows are added to a linear program."""
_QUADRATIC_ROUNDS = 12
"""Number of times that rows are added to a quadratic program, which begins without any."""
_ITERATIONS = 20_000
"""Iteration limit of DAQP."""
_CONDITION = 1e-9
"""Least eigenvalue of a Hessian over its largest."""
_MORE = 10.0
"""Factor by which the added curvature grows until a Hessian is solvable."""
_CURVATURE = 1e-7
"""Share of the mean curvature that is added where requests have no effect on the cost."""


@dataclass(frozen=True, eq=False)
class Solution:
    """Best point of a program with its certificate; the point is None where there is none."""

    point: np.ndarray | None
    certificate: Certificate


def solve(
    program: LinearProgram,
    kept: np.ndarray,
    values: np.ndarray,
    deferred: np.ndarray,
    margin: np.ndarray | float = 0.0,
) -> Solution:
    """
    Return the best point with the variables of the mask `kept` (n,) at their `values` (n,).

    HiGHS gets the rows of the mask `deferred` (m,) only once a point exceeds them: most of them
    never matter. The point keeps a `margin` (m,) to the limits. The certificate is that of the
    whole program, without margin, in which no variable is kept. Raise
    DdctError where HiGHS finds neither a point nor that there is none.
    """
    if kept.all():
        kept = np.zeros_like(kept)
    found, used = _attempt(program, kept, values, deferred, margin)
    if found.status == 2:
        ray = _ray(program)
        if ray.claim > 0.0 or not (kept.any() or np.any(margin)):
            return Solution(None, ray)
        # Only the kept variables or the margin exclude all points, not the program.
        return solve(program, np.zeros_like(kept), values, deferred)
    multipliers = np.zeros(len(program.limits))
    multipliers[used] = -found.ineqlin.marginals
    point = values.copy()
    point[~kept] = found.x
    return Solution(point, certified(WEAK_DUALITY, program, multipliers, -found.eqlin.marginals))


def best_point(
    program: LinearProgram, kept: np.ndarray, values: np.ndarray, deferred: np.ndarray
) -> np.ndarray | None:
    """Return the best point as `solve` does, without a certificate; None where there is none."""
    found, _ = _attempt(program, kept, values, deferred, 0.0)
    if found.status == 2:
        return None
    point = values.copy()
    point[~kept] = found.x
    return point


def _attempt(
    program: LinearProgram,
    kept: np.ndarray,
    values: np.ndarray,
    deferred: np.ndarray,
    margin: np.ndarray | float,
) -> tuple[Any, np.ndarray]:
    """Return the result of HiGHS, and the mask of the rows (m,) that it had."""
    free = ~kept
    limits = program.limits - program.rows[:, kept] @ values[kept] - margin
    equal_values = program.equal_values - program.equal_rows[:, kept] @ values[kept]
    rows, used = program.rows[:, free], ~deferred
    # Within its margin a point still keeps the limit itself.
    tolerance = np.maximum(margin, _EXCEEDED)
    for _ in range(_ROUNDS):
        found = _highs(
            program.cost[free],
            rows[used],
            limits[used],
            program.equal_rows[:, free],
            equal_values,
            program.low[free],
            program.high[free],
        )
        if found.status not in (0, 2):
            raise DdctError(f'HiGHS: {found.message}')
        if found.status == 2:
            break
        exceeded = (rows @ found.x - limits > tolerance) & ~used
        if not exceeded.any():
            break
        had, used = used, used | exceeded
    else:
        used = had
    return found, used


def _ray(program: LinearProgram) -> Certificate:
    """Return the proof that the whole program has no point, from its least violation."""
    rows, equations = len(program.limits), len(program.equal_values)
    ones = np.ones((rows + 2 * equations, 1))
    every = np.vstack([program.rows, program.equal_rows, -program.equal_rows])
    limits = np.concatenate([program.limits, program.equal_values, -program.equal_values])
    count = len(program.cost)
    found = _highs(
        np.append(np.zeros(count), 1.0),
        np.hstack([every, -ones]),
        limits,
        np.zeros((0, count + 1)),
        np.zeros(0),
        np.append(program.low, 0.0),
        np.append(program.high, 1e6),
    )
    if found.status != 0:
        raise DdctError(f'HiGHS: {found.message}')
    multipliers = -found.ineqlin.marginals
    above, below = multipliers[rows : rows + equations], multipliers[rows + equations :]
    return certified(RAY, program, multipliers[:rows], above - below)


def _highs(
    cost: np.ndarray,
    rows: np.ndarray,
    limits: np.ndarray,
    equal_rows: np.ndarray,
    equal_values: np.ndarray,
    low: np.ndarray,
    high: np.ndarray,
) -> Any:
    """Return the result of scipy for one program; the second method is for where one gives up."""
    largest = np.abs(rows).max(axis=1, keepdims=True, initial=0.0)
    sparse = scipy.sparse.csr_array(np.where(np.abs(rows) > _NEGLIGIBLE * largest, rows, 0.0))
    box = np.column_stack([low, high])
    for method in ('highs-ipm', 'highs-ds'):
        found = scipy.optimize.linprog(
            cost, sparse, limits, equal_rows, equal_values, box, method, options=_OPTIONS
        )
        if found.status in (0, 2):
            break
    return found


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
    for _ in range(_QUADRATIC_ROUNDS):
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
    """Return the least addition to the diagonal, from `added`, to make it solvable."""
    while True:
        diagonal = np.diag(hessian) + added
        # A unit diagonal, which the solver gives the Hessian, makes late requests count as much.
        scale = 1.0 / np.sqrt(diagonal)
        scaled = (hessian + added * np.eye(len(hessian))) * scale * scale[:, np.newaxis]
        eigenvalues = np.linalg.eigvalsh(scaled)
        if eigenvalues[0] > _CONDITION * eigenvalues[-1]:
            return added
        added *= _MORE
