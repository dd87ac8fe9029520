# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Linear programs with boxed variables; proofs of their bounds, checked without a solver."""

import math
from dataclasses import dataclass

import numpy as np

from ddct_plant.base.errors import DdctError

WEAK_DUALITY, LINEARISED, RAY, CLOSED_FORM = (
    'weak_duality',
    'linearised_weak_duality',
    'farkas_ray',
    'closed_form_of_rigid_car',
)
"""Kinds of proof: of a linear or a convex program, of infeasibility, and without a program."""
_SLACK = 1e-9
"""Largest excess of a claimed bound over the checked one, relative: rounding of sums."""


@dataclass(frozen=True, eq=False)
class LinearProgram:
    """
    Minimise cost z + constant over low <= z <= high, all finite.

    The n variables keep rows z <= limits, m rows, and equal_rows z = equal_values, p equations.
    """

    cost: np.ndarray
    """Cost of each variable, (n,)."""
    constant: float
    rows: np.ndarray
    """Rows of the inequalities, (m, n)."""
    limits: np.ndarray
    """Right-hand sides of the inequalities, (m,)."""
    equal_rows: np.ndarray
    """Rows of the equations, (p, n)."""
    equal_values: np.ndarray
    """Right-hand sides of the equations, (p,)."""
    low: np.ndarray
    high: np.ndarray
    peaks: int = 0
    """Number of the first rows that keep the last variable, a peak, above what it is the peak of;
    a peak that is high enough keeps them all."""


@dataclass(frozen=True, eq=False)
class Certificate:
    """Multipliers that prove a lower bound of a program, or that it has no feasible point."""

    kind: str
    """WEAK_DUALITY or RAY."""
    claim: float
    """Lower bound of the cost; of a ray the least total violation, which is positive."""
    row_multipliers: np.ndarray
    """Multipliers of the inequalities, (m,), not negative."""
    equal_multipliers: np.ndarray
    """Multipliers of the equations, (p,)."""


def certified(
    kind: str, program: LinearProgram, rows: np.ndarray, equal: np.ndarray
) -> Certificate:
    """Return the certificate with the bound that these multipliers prove."""
    rows = np.maximum(rows, 0.0)
    return Certificate(kind, proven(kind, program, rows, equal), rows, equal)


def require_proof(certificate: Certificate, program: LinearProgram) -> None:
    """Raise DdctError where the multipliers do not prove the claim of a certificate."""
    kind, rows, equal = (
        certificate.kind,
        certificate.row_multipliers,
        certificate.equal_multipliers,
    )
    if kind not in (WEAK_DUALITY, RAY) or not math.isfinite(certificate.claim):
        raise DdctError(f'certificate {kind}: its claim {certificate.claim:g} proves nothing')
    if rows.shape != program.limits.shape or equal.shape != program.equal_values.shape:
        raise DdctError(f'certificate {kind}: it has not one multiplier for each row')
    if not np.isfinite([*rows, *equal]).all() or np.min(rows, initial=0.0) < 0.0:
        raise DdctError(f'certificate {kind}: a multiplier of an inequality is below zero')
    found = proven(kind, program, rows, equal)
    if certificate.claim > found + _SLACK * (1.0 + abs(found)):
        raise DdctError(
            f'certificate {kind}: it claims {certificate.claim:g}, but proves {found:g} only'
        )
    if kind == RAY and found <= 0.0:
        raise DdctError('certificate farkas_ray: it does not exclude a feasible point')


def proven(kind: str, program: LinearProgram, rows: np.ndarray, equal: np.ndarray) -> float:
    """
    Return the bound that multipliers y >= 0 of the rows and l of the equations prove.

    For every point of the program y (rows z - limits) + l (equal_rows z - equal_values) <= 0, so
    its cost is at least the least over the box of cost z plus this sum (weak duality). Without the
    cost a positive least proves that there is no such point (Farkas). What the sums may be off by
    rounding is taken off: huge multipliers that should cancel prove nothing.
    """
    positive = rows > 0.0
    # A mask copies all rows.
    used = slice(None) if positive.all() else positive
    slopes = rows[used] @ program.rows[used] + equal @ program.equal_rows
    sizes = rows @ np.abs(program.rows) + np.abs(equal) @ np.abs(program.equal_rows)
    constant = -(rows[used] @ program.limits[used]) - equal @ program.equal_values
    if kind == WEAK_DUALITY:
        slopes, sizes = slopes + program.cost, sizes + np.abs(program.cost)
        constant += program.constant
    least = np.minimum(slopes * program.low, slopes * program.high)
    # A sum of n products is off by at most n u times the sum of their sizes, with u half of the
    # distance from 1 to the next number (Higham, Accuracy and Stability of Numerical Algorithms).
    reach = np.maximum(np.abs(program.low), np.abs(program.high))
    summed = sizes @ reach + rows @ np.abs(program.limits) + np.abs(equal @ program.equal_values)
    terms = len(rows) + len(equal) + len(slopes)
    rounding = terms * np.finfo(float).eps / 2.0 * summed
    return float(constant + least.sum() - rounding)
