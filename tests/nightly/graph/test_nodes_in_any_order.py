# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Nodes started by hand, one program each, without bringup: any order gives the same run."""

import random
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import pytest
from support.observer import Observing
from support.processes import START_S, Program, Programs, ros_arguments
from support.runs import bag_bytes, expected, plan, record
from support.waiting import wait_until

from ddct_bringup.processes.graph_nodes import GRAPH_NODES

pytestmark = pytest.mark.slow

RUN = plan(layout='headless', duration_s=3.0)
"""Run of nodes whose only parameter is the controller `ls8`."""
Start = Callable[[str, Mapping[str, object]], Program]
MODULES = {spec.name: spec.module for spec in GRAPH_NODES}


def _start(start: Start, names: Sequence[str], bag: Path | None) -> dict[str, Program]:
    """Start nodes with the defaults of bringup, a controller and a recorder if `bag` is given."""
    own: dict[str, dict[str, object]] = {
        'controller': {'controller': 'ls8'},
        'driveline': {'require_recorder': bag is not None},
        'recorder': {'out': bag, 'name': 'ls8'},
    }
    return {name: start(MODULES[name], own.get(name, {})) for name in names}


def _finish(nodes: dict[str, Program]) -> None:
    """Wait for the driveline, then stop the others, the recorder last; all must end with 0."""
    assert nodes['driveline'].wait() == 0, nodes['driveline'].errors()
    for name in sorted(nodes, key=lambda name: name == 'recorder'):
        if name != 'driveline':
            nodes[name].stop()


def test_nodes_in_random_order_leave_the_bag_that_bringup_leaves(
    programs: Programs, tmp_path: Path
) -> None:
    names = list(MODULES)
    random.Random(1).shuffle(names)

    def start(module: str, parameters: Mapping[str, object]) -> Program:
        return programs.start_module(module, *ros_arguments(parameters))

    _finish(_start(start, names, tmp_path / 'by_hand'))
    record(RUN, tmp_path / 'by_bringup')
    assert bag_bytes(tmp_path / 'by_hand') == bag_bytes(tmp_path / 'by_bringup')


def test_nodes_without_a_recorder_run_the_same_trajectory(programs: Programs) -> None:
    names = [name for name in MODULES if name not in ('recorder', 'driveline')]
    random.Random(2).shuffle(names)
    with Observing() as observing:
        # The run must not be over before the observer, for which no node waits, has joined it.
        nodes = _start(programs.start_node, [*names[:3], 'driveline', *names[3:-1]], None)
        ticks = observing.observer.joints
        wait_until(lambda: observing.listen() and 0 in ticks, 'the first tick', START_S)
        nodes |= _start(programs.start_node, names[-1:], None)
        driveline = nodes['driveline'].process
        wait_until(lambda: observing.listen() and driveline.poll() is not None, 'the end', START_S)
        replies = observing.observer.clutch_torque
        wait_until(lambda: observing.listen() and RUN.steps in replies, 'the last reply', START_S)
        _finish(nodes)
        observing.observer.require_same(expected(RUN))
        assert len(observing.observer.joints) > 50
