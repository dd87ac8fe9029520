# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The nodes of a single process end in order: the owner of time first, the recorder last."""

from typing import Any

import pytest

pytest.importorskip('rclpy')

from rclpy.task import Future  # noqa: E402

from ddct_bringup.processes import single_process  # noqa: E402
from ddct_bringup.processes.graph_nodes import GRAPH_NODES, all_nodes, nodes_of, nodes_of_process  # noqa: E402
from ddct_plant.base.errors import DdctError  # noqa: E402

NAMES = [spec.name for spec in GRAPH_NODES]


class FakeNode:
    """Node that records the order in which nodes are closed."""

    def __init__(self, name: str, closed: list[str]) -> None:
        self.done = Future()
        self._name, self._closed = name, closed

    def get_fully_qualified_name(self) -> str:
        return f'/{self._name}'

    def finish(self, error: Exception | None = None) -> None:
        if not self.done.done():
            self.done.set_result(error)

    def destroy_node(self) -> None:
        self.close()

    def close(self) -> None:
        self._closed.append(self._name)


class FakeExecutor:
    def add_node(self, node: FakeNode) -> None:
        pass

    def shutdown(self) -> None:
        pass


@pytest.fixture
def closed() -> list[str]:
    """Return the names of the nodes that were closed, in order."""
    return []


@pytest.fixture
def spin(monkeypatch, closed):
    """Return a function that spins fake nodes until one of them ends."""
    nodes: Any = [FakeNode(name, closed) for name in NAMES]
    monkeypatch.setattr(single_process, 'make_executor', lambda _: FakeExecutor())
    monkeypatch.setattr(single_process, 'finish_node', lambda _, node: node.close())
    monkeypatch.setattr(single_process, 'end_of', lambda *_: Future())

    def run(ends: str, error: Exception | None = None) -> None:
        ended = nodes[NAMES.index(ends)]
        monkeypatch.setattr(single_process, 'spin_until', lambda *_: ended.finish(error))
        single_process._spin(nodes, None, lambda: False)

    return run


def test_the_driveline_is_closed_first_and_the_recorder_last(spin, closed):
    assert (NAMES[0], NAMES[-1]) == ('recorder', 'driveline')
    spin('driveline')
    assert closed == NAMES[::-1]


def test_after_a_failure_they_are_closed_in_that_order_too(spin, closed):
    with pytest.raises(DdctError, match='node clutch: no capacity'):
        spin('clutch', DdctError('no capacity'))
    assert closed == NAMES[::-1]


@pytest.mark.parametrize('shift', [False, True])
def test_the_process_of_all_nodes_runs_those_of_the_run(shift):
    spec = all_nodes(shift=shift)
    assert nodes_of_process([*spec.arguments, '--ros-args']) == nodes_of(shift=shift)
    assert spec.title == 'the process of all nodes'


def test_an_interruption_ends_the_run_before_the_next_node_is_built(monkeypatch, closed):
    monkeypatch.setattr(single_process, 'init_ros', lambda *_: None)
    monkeypatch.setattr(single_process, '_build', lambda spec, *_: FakeNode(spec.name, closed))
    stops = iter([False, False, True])
    with pytest.raises(KeyboardInterrupt):
        single_process.run_single_process(GRAPH_NODES, [], lambda: next(stops))
    assert closed == NAMES[:2]
