# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The time of a step is converted to that step, independent of the rounding of the division."""

from ddct_bringup.metrics.lockup import step_at
from ddct_plant.base.timebase import PERIOD_S, time_of_step


def test_the_time_of_a_step_is_that_step():
    off_the_grid = [k for k in range(100_000) if time_of_step(k) / PERIOD_S > k]
    assert off_the_grid, 'there are times whose division ends above the step'
    assert [k for k in range(100_000) if step_at(time_of_step(k)) != k] == []


def test_a_time_after_a_step_is_the_next_one():
    assert [step_at(0.57 + after) for after in (1e-6, 0.005, 0.0099)] == [58, 58, 58]
