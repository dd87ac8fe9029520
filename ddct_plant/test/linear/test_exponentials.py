# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Exponentials of a stack: each is that of its matrix alone."""

import numpy as np
import pytest
from scipy.linalg import expm

from ddct_plant.linear.exponentials import exponentials


@pytest.fixture
def matrices():
    """Return (3, 20, 5, 5) matrices of very different sizes."""
    random = np.random.default_rng(7)
    sizes = 10.0 ** random.uniform(-6.0, 1.0, size=(3, 20, 1, 1))
    return sizes * random.normal(size=(3, 20, 5, 5))


def test_exponentials_are_those_of_scipy(matrices):
    ours = exponentials(matrices)
    expected = expm(matrices)
    errors = np.abs(ours - expected).max(axis=(-2, -1)) / np.abs(expected).max(axis=(-2, -1))
    assert ours.shape == matrices.shape
    assert errors.max() < 1e-12


def test_an_exponential_does_not_depend_on_the_rest_of_the_stack(matrices):
    together = exponentials(matrices)
    np.testing.assert_array_equal(exponentials(matrices[1:2, 4:5]), together[1:2, 4:5])


def test_states_of_unlike_units_cost_no_digits():
    units = np.diag([1.0, 1e6, 1e-6])
    calm = np.array([[-0.3, 0.2, 0.1], [0.4, -0.5, 0.6], [-0.7, 0.8, -0.2]])
    scaled = units @ calm @ np.linalg.inv(units)
    ours = np.linalg.inv(units) @ exponentials(scaled[np.newaxis])[0] @ units
    np.testing.assert_allclose(ours, expm(calm), rtol=1e-12)


def test_what_is_not_finite_stays_so():
    matrices = np.zeros((3, 2, 2))
    matrices[0, 0, 1], matrices[2, 1, 1] = np.nan, 1e300
    with np.errstate(all='ignore'):
        ours = exponentials(matrices)
    assert not np.isfinite(ours[0]).all()
    assert not np.isfinite(ours[2]).all()
    np.testing.assert_array_equal(ours[1], np.eye(2))
