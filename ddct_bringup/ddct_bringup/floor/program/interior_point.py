# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Linear programs with full matrices by a primal-dual interior-point method.

It is the method of Mehrotra with the box apart from the rows. The rows of a floor are full:
solvers of sparse programs take several times as long. What it returns proves nothing; the
multipliers are checked as those of any solver.
"""

from dataclasses import dataclass

import numpy as np
from numpy.linalg import LinAlgError

from ddct_bringup.floor.program.linear_program import RAY, WEAK_DUALITY, LinearProgram, proven
from ddct_bringup.floor.program.mehrotra import LEAST_COST, Mehrotra
from ddct_bringup.floor.program.newton import Iterate

_ITERATIONS = 80
"""Iteration limit; some 20 are usual."""
_STALLED, _AT_END = 12, 2
"""Number of iterations without progress after which the method ends, and with products of zero."""
_ROUNDING = 0.25
"""Share of the gap of a proof below which the products count as zero: rounding is the rest."""
_PROGRESS = 0.9
"""Share of the gap that counts as progress."""
_ROUNDED = 1000.0
"""Multiple of the accepted gap that is allowed at the end, where rounding allows no less."""
VIOLATION = 1e-5
"""Least violation, in the units of the rows, above which a program has no point."""


@dataclass(frozen=True)
class _Accepted:
    """Exactness at which the method ends."""

    gap: float
    """Largest gap between cost and bound that the multipliers prove, as a share of the cost."""
    violation: float
    """Largest violation of a row, as a share of its largest number."""


_PROVEN, _COARSE = _Accepted(1e-7, 1e-9), _Accepted(1e-4, 1e-6)


@dataclass(frozen=True, eq=False)
class Optimum:
    """
    Best point of a program, (n,), and the multipliers of its rows and equations.

    Without a point the multipliers are those of a ray, which proves that there is none.
    """

    point: np.ndarray | None
    rows: np.ndarray
    equal: np.ndarray


def interior_point(program: LinearProgram, *, proof: bool = True) -> Optimum | None:
    """
    Return the optimum of a program, or a ray; None where the method converges to neither.

    Without `proof` the point is enough, and the multipliers may be off by more.
    """
    if not len(program.cost) or np.any(program.low >= program.high):
        return None
    method = Mehrotra(program)
    now = nearest = surest = method.first()
    accepted = _PROVEN if proof else _COARSE
    best, surest_gap, since = np.inf, np.inf, 0
    for _ in range(_ITERATIONS):
        cost = float(program.cost @ now.x + program.constant)
        scale = max(abs(cost), LEAST_COST)
        products = gap = method.products(now) / scale
        if proof:
            gap = (cost - proven(WEAK_DUALITY, program, now.rows, now.equal)) / scale
            ray = _ray_of(program, now) if gap < 0.0 else None
            if ray is not None:
                return ray
        missing = max(method.violation(now) / accepted.violation, gap / accepted.gap)
        if missing < _PROGRESS * best:
            best, since, nearest = missing, 0, now
        # Rounding makes the proof worse again before the point is exact.
        if gap < surest_gap:
            surest_gap, surest = gap, now
        since += 1
        # With the products at zero only rounding is left, which further steps do not remove.
        at_end = products <= accepted.gap or (best <= _ROUNDED and products <= _ROUNDING * gap)
        if best <= 1.0 or since > (_AT_END if at_end else _STALLED):
            break
        try:
            now = method.next(now)
        except (LinAlgError, FloatingPointError):
            break
    if best > _ROUNDED:
        return None
    return Optimum(nearest.x, surest.rows, surest.equal)


def _ray_of(program: LinearProgram, now: Iterate) -> Optimum | None:
    """
    Return the multipliers of an iterate as a ray whose sum is 1, None where they prove nothing.

    Without a point the multipliers grow beyond those of the cost. A peak that is high enough keeps
    its own rows, so that these are left out.
    """
    rows = now.rows.copy()
    rows[: 2 * program.mirrored] = 0.0
    scale = rows.sum() + np.abs(now.equal).sum()
    if scale <= 0.0:
        return None
    rows, equal = rows / scale, now.equal / scale
    return Optimum(None, rows, equal) if proven(RAY, program, rows, equal) > VIOLATION else None
