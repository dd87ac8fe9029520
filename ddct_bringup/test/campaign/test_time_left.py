# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Remaining time of a campaign: controllers differ, and each is measured soon."""

from pathlib import Path
from typing import Any

import pytest

from ddct_bringup.campaign.shards import ShardJob, TimeLeft, each_controller_first

UNUSED: Any = None


def job(first: int, last: int) -> ShardJob:
    return ShardJob(UNUSED, UNUSED, '', '', first, last)


def test_before_the_first_shard_there_is_no_estimate() -> None:
    assert TimeLeft(100).left_s([job(0, 10)], 2) is None


def test_each_controller_counts_by_its_own_shards() -> None:
    left = TimeLeft(100)
    left.add(job(0, 10), 1.0)  # a fast controller, 0.1 s a run
    left.add(job(100, 110), 50.0)  # a slow one, 5 s a run
    missing = [job(10, 100), job(110, 200)]
    assert left.left_s(missing, 1) == pytest.approx(9.0 + 450.0)
    assert left.left_s(missing, 4) == pytest.approx((9.0 + 450.0) / 4)
    assert left.left_s([job(110, 200)], 1) == pytest.approx(450.0)


def test_a_shard_over_two_controllers_counts_for_both() -> None:
    left = TimeLeft(100)
    left.add(job(0, 50), 50.0)
    left.add(job(150, 200), 250.0)
    assert left.left_s([job(90, 110)], 1) == pytest.approx(10 * 1.0 + 10 * 5.0)


def test_a_controller_that_is_not_measured_yet_counts_like_the_mean_of_the_others() -> None:
    left = TimeLeft(100)
    left.add(job(0, 10), 10.0)
    left.add(job(100, 110), 30.0)
    assert left.left_s([job(200, 210)], 1) == pytest.approx(20.0)


def test_the_first_shard_of_each_controller_comes_first() -> None:
    shards = {Path(f'{first}'): job(first, first + 40) for first in range(0, 300, 40)}
    order = [path.name for path in each_controller_first(shards, 100)]
    assert order == ['0', '120', '200', '40', '80', '160', '240', '280']
    assert sorted(order, key=int) == [path.name for path in shards]
