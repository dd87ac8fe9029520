# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A spinning node restores the settings of the garbage collector when it ends."""

import gc
from typing import Any

import pytest

pytest.importorskip('rclpy')

from rclpy.task import Future  # noqa: E402

from ddct_plant.graph.spin import spin_until  # noqa: E402


class FakeExecutor:
    """Executor that stores the garbage collector's settings during a spin, and ends the spin."""

    def __init__(self, fails=False):
        self.fails = fails
        self.frozen = 0
        self.threshold: tuple[int, ...] = ()

    def spin_until_future_complete(self, over, _timeout):
        self.frozen, self.threshold = gc.get_freeze_count(), gc.get_threshold()
        if self.fails:
            raise RuntimeError('no more')
        over.set_result(None)


@pytest.mark.parametrize('fails', [False, True])
def test_the_garbage_collector_is_set_for_the_run_and_then_as_before(fails):
    before = gc.get_threshold(), gc.get_freeze_count()
    executor: Any = FakeExecutor(fails)
    try:
        spin_until(executor, Future())
    except RuntimeError:
        assert fails
    assert executor.frozen > before[1]
    assert executor.threshold[0] > before[0][0]
    assert (gc.get_threshold(), gc.get_freeze_count()) == before
