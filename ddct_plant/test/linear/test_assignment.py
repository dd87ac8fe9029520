# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The assignment is that of scipy, also where several have the least sum."""

import math

import numpy as np
import pytest
import scipy

from ddct_plant.linear.assignment import least_cost_columns


@pytest.mark.parametrize('kind', ['few integers', 'distances on a line', 'reals', 'forbidden'])
def test_it_is_the_one_of_scipy(kind):
    random = np.random.default_rng(len(kind))
    several = 0
    for _ in range(400):
        rows = int(random.integers(1, 8))
        columns = int(random.integers(rows, 10))
        costs = random.normal(size=(rows, columns))
        if kind == 'few integers':
            costs = random.integers(0, 4, (rows, columns)).astype(float)
        elif kind == 'distances on a line':
            of_rows, of_columns = (
                random.uniform(0.1, 100.0, rows),
                random.uniform(1.0, 50.0, columns),
            )
            costs = np.abs(np.log(of_rows[:, None] / of_columns))
        elif kind == 'forbidden':
            costs[random.uniform(size=costs.shape) < 0.4] = 1e6
        _, expected = scipy.optimize.linear_sum_assignment(costs)
        assert least_cost_columns(costs.tolist()) == expected.tolist()
        others = costs[:, ::-1]
        mirrored = scipy.optimize.linear_sum_assignment(others)[1]
        several += (columns - 1 - mirrored).tolist() != expected.tolist()
    if kind in ('few integers', 'distances on a line'):
        assert several > 20, 'no case has several assignments of least sum'


def test_nothing_is_assigned_where_there_are_no_rows():
    assert least_cost_columns([]) == []


def test_a_row_that_comes_first_does_not_keep_the_column_that_another_needs():
    costs = [[0.0, 1.0, math.log(9.0)], [0.0, 5.0, 5.0], [1.0, 1.0, 5.0]]
    assert least_cost_columns(costs) == [2, 0, 1]
