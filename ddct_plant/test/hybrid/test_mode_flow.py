# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The series of a mode is exact for couplings of any size, in units that only make it shorter."""

from decimal import Decimal, localcontext

import numpy as np
import pytest
from numpy.polynomial import Polynomial

from ddct_plant.base.errors import ParameterError
from ddct_plant.hybrid.friction_system import FrictionSystem
from ddct_plant.hybrid.mode_flow import LONGEST, HeldElements, ModeFlow, balanced


def norm(matrix: np.ndarray) -> float:
    return float(np.linalg.norm(matrix, 1))


def exponential(a: np.ndarray) -> np.ndarray:
    """Return exp(a) (n, n) by its series with 80 digits."""
    with localcontext() as context:
        context.prec = 80
        exact, one = (
            np.array([[Decimal(x) for x in row] for row in matrix.tolist()])
            for matrix in (a, np.eye(len(a)))
        )
        term = total = one
        order = 0
        while np.abs(term).max() > Decimal('1e-45'):
            order += 1
            term = term.dot(exact) / order
            total = total + term
        return total.astype(float)


def slipping(a: np.ndarray) -> ModeFlow:
    """Return the flow over 1 s of `a` (n, n) beside an element on the ground, which slips."""
    size = len(a)
    h = np.eye(size + 1)[-1:]
    system = FrictionSystem(np.pad(a, (0, 1)), np.zeros((size + 1, 0)), -h.T, h)
    return ModeFlow(HeldElements(system, (False,), 1.0), (1,))


def random_rates(seed: int) -> np.ndarray:
    """Return rates (n, n) from 0.01 to 60, many of them zero or far smaller, down to 1e-20."""
    random = np.random.default_rng(seed)
    size = random.integers(2, 7)
    shape = size, size
    rates = random.choice([-1.0, 1.0], shape) * 10.0 ** random.uniform(-2.0, 1.8, shape)
    rates *= random.choice([0.0, 1.0, 1.0], shape)
    small = 10.0 ** random.uniform(-20.0, 0.0, shape)
    rates = np.where(random.random(shape) < 0.5, small * rates, rates)
    if random.random() < 0.5:
        rates[:, random.integers(size)] *= 10.0 ** random.uniform(-20.0, 0.0)
    return rates


@pytest.mark.parametrize('part', range(4))
def test_the_series_is_exact_and_its_bound_no_larger_than_the_norm(part):
    accepted = 0
    for seed in range(100 * part, 100 * part + 100):
        rates = random_rates(seed)
        bound = norm(balanced(rates))
        assert bound <= norm(rates)
        assert max(abs(np.linalg.eigvals(rates))) <= (1.0 + 1e-9) * bound + 1e-12
        if bound > LONGEST:
            with pytest.raises(ParameterError, match='take pieces of at most'):
                slipping(rates)
            continue
        end = slipping(rates).end[: len(rates), : len(rates)]
        assert norm(end - exponential(rates)) <= 2e-15 * norm(exponential(np.abs(rates)))
        accepted += 1
    assert accepted >= 30


@pytest.mark.parametrize('coupling', [1e-300, 1e-60, 1e-12, 1e-4])
def test_an_angle_counts_where_its_speed_drives_hardly_anything_else(coupling):
    """The speed x_0 is driven by 70 x_1 and drives x_1 by `coupling`, and an angle x_2."""
    rates = np.array([[0.0, 70.0, 0.0], [coupling, 0.0, 0.0], [1e-3, 0.0, 0.0]])
    assert norm(balanced(rates)) < 1.0
    assert norm(slipping(rates).end[:3, :3] - exponential(rates)) < 2e-14


def test_guards_are_checked_at_the_nodes_of_a_piece_and_on_their_tangents_halfway():
    """Of an oscillator of 1.41 rad/s whose mass slips on the ground, over 1 s."""
    column = np.array([[0.0], [1.0]])
    oscillator = np.array([[0.0, 1.0], [-2.0, 0.0]])
    system = FrictionSystem(oscillator, np.zeros((2, 0)), -column, column.T)
    flow = ModeFlow(HeldElements(system, (False,), 1.0), (1,))
    assert flow.steps == 5
    course = flow.course(np.array([1.0, 0.3]), np.array([0.2, 0.1]))
    guard = Polynomial(course.guards[0])
    half = guard.deriv() / 10.0
    expected = []
    for node in range(5):
        first, last = node / 5.0, (node + 1) / 5.0
        expected += [guard(first), guard(first) + half(first), guard(last) - half(last)]
    checks = flow.guard_checks()[:, 0] @ course.y
    assert checks == pytest.approx([*expected, guard(1.0)], rel=1e-12)
