# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A histogram of durations has percentiles within the width of a bin, and the largest exactly."""

import numpy as np
import pytest

from ddct_plant.ticks.durations import (
    BINS_PER_OCTAVE,
    LAST_BIN,
    DurationHistogram,
    TickDurations,
    checked,
    upper_end_us,
)

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


def test_durations_of_the_first_and_the_last_bin_are_read_back_from_their_text():
    histogram = DurationHistogram()
    for duration_s in (0.0, 1e9):
        histogram.add(duration_s)
    assert DurationHistogram.of(histogram.text()) == histogram


@pytest.mark.parametrize('place', [-1, LAST_BIN + 1])
def test_a_count_beyond_the_bins_is_impossible(place):
    with pytest.raises(ValueError, match=f'bin {place} has the count 1'):
        checked(1.0, {place: 1})


def test_without_durations_there_is_no_percentile():
    assert DurationHistogram().percentile_us(50.0) is None


class Clock:
    """Steady clock that a test sets, s."""

    now = 0.0

    def __call__(self):
        return self.now


def published(steps_and_times):
    """Return the durations of ticks of 10 ms that were published at these times, and the clock."""
    clock = Clock()
    durations = TickDurations(clock, 0.01)
    for step, clock.now in steps_and_times:
        durations.publish(step, late_s=0.001 * step)
    return durations, clock


def largest_us(durations):
    """Return by name the largest duration, of those that have any."""
    return {name: each.largest_us for name, each in durations.histograms.items() if each.total}


def test_the_jitter_is_the_difference_of_a_period_from_its_length_in_either_direction():
    durations, _ = published([(1, 5.0), (2, 5.012), (3, 5.0215)])
    assert durations.histograms['jitter'].total == 2
    assert largest_us(durations) == pytest.approx({'lateness': 3000.0, 'jitter': 2000.0})


def test_a_tick_after_others_that_were_not_published_has_no_jitter():
    durations, _ = published([(1, 5.0), (4, 5.03)])
    assert durations.histograms['jitter'].total == 0
    assert durations.histograms['lateness'].total == 2


def test_the_latency_is_from_the_publication_of_the_tick_that_is_answered():
    durations, clock = published([(1, 5.0), (2, 5.01)])
    clock.now = 5.017
    durations.answer(1)
    assert largest_us(durations)['latency'] == pytest.approx(17000.0)


@pytest.mark.parametrize(('step', 'ticks'), [(1, 2000), (3000, 2000), (-1, 3), (-1, 2000)])
def test_a_reply_to_no_tick_that_is_remembered_has_no_latency(step, ticks):
    """One is forgotten after some ten seconds, one is not yet published, one is before t_0."""
    durations, _ = published([(each, 0.01 * each) for each in range(1, ticks + 1)])
    durations.answer(step)
    assert durations.histograms['latency'].total == 0
