# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Best points of linear programs with proofs; what the solver returns is checked elsewhere."""

from dataclasses import dataclass, replace

import numpy as np

from ddct_bringup.floor.program.highs import Optimum, highs
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
_PEAK_EXCEEDED, _LEAST_PEAK = 1e-7, 1e-2
"""Largest distance of a point outside of a deferred row of a peak, as a share of the peak, which
is at least this in its unit."""
_ROUNDS = 4
"""Number of times that deferred rows are added to a program."""
_MOST_VIOLATION = 1e6


@dataclass(frozen=True, eq=False)
class Solution:
    """Best point of a program, (n,), with its certificate."""

    point: np.ndarray
    certificate: Certificate


def solve(
    program: LinearProgram,
    kept: np.ndarray,
    values: np.ndarray,
    deferred: np.ndarray,
    margin: np.ndarray | float = 0.0,
) -> Solution | None:
    """
    Return the best point with the variables of the mask `kept` (n,) at their `values` (n,).

    The solver gets the rows of the mask `deferred` (m,) only once a point exceeds them: most of
    them never matter. The point keeps a `margin` (m,) to the limits. The certificate is that of
    the whole program, without margin, in which no variable is kept. None where there is no point,
    also without margin and kept variables. Raise DdctError where the solver finds neither.
    """
    if kept.all():
        kept = np.zeros_like(kept)
    found, used = _attempt(program, kept, values, deferred, margin)
    if found is None:
        if not (kept.any() or np.any(margin)):
            return None
        # Only the kept variables or the margin may exclude all points, not the program.
        return solve(program, np.zeros_like(kept), values, deferred)
    multipliers = np.zeros(len(program.limits))
    multipliers[used] = found.rows
    peaks = multipliers[: program.peaks]
    # The box of the peak is wide, so that the least excess of this sum over 1 would cost much.
    peaks /= max(float(peaks.sum()), 1.0)
    return Solution(found.point, certified(WEAK_DUALITY, program, multipliers, found.equal))


def best_point(
    program: LinearProgram, deferred: np.ndarray
) -> tuple[np.ndarray | None, np.ndarray]:
    """
    Return the best point (n,), None without one, and the mask of the rows that were needed (m,).

    There is no certificate. Rows of the mask `deferred` (m,) come in as for `solve`.
    """
    none = np.zeros(len(program.cost), dtype=bool)
    found, used = _attempt(program, none, np.zeros(len(none)), deferred, 0.0)
    return (None if found is None else found.point), used


def _attempt(
    program: LinearProgram,
    kept: np.ndarray,
    values: np.ndarray,
    deferred: np.ndarray,
    margin: np.ndarray | float,
) -> tuple[Optimum | None, np.ndarray]:
    """
    Return the optimum, None without a point, and the mask of the rows used (m,).

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
        had = used
        found = highs(replace(whole, rows=whole.rows[had], limits=whole.limits[had]))
        if found is None:
            break
        if whole.peaks:
            tolerance[: whole.peaks] = _PEAK_EXCEEDED * max(found.point[-1], _LEAST_PEAK)
        exceeded = (whole.rows @ found.point - whole.limits > tolerance) & ~had
        if not exceeded.any():
            break
        used = had | exceeded
    if found is None:
        return None, had
    point = values.copy()
    point[free] = found.point
    return replace(found, point=point), had


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


def ray_of(program: LinearProgram) -> Certificate:
    """
    Return the certificate of a program without a point: its multipliers at the least violation.

    Where that is positive they prove that there is no point. Raise DdctError without it.
    """
    count, equations = len(program.limits), len(program.equal_values)
    every = np.vstack([program.rows, program.equal_rows, -program.equal_rows])
    none = np.zeros(len(program.cost))
    violation = LinearProgram(
        cost=np.append(none, 1.0),
        constant=0.0,
        rows=np.hstack([every, -np.ones((len(every), 1))]),
        limits=np.concatenate([program.limits, program.equal_values, -program.equal_values]),
        equal_rows=np.zeros((0, len(none) + 1)),
        equal_values=np.zeros(0),
        low=np.append(program.low, 0.0),
        high=np.append(program.high, _MOST_VIOLATION),
    )
    found = highs(violation)
    if found is None:
        raise DdctError('HiGHS: it finds no least violation of a program')
    above, below = found.rows[count : count + equations], found.rows[count + equations :]
    return certified(RAY, program, found.rows[:count], above - below)
