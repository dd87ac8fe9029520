# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Certified lower bounds of metrics over all runs of a case."""

from dataclasses import dataclass, replace

import numpy as np

from ddct_bringup.floor.case import Case
from ddct_bringup.floor.objectives import Peak, RootMeanSquare, Signals
from ddct_bringup.floor.program.linear_program import (
    LINEARISED,
    RAY,
    WEAK_DUALITY,
    Certificate,
    LinearProgram,
    certified,
    require_proof,
)
from ddct_bringup.floor.program.peak import late_peaks, peak_program
from ddct_bringup.floor.program.quadratic import least_squares
from ddct_bringup.floor.program.solve import ray_of, solve

_GAP = 1e-5
"""Largest share of a square by which other multipliers than those of its least may do better."""
_STEPS = 3
"""Number of steps by which the point of a quadratic program comes nearer to its least."""
_WINDOWS = 3
"""Number of stretches whose bounds are computed where a metric is the largest over all."""


@dataclass(frozen=True, eq=False)
class Bound:
    """Lower bound of a metric over the runs of a case."""

    least: float | None
    """Proven lower bound in the unit of the metric; None where no run of the case exists."""
    kind: str
    """Kind of the proof."""
    point: np.ndarray | None
    """Values of the variables, (columns,), the constant 1 first; None where there is no run."""
    value: float | None
    """Metric of the program at this point."""
    certificate: Certificate
    program: LinearProgram
    engine_price: float = 0.0
    """Fall of the bound, as its share, if the engine might be slower by 1 rad/s."""
    stretch: int = 0
    """First row of the stretch in which the point has the metric, where that is the largest over
    all stretches."""


def free_columns(case: Case) -> np.ndarray:
    """
    Return the mask of the variables that a solver chooses, (columns - 1,).

    These are the requests, the remainders of engine and capacity, and C_1 of a gear shift. The
    remainder of the load is small; it stays in the middle of its interval, and the certificate
    allows for all of the interval.
    """
    columns = case.motion.columns
    free = np.zeros(columns.count - 1, dtype=bool)
    free[: columns.requests] = True
    for part in (columns.engine, columns.capacity, columns.nodes, columns.off_going):
        free[part.start - 1 : part.stop - 1] = True
    return free


def bound_of(case: Case, objective: Peak | RootMeanSquare, signals: Signals) -> Bound | None:
    """
    Return the bound of a metric whose signals have a row for each variable of `case.motion`.

    None where the metric is undefined. Each bound is checked without the solver.
    """
    mapped = objective.of(signals)
    if mapped is None or not mapped.size:
        return None
    rows = np.ascontiguousarray(mapped.T)
    if isinstance(objective, Peak):
        return _peak(case, rows, objective.one_sided)
    length = objective.samples
    if not length:
        return _mean_square(case, rows)[0]
    first, best, used = 0, None, None
    for _ in range(_WINDOWS):
        found, used = _mean_square(case, rows[first : first + length], used)
        if found.point is None or found.least is None:
            return found
        squares = np.cumsum(np.concatenate([[0.0], (rows @ found.point) ** 2]))
        strongest = int(np.argmax(squares[length:] - squares[:-length]))
        if best is None or best.least is None or found.least > best.least:
            best = replace(found, stretch=strongest)
        if strongest == first:
            break
        first = strongest
    return best


def _peak(case: Case, rows: np.ndarray, one_sided: bool) -> Bound:
    """Return the bound of the largest magnitude, or value, of `rows` (n, columns) times z."""
    inequalities = case.inequalities
    limiting, limits = inequalities.rows, inequalities.limits
    columns = case.motion.columns
    program = peak_program(
        rows[:, 1:],
        rows[:, 0],
        limiting[:, 1:],
        limits - limiting[:, 0],
        case.equations[:, 1:],
        -case.equations[:, 0],
        columns.low,
        columns.high,
        one_sided=one_sided,
    )
    late = np.zeros(program.peaks, dtype=bool)
    # A free engine has peaks at any time, and a linear clutch that never locks has them too.
    locks = bool(len(case.equations)) and columns.engine.start == columns.engine.stop
    if locks and not one_sided:
        late = late_peaks(len(rows), case.lock.time_s)
    solution = solve(
        program,
        np.append(~free_columns(case), False),
        (program.low + program.high) / 2.0,
        np.concatenate([late, inequalities.deferred]),
        np.concatenate([np.zeros(len(late)), inequalities.margin]),
    )
    if solution is None:
        return without_run(case)
    require_proof(solution.certificate, program)
    point = np.append(1.0, solution.point[:-1])
    value = float(np.max(rows @ point if one_sided else np.abs(rows @ point)))
    return Bound(
        max(solution.certificate.claim, 0.0),
        WEAK_DUALITY,
        point,
        value,
        solution.certificate,
        program,
        _engine_price(case, solution.certificate, value),
    )


