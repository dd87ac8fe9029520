# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A histogram of durations has percentiles within the width of a bin, and the largest exactly."""

import numpy as np
import pytest

from ddct_plant.ticks.durations import BINS_PER_OCTAVE, LAST_BIN, DurationHistogram, upper_end_us

WIDTH = 2.0 ** (1.0 / BINS_PER_OCTAVE)


@pytest.fixture
def durations_us():
    return np.random.default_rng(1).lognormal(6.0, 1.0, 5000) + 2.0


@pytest.mark.parametrize('percent', [1.0, 50.0, 99.0, 99.9, 100.0])
def test_a_percentile_is_that_of_the_durations_within_a_bin(durations_us, percent):
    histogram = DurationHistogram()
    for each in durations_us:
        histogram.add(each / 1e6)
    exact = np.percentile(durations_us, percent, method='inverted_cdf')
    assert exact <= histogram.percentile_us(percent) * 1.001 <= exact * WIDTH * 1.002
    assert histogram.total == 5000


def test_the_largest_duration_is_exact_to_a_tenth_of_a_us():
    histogram = DurationHistogram()
    for duration_s in (0.0103456, 0.0001):
        histogram.add(duration_s)
    assert histogram.largest_us == histogram.percentile_us(100.0) == 10345.6


def test_any_duration_has_a_bin():
    histogram = DurationHistogram()
    for duration_s in (-1.0, 0.0, 1e-9, 1e9):
        histogram.add(duration_s)
    assert histogram.counts == {0: 3, LAST_BIN: 1}
    assert upper_end_us(LAST_BIN - 1) > 3600e6


def test_without_durations_there_is_no_percentile():
    assert DurationHistogram().percentile_us(50.0) is None
