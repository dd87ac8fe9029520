# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Samples of lateness and latency of the ticks of a real-time run."""

import pytest

from ddct_plant.ticks.durations import TickDurations


class Clock:
    """Steady clock that a test sets, s."""

    now = 0.0

    def __call__(self):
        return self.now


@pytest.fixture
def clock():
    return Clock()


def published(clock, times):
    """Return the durations of ticks from step 1 on that were published at these times."""
    durations = TickDurations(clock)
    for step, clock.now in enumerate(times, start=1):
        durations.publish(late_s=0.001 * step)
    return durations


def test_the_lateness_is_a_sample_for_each_tick(clock):
    assert published(clock, [5.0, 5.012, 5.0215]).lateness == [0.001, 0.002, 0.003]


def test_the_latency_is_from_the_publication_of_the_tick_that_is_answered(clock):
    durations = published(clock, [5.0, 5.01])
    for clock.now, step in ((5.017, 1), (5.018, 2), (5.019, 2)):
        durations.answer(step)
    assert durations.latency == pytest.approx([0.017, 0.008, 0.009])


@pytest.mark.parametrize('step', [0, -1, 4, 3000])
def test_a_reply_to_no_published_tick_has_no_latency(clock, step):
    durations = published(clock, [5.0, 5.01, 5.02])
    durations.answer(step)
    assert durations.latency == []


def test_samples_are_taken_once_and_later_replies_are_samples_of_the_next_time(clock):
    durations = published(clock, [5.0, 5.01])
    clock.now = 5.0125
    durations.answer(1)
    assert durations.take() == ([0.001, 0.002], pytest.approx([0.0125]))
    assert durations.take() == ([], [])
    durations.publish(late_s=0.003)
    durations.answer(2)
    assert durations.take() == ([0.003], pytest.approx([0.0025]))
