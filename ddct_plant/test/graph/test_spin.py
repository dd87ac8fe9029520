# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
A spinning node collects garbage from a timer alone, and as before when it ends.

Nodes of one process end together, each with what had arrived by then.
"""

import gc
import itertools
import weakref
from typing import Any

import pytest
from samples import sampled

pytest.importorskip('rclpy')

from rclpy.task import Future  # noqa: E402
from stepped_time import SteppedTime  # noqa: E402

from ddct_plant.graph.spin import LAST_SLICE_S, SLICE_S, end_of, finish_node, spin_until  # noqa: E402

pytestmark = pytest.mark.slow


@pytest.fixture
def nothing_frozen():
    """Undo what the suite freezes, and freeze it again."""
    gc.unfreeze()
    yield
    gc.freeze()


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


@pytest.mark.parametrize(
    ('fails', 'frozen'), sampled(itertools.product([False, True], repeat=2), every=3)
)
def test_the_garbage_collector_is_set_for_the_run_and_then_as_before(
    monkeypatch, nothing_frozen, fails, frozen
):
    if frozen:
        gc.freeze()
    before = gc.isenabled(), gc.get_freeze_count()
    frozen_at_collections = []
    # A real one would search all that the tests before have loaded.
    monkeypatch.setattr(
        gc, 'collect', lambda: frozen_at_collections.append(gc.get_freeze_count() > 0)
    )
    executor: Any = FakeExecutor(fails)
    try:
        spin_until(executor, Future())
    except RuntimeError:
        assert fails
    assert frozen_at_collections == [frozen], 'it collects before it freezes'
    assert executor.frozen > before[1] or frozen
    assert before[0] and not executor.enabled
    assert gc.isenabled()
    # Frozen objects that nothing refers to any longer are no longer counted.
    assert gc.get_freeze_count() <= before[1] and (gc.get_freeze_count() > 0) == frozen


class FakeNode:
    """Node in virtual time."""

    def __init__(self) -> None:
        self.done = Future()
        self.steady_time = SteppedTime()
        self.events: list[str] = []

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
        node.steady_time.advance((checks - 1) * SLICE_S)
        assert (seen() is None) == (survived == 0 and checks > 1)
        node.steady_time.advance(SLICE_S)
        assert seen() is None
    finally:
        gc.enable()


@pytest.mark.parametrize('ended', [0, 1, 2])
def test_the_end_of_any_node_ends_the_nodes_of_a_process(ended: int) -> None:
    nodes: Any = [FakeNode() for _ in range(3)]
    over = end_of(nodes, lambda: False)
    nodes[0].steady_time.advance(10.0 * SLICE_S)
    assert not over.done()
    nodes[ended].done.set_result(None)
    assert over.done()


class LastMessage:
    """Executor with a message on its way to a node."""

    def __init__(self, node: FakeNode) -> None:
        self._node = node

    def spin_until_future_complete(self, over: Any, _timeout: float) -> None:
        self._node.events.append('received')
        self._node.steady_time.advance(0.9 * LAST_SLICE_S)
        assert not over.done()
        self._node.steady_time.advance(0.1 * LAST_SLICE_S)
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
    assert not node.steady_time.step(), 'no timer of it is left'