def _mean_square(
    case: Case, rows: np.ndarray, used: np.ndarray | None = None
) -> tuple[Bound, np.ndarray | None]:
    """
    Return the bound of the r.m.s. of `rows` (n, columns) times the variables.

    f(z) >= f(z_0) + f'(z_0) (z - z_0) for a convex f. So the proof is that of the linear program
    with the slope at the solution z_0 as cost: by the multipliers of z_0, or where others may do
    better by those of that program. The second result is the mask of the inequalities that
    z_0 needed; as `used` it makes the next call faster.
    """
    inequalities = case.inequalities
    limiting, limits = inequalities.rows, inequalities.limits
    columns = case.motion.columns
    weighted = rows / np.sqrt(len(rows))
    middle = np.concatenate([[1.0], (columns.low + columns.high) / 2.0])
    free = np.concatenate([[False], free_columns(case)])
    fixed = middle * ~free
    target = weighted[:, free]
    solved = least_squares(
        target,
        weighted @ fixed,
        columns.low[free[1:]],
        columns.high[free[1:]],
        limiting[:, free],
        limits - inequalities.margin - limiting @ fixed,
        case.equations[:, free],
        -case.equations @ fixed,
        middle[free],
        used=used,
        steps=_STEPS,
    )
    point = fixed.copy()
    point[free] = middle[free] if solved is None else solved.point
    square = float(np.sum((weighted @ point) ** 2))
    slope = 2.0 * weighted.T @ (weighted @ point)
    program = _linear(case, slope[1:], square - slope[1:] @ point[1:])
    certificate = None
    # Without an effect no point was searched for, and there may be none.
    if solved is not None and target.any():
        used = solved.used
        certificate = certified(WEAK_DUALITY, program, solved.rows, solved.equal)
    if certificate is None or _left(program, certificate, point[1:], free[1:]) > _GAP * square:
        solution = solve(program, ~free[1:], middle[1:], inequalities.deferred)
        if solution is None:
            return without_run(case), used
        certificate = solution.certificate
    require_proof(certificate, program)
    bound = Bound(
        float(np.sqrt(max(certificate.claim, 0.0))),
        LINEARISED,
        point,
        float(np.sqrt(square)),
        certificate,
        program,
        _engine_price(case, certificate, square),
    )
    return bound, used


def _left(
    program: LinearProgram, certificate: Certificate, point: np.ndarray, free: np.ndarray
) -> float:
    """
    Return by how much at most other multipliers could raise the bound of a program.

    It is the cost at a point (n,) less the bound, but for what the intervals of variables that are
    not `free` (n,) cost: a solver keeps these where they are.
    """
    slopes = program.cost + certificate.row_multipliers @ program.rows
    slopes += certificate.equal_multipliers @ program.equal_rows
    costs = slopes * point - np.minimum(slopes * program.low, slopes * program.high)
    gap = program.cost @ point + program.constant - certificate.claim
    return float(gap - costs[~free].sum())


def without_run(case: Case) -> Bound:
    """Return the proof that a case has no run, for any metric; raise DdctError without one."""
    program = _linear(case, np.zeros(case.motion.columns.count - 1), 0.0)
    certificate = ray_of(program)
    require_proof(certificate, program)
    return Bound(None, RAY, None, None, certificate, program)


def _linear(case: Case, cost: np.ndarray, constant: float) -> LinearProgram:
    """Return the program of a linear cost over the runs of a case."""
    inequalities, columns = case.inequalities, case.motion.columns
    return LinearProgram(
        cost=cost,
        constant=constant,
        rows=inequalities.rows[:, 1:],
        limits=inequalities.limits - inequalities.rows[:, 0],
        equal_rows=case.equations[:, 1:],
        equal_values=-case.equations[:, 0],
        low=columns.low,
        high=columns.high,
    )


def _engine_price(case: Case, certificate: Certificate, value: float) -> float:
    """Return the sum of the multipliers of the least engine speeds over the cost `value`."""
    if case.engine.least_speed is None:
        return 0.0
    last = len(case.engine.least_speed) - 1
    return float(certificate.row_multipliers[-last:].sum()) / max(value, 1e-9)
