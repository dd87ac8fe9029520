# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Least squares in a box: the least one, its proof by its own multipliers, and rows that wait."""

import numpy as np
import pytest
import scipy

from ddct_bringup.floor.program.linear_program import WEAK_DUALITY, LinearProgram, certified
from ddct_bringup.floor.program.quadratic import least_squares


def problem(seed):
    """Return target, offset, box, rows, limits and equations, which the origin keeps."""
    random = np.random.default_rng(seed)
    n = 8
    return [
        random.normal(size=(12, n)),
        random.normal(size=12),
        np.full(n, -0.4),
        np.full(n, 0.4),
        random.normal(size=(15, n)),
        random.uniform(0.05, 0.5, size=15),
        random.normal(size=(1, n)),
        np.zeros(1),
    ]


def solved(given, centre, **options):
    """Return the least squares of a problem."""
    arguments = [*given, centre]
    return least_squares(*arguments, **options)


def linearised(given, point):
    """Return the program whose cost is the slope of the sum of squares at a point."""
    target, offset, low, high, rows, limits, equal_rows, equal_values = given
    left = target @ point + offset
    slope = 2.0 * target.T @ left
    constant = float(left @ left - slope @ point)
    return LinearProgram(slope, constant, rows, limits, equal_rows, equal_values, low, high)


@pytest.mark.parametrize('seed', range(10))
def test_the_multipliers_of_the_least_squares_prove_them(seed):
    given = problem(seed)
    found = solved(given, np.zeros(8), steps=3)
    program = linearised(given, found.point)
    square = float(program.cost @ found.point + program.constant)
    assert np.all(program.rows @ found.point <= program.limits + 1e-3)
    claim = certified(WEAK_DUALITY, program, found.rows, found.equal).claim
    assert claim == pytest.approx(square, rel=1e-3)
    target, offset, low, high, rows, limits, equal_rows, _ = given
    other = scipy.optimize.minimize(
        lambda z: np.sum((target @ z + offset) ** 2),
        np.zeros(8),
        jac=lambda z: 2.0 * target.T @ (target @ z + offset),
        bounds=list(zip(low, high, strict=True)),
        constraints=[
            {'type': 'ineq', 'fun': lambda z: limits - rows @ z},
            {'type': 'eq', 'fun': lambda z: equal_rows @ z},
        ],
        method='SLSQP',
    )
    assert other.success
    assert claim <= other.fun * (1.0 + 1e-6)


def test_further_steps_undo_what_keeps_the_point_near_its_centre():
    given = problem(3)
    centre = np.full(8, 0.3)
    target, offset = given[:2]

    def square(curvature, steps):
        found = solved(given, centre, curvature=curvature, steps=steps)
        return float(np.sum((target @ found.point + offset) ** 2))

    squares = [square(0.3, steps) for steps in (0, 2, 30)]
    exact = square(1e-7, 0)
    assert squares[0] > squares[1] > exact
    assert squares[2] == pytest.approx(exact, rel=1e-6)


def test_rows_that_were_used_come_first_and_change_no_point():
    given = problem(4)
    cold = solved(given, np.zeros(8))
    assert cold.used.any() and not cold.used.all()
    again = solved(given, np.zeros(8), used=cold.used)
    assert np.array_equal(again.used, cold.used)
    assert again.point == pytest.approx(cold.point, abs=1e-9)


def test_where_nothing_has_an_effect_the_centre_is_the_point():
    given = problem(5)
    found = solved([np.zeros((12, 8)), *given[1:]], np.full(8, 0.1))
    assert found.point == pytest.approx(np.full(8, 0.1))
    assert not found.rows.any() and not found.equal.any()


def test_rows_that_exclude_each_other_have_no_point():
    given = problem(6)
    given[4], given[5] = np.vstack([np.eye(8), -np.eye(8)]), np.full(16, -0.1)
    assert solved(given, np.zeros(8), used=np.ones(16, dtype=bool)) is None
