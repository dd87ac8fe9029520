# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Best points of linear programs with proofs; what the solvers return is checked elsewhere."""

from dataclasses import dataclass, replace

import numpy as np

from ddct_bringup.floor.program.highs import highs
from ddct_bringup.floor.program.interior_point import VIOLATION, Optimum, interior_point
from ddct_bringup.floor.program.linear_program import (
    RAY,
    WEAK_DUALITY,
    Certificate,
    LinearProgram,
    certified,
)
from ddct_plant.base.errors import DdctError

_EXCEEDED = 1e-3
"""Largest distance of a point outside of a deferred row, in the unit of the row."""
_PEAK_EXCEEDED = 1e-7
"""Largest distance of a point outside of a deferred row of a peak, as a share of the peak."""
_ROUNDS = 4
"""Number of times that deferred rows are added to a program."""
_MOST_VIOLATION = 1e6


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

    A solver gets the rows of the mask `deferred` (m,) only once a point exceeds them: most of them
    never matter. The point keeps a `margin` (m,) to the limits. The certificate is that of the
    whole program, without margin, in which no variable is kept. Raise DdctError where no solver
    finds a point, nor that there is none.
    """
    if kept.all():
        kept = np.zeros_like(kept)
    found, used = _attempt(program, kept, values, deferred, margin)
    multipliers = np.zeros(len(program.limits))
    multipliers[used] = found.rows
    if found.point is not None:
        return Solution(found.point, certified(WEAK_DUALITY, program, multipliers, found.equal))
    ray = certified(RAY, program, multipliers, found.equal)
    if ray.claim <= 0.0:
        rows, equal = _ray(program)
        ray = certified(RAY, program, rows, equal)
    if ray.claim > 0.0 or not (kept.any() or np.any(margin)):
        return Solution(None, ray)
    # Only the kept variables or the margin exclude all points, not the program.
    return solve(program, np.zeros_like(kept), values, deferred)


def best_point(
    program: LinearProgram, deferred: np.ndarray
) -> tuple[np.ndarray | None, np.ndarray]:
    """
    Return the best point (n,), None without one, and the mask of the rows that were needed (m,).

    There is no certificate. Rows of the mask `deferred` (m,) come in as for `solve`.
    """
    none = np.zeros(len(program.cost), dtype=bool)
    found, used = _attempt(program, none, np.zeros(len(none)), deferred, 0.0, proof=False)
    return found.point, used


def _attempt(
    program: LinearProgram,
    kept: np.ndarray,
    values: np.ndarray,
    deferred: np.ndarray,
    margin: np.ndarray | float,
    *,
    proof: bool = True,
) -> tuple[Optimum, np.ndarray]:
    """
    Return what was found, and the mask of the rows used (m,).

    A point has all variables, those that are kept or have a box without width too.
    """
    fixed = program.low >= program.high
    values = np.where(fixed, program.low, values)
    kept = kept | fixed
    free = ~kept
    whole = replace(program, limits=program.limits - margin)
    if kept.any():
        whole = _without(whole, kept, values[kept])
    used = ~deferred
    # Within its margin a point still keeps the limit itself.
    tolerance = np.maximum(margin, _EXCEEDED) * np.ones(len(used))
    for _ in range(_ROUNDS):
        part = replace(
            whole,
            rows=whole.rows[used],
            limits=whole.limits[used],
            mirrored=int(used[: whole.mirrored].sum()),
        )
        found = _optimum(part, proof=proof)
        if found.point is None:
            break
        tolerance[: 2 * whole.mirrored] = _PEAK_EXCEEDED * max(found.point[-1], 1e-2)
        exceeded = (whole.times(found.point) - whole.limits > tolerance) & ~used
        if not exceeded.any():
            break
        had, used = used, used | _with_mirrored(exceeded, whole.mirrored)
    else:
        used = had
    if found.point is not None:
        point = values.copy()
        point[free] = found.point
        found = replace(found, point=point)
    return found, used


def _with_mirrored(mask: np.ndarray, count: int) -> np.ndarray:
    """Return the mask of rows (m,) with the mirror images of each."""
    either = mask[:count] | mask[count : 2 * count]
    return np.concatenate([either, either, mask[2 * count :]])


def _without(program: LinearProgram, kept: np.ndarray, values: np.ndarray) -> LinearProgram:
    """Return the program of the other variables, with those of the mask at these values."""
    free = ~kept
    fixed = np.zeros(len(kept))
    fixed[kept] = values
    return replace(
        program,
        cost=program.cost[free],
        constant=program.constant + float(program.cost @ fixed),
        rows=program.rows[:, free],
        limits=program.limits - program.rows @ fixed,
        equal_rows=program.equal_rows[:, free],
        equal_values=program.equal_values - program.equal_rows @ fixed,
        low=program.low[free],
        high=program.high[free],
    )


def _optimum(program: LinearProgram, *, proof: bool) -> Optimum:
    """Return the optimum of a program, or the ray where it has no point."""
    best = interior_point(program, proof=proof)
    if best is None:
        rows, equal = _ray(program)
        if certified(RAY, program, rows, equal).claim > VIOLATION:
            return Optimum(None, rows, equal)
        best = highs(program)
        if best is None:
            return Optimum(None, rows, equal)
    return best


def _ray(program: LinearProgram) -> tuple[np.ndarray, np.ndarray]:
    """
    Return the multipliers of rows and equations at the least violation of a program.

    Where that is positive they prove that there is no point. The rows of a peak are left out, as a
    peak that is high enough keeps them.
    """
    first = 2 * program.mirrored
    count, equations = len(program.limits) - first, len(program.equal_values)
    every = np.vstack([program.rows[first:], program.equal_rows, -program.equal_rows])
    limits = [program.limits[first:], program.equal_values, -program.equal_values]
    none = np.zeros(len(program.cost))
    violation = LinearProgram(
        cost=np.append(none, 1.0),
        constant=0.0,
        rows=np.hstack([every, -np.ones((len(every), 1))]),
        limits=np.concatenate(limits),
        equal_rows=np.zeros((0, len(none) + 1)),
        equal_values=np.zeros(0),
        low=np.append(program.low, 0.0),
        high=np.append(program.high, _MOST_VIOLATION),
    )
    found = interior_point(violation) or highs(violation)
    if found is None:
        raise DdctError('HiGHS: it finds no least violation of a program')
    above, below = found.rows[count : count + equations], found.rows[count + equations :]
    return np.concatenate([np.zeros(first), found.rows[:count]]), above - below
