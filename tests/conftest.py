# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Isolate every test: its own ROS domain, and no process of it left behind."""

import os
import signal
import uuid
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from drawn_here import draw_here
from support.processes import TEST_ID, Programs, note_processes, processes_left

from ddct_bringup.api import shell
from ddct_bringup.processes.shared_memory import remove_dead_segments
from ddct_bringup.run.plan import RunPlan
from ddct_plant.graph.domain import own_domain
from ddct_plant.graph.half_made_ports import remove_half_made_ports

if TYPE_CHECKING:
    from support.in_process_graph import InProcessGraph

    from ddct_bringup.logs.log import MeasuredLog


HERE = Path(__file__).parent
MARKERS = dict.fromkeys(
    ('bag', 'docs', 'faults', 'foxglove', 'graph', 'live', 'programs', 'report'), 'graph'
)
MARKERS |= dict.fromkeys(('export', 'fmu'), 'compiler')
"""What the tests of a folder need, beyond Python."""


def pytest_unconfigure(config: pytest.Config) -> None:
    """Remove the shared memory of nodes that the tests have killed; xdist's workers need not."""
    if not hasattr(config, 'workerinput'):
        remove_dead_segments()


def pytest_itemcollected(item: pytest.Item) -> None:
    """Mark a test with what its folder needs, so that a new file cannot forget it."""
    folder = item.path.relative_to(HERE).parts[0]
    if folder in MARKERS:
        item.add_marker(MARKERS[folder])


@pytest.fixture(scope='session', autouse=True)
def drawn_here() -> Iterator[None]:
    """Let no `compare` in this process start another one, which would import what draws anew."""
    with pytest.MonkeyPatch.context() as patch:
        draw_here(patch)
        yield


@pytest.fixture
def no_page(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let programs write a page without its figures, which take longer than the runs."""
    monkeypatch.setattr(shell, 'report_page', lambda *_: 'page')


@pytest.fixture(autouse=True)
def isolated(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Reserve a ROS domain, and fail when a process that the test started is still there."""
    monkeypatch.setenv(TEST_ID, uuid.uuid4().hex)
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    monkeypatch.delenv('ROS_DOMAIN_ID', raising=False)
    note_processes()
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    with own_domain() as domain:
        remove_half_made_ports(domain)  # of nodes that tests before have killed
        yield
    for number, handler in handlers.items():
        signal.signal(number, handler)
    left = processes_left()
    for pid in left:
        os.kill(pid, signal.SIGKILL)
    assert not left, f'left behind: {left}'


@pytest.fixture
def programs(tmp_path: Path) -> Iterator[Programs]:
    """Start programs; those of a failed test are killed."""
    started = Programs(tmp_path / 'printed')
    yield started
    started.kill()


@pytest.fixture
def graph_of(tmp_path: Path) -> Iterator[Callable[..., 'InProcessGraph']]:
    """Return a function that prepares a graph in this process for a plan."""
    # The other tests need no ROS.
    from support.in_process_graph import InProcessGraph

    graphs: list[InProcessGraph] = []

    def make(plan: RunPlan, **options: bool) -> 'InProcessGraph':
        graphs.append(InProcessGraph(plan, tmp_path / f'graph{len(graphs)}', **options))
        return graphs[-1]

    yield make
    for graph in graphs:
        graph.close()


@pytest.fixture(scope='module')
def pi_log(tmp_path_factory: pytest.TempPathFactory) -> 'MeasuredLog':
    """Return the log of a run with PI control."""
    # Most tests need no log.
    from support.logs import drive_log

    return drive_log(tmp_path_factory.mktemp('pi'))
