# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Zeros and maxima in several intervals are those of the function."""

import numpy as np
import pytest

from ddct_controllers.design.analysis.refinement import maxima, zeros


def test_a_zero_is_found_in_each_interval_where_the_sign_changes():
    low = np.pi * np.arange(1, 6) - 0.3
    high = low + 1.0
    found = zeros(np.sin, low, high, np.sin(low), np.sin(high))
    np.testing.assert_allclose(found, np.pi * np.arange(1, 6), rtol=1e-12)


@pytest.mark.parametrize('root', [1.0, 1.0 + 1e-9, 1.5, 2.0 - 1e-9])
def test_a_zero_near_an_end_and_a_steep_one_are_found(root):
    def steep(x: np.ndarray) -> np.ndarray:
        return np.tanh(1e6 * (x - root))

    low, high = np.array([1.0]), np.array([2.0])
    (found,) = zeros(steep, low, high, steep(low), steep(high))
    assert found == pytest.approx(root, rel=1e-11)


def test_a_jump_is_found_where_the_sign_changes():
    def jump(x: np.ndarray) -> np.ndarray:
        return np.where(x < np.sqrt(2.0), -3.0, 0.5)

    low, high = np.array([1.0]), np.array([2.0])
    (found,) = zeros(jump, low, high, jump(low), jump(high))
    assert found == pytest.approx(np.sqrt(2.0), rel=1e-11)


@pytest.mark.parametrize('scale', [1e-3, -1e-3, 1e3, -1e3])
def test_a_smooth_zero_takes_few_values_whatever_their_sign_and_unit(scale):
    """Ridders' method doubles the digits in a step; halving the interval takes 40 steps."""
    asked = []

    def smooth(x: np.ndarray) -> np.ndarray:
        asked.append(x)
        return scale * (np.exp(x) - 2.0)

    low, high = np.array([0.1]), np.array([1.0])
    at_low, at_high = smooth(low), smooth(high)
    (found,) = zeros(smooth, low, high, at_low, at_high)
    assert found == pytest.approx(np.log(2.0), rel=1e-12)
    assert len(asked) <= 14


def test_the_maximum_is_found_in_each_interval():
    centres = np.array([0.5, 3.0, 40.0])

    def resonances(x: np.ndarray) -> np.ndarray:
        distance = (x[..., np.newaxis] - centres) / (1e-3 * centres)
        return (1.0 / (1.0 + distance**2)).max(axis=-1)

    places, values = maxima(resonances, 0.99 * centres, 1.02 * centres)
    np.testing.assert_allclose(places, centres, rtol=1e-7)
    np.testing.assert_allclose(values, 1.0, rtol=1e-9)


def test_no_interval_has_no_zero_and_no_maximum():
    none = np.zeros(0)
    assert not zeros(np.sin, none, none, none, none).size
    assert not maxima(np.sin, none, none)[0].size
