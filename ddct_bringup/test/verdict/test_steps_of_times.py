# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The time of a step is converted to that step, independent of the rounding of the division."""

import numpy as np

from ddct_bringup.metrics.lockup import step_at
from ddct_plant.base.timebase import PERIOD_S, time_of_step


def test_the_time_of_a_step_is_that_step():
    off_the_grid = [k for k in range(100_000) if time_of_step(k) / PERIOD_S > k]
    assert off_the_grid, 'there are times whose division ends above the step'
    steps = np.arange(100_000)
    assert (step_at(np.array([time_of_step(k) for k in range(100_000)]), never=-1) == steps).all()


def test_a_time_after_a_step_is_the_next_one():
    times = 0.57 + np.array([1e-6, 0.005, 0.0099, np.nan])
    assert step_at(times, never=-1).tolist() == [58, 58, 58, -1]
