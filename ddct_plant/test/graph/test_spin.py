# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
A spinning node collects garbage from a timer alone, and as before when it ends.

Nodes of one process end together, each with what had arrived by then.
"""

import gc
import weakref
from typing import Any

import pytest

pytest.importorskip('rclpy')

from rclpy.task import Future  # noqa: E402

from ddct_plant.graph.spin import end_of, finish_node, spin_until  # noqa: E402


class FakeExecutor:
    """Executor that stores the garbage collector's settings during a spin, and ends the spin."""

    def __init__(self, fails=False):
        self.fails = fails
        self.frozen = 0
        self.enabled = True

    def spin_until_future_complete(self, over, _timeout):
        self.frozen, self.enabled = gc.get_freeze_count(), gc.isenabled()
        if self.fails:
            raise RuntimeError('no more')
        over.set_result(None)


@pytest.mark.parametrize('frozen', [False, True])
@pytest.mark.parametrize('fails', [False, True])
def test_the_garbage_collector_is_set_for_the_run_and_then_as_before(fails, frozen):
    gc.unfreeze()
    if frozen:
        gc.freeze()
    before = gc.isenabled(), gc.get_freeze_count()
    executor: Any = FakeExecutor(fails)
    try:
        spin_until(executor, Future())
    except RuntimeError:
        assert fails
    assert executor.frozen > before[1] or frozen
    assert before[0] and not executor.enabled
    assert gc.isenabled()
    # Frozen objects that nothing refers to any longer are no longer counted.
    assert gc.get_freeze_count() <= before[1] and (gc.get_freeze_count() > 0) == frozen


class FakeNode:
    """Node whose timer is called by the test."""

    def __init__(self) -> None:
        self.done = Future()
        self.steady_clock = None
        self.check: Any = None
        self.events: list[str] = []

    def create_timer(self, _period: float, callback: Any, **_options: Any) -> None:
        self.check = callback

    def destroy_timer(self, _timer: None) -> None:
        self.check = None

    def close(self) -> None:
        self.events.append('closed')


class Cycle:
    """Object that refers to itself."""

    def __init__(self) -> None:
        self.itself = self


@pytest.mark.parametrize(('survived', 'checks'), [(0, 1), (1, 10), (2, 100)])
def test_the_timer_collects_garbage_of_every_age(survived: int, checks: int) -> None:
    node: Any = FakeNode()
    end_of([node], lambda: False)
    gc.disable()
    try:
        cycle = Cycle()
        for generation in range(survived):
            gc.collect(generation)
        seen = weakref.ref(cycle)
        del cycle
        for _ in range(checks - 1):
            node.check()
        assert (seen() is None) == (survived == 0 and checks > 1)
        node.check()
        assert seen() is None
    finally:
        gc.enable()


@pytest.mark.parametrize('ended', [0, 1, 2])
def test_the_end_of_any_node_ends_the_nodes_of_a_process(ended: int) -> None:
    nodes: Any = [FakeNode() for _ in range(3)]
    over = end_of(nodes, lambda: False)
    nodes[0].check()
    assert not over.done()
    nodes[ended].done.set_result(None)
    assert over.done()


class LastMessage:
    """Executor with a message on its way to a node."""

    def __init__(self, node: FakeNode) -> None:
        self._node = node

    def spin_until_future_complete(self, over: Any, _timeout: float) -> None:
        self._node.events.append('received')
        self._node.check()
        assert over.done()


@pytest.mark.parametrize('has_ended', [False, True])
def test_a_stopped_node_receives_what_is_on_its_way_and_every_node_is_flushed(
    has_ended: bool,
) -> None:
    """A node that has ended by itself takes no more messages."""
    node: Any = FakeNode()
    if has_ended:
        node.done.set_result(None)
    executor: Any = LastMessage(node)
    finish_node(executor, node)
    assert node.events == (['closed'] if has_ended else ['received', 'closed'])
    assert node.check is None
