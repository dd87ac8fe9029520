# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Virtual time fires exactly the timers that are due; warnings and nodes follow it."""

from typing import Any

import pytest

pytest.importorskip('rclpy')

from stepped_time import SteppedTime  # noqa: E402

from ddct_plant.graph.rare_warnings import PERIOD_S, RareWarnings  # noqa: E402


@pytest.fixture
def fired():
    return []


@pytest.fixture
def time(fired):
    time = SteppedTime()
    for period_s in (0.01, 0.025):
        time.every(None, period_s, lambda period_s=period_s: fired.append(period_s))
    return time


def test_exactly_the_due_timers_fire_in_their_order(time, fired):
    time.advance(0.0099)
    assert fired == []
    time.advance(0.0001)
    assert fired == [0.01]
    time.advance(0.04)
    assert fired == [0.01, 0.01, 0.025, 0.01, 0.01, 0.01, 0.025]
    assert time.monotonic() == pytest.approx(0.05, abs=1e-8)


def test_a_jump_fires_each_timer_once_and_the_next_is_a_whole_number_of_periods_later(time, fired):
    time.jump(20.004)
    assert fired == [0.01, 0.025]
    time.advance(0.005)
    assert fired == [0.01, 0.025]
    time.advance(0.001)
    assert fired == [0.01, 0.025, 0.01]


def test_a_step_goes_to_the_next_timer_and_a_cancelled_one_is_never_due():
    time, fired = SteppedTime(), []

    def once():
        fired.append(round(time.monotonic(), 6))
        timer.cancel()

    timer = time.every(None, 0.0, once)
    assert time.step()
    assert not time.step()
    assert fired == [0.0]


def test_a_timer_that_is_made_by_another_is_due_a_period_later():
    time = SteppedTime()
    fired: list[float] = []

    def first():
        timer.cancel()
        time.every(None, 0.1, lambda: fired.append(round(time.monotonic(), 6)))

    timer = time.every(None, 1.0, first)
    time.advance(1.25)
    assert fired == [1.1, 1.2]


def test_at_most_one_warning_a_second_is_logged():
    time = SteppedTime()
    logged: list[str] = []

    class Log:
        def get_logger(self):
            return self

        def warning(self, text):
            logged.append(text)

    node: Any = Log()
    warnings = RareWarnings(node, time.monotonic)
    for number in range(25):
        warnings.warn(str(number))
        time.advance(0.1 * PERIOD_S)
    assert logged == ['0', '10', '20']
