# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Nodes started by hand, one program each, without bringup: any order gives the same run."""

import random
from collections.abc import Mapping
from pathlib import Path

import pytest
from support.nodes_by_hand import MODULES, RUN, finish_nodes, start_nodes
from support.observer import Observing
from support.processes import Program, Programs, ros_arguments
from support.runs import bag_bytes, expected, record
from waiting import wait_until

pytestmark = pytest.mark.slow


def test_nodes_in_random_order_leave_the_bag_that_bringup_leaves(
    programs: Programs, tmp_path: Path
) -> None:
    names = list(MODULES)
    random.Random(1).shuffle(names)

    def start(module: str, parameters: Mapping[str, object]) -> Program:
        return programs.start_module(module, *ros_arguments(parameters))

    finish_nodes(start_nodes(start, names, tmp_path / 'by_hand'))
    record(RUN, tmp_path / 'by_bringup')
    assert bag_bytes(tmp_path / 'by_hand') == bag_bytes(tmp_path / 'by_bringup')


def test_nodes_without_a_recorder_run_the_same_trajectory(programs: Programs) -> None:
    names = [name for name in MODULES if name not in ('recorder', 'driveline')]
    random.Random(2).shuffle(names)
    with Observing() as observing:
        # The run must not be over before the observer, for which no node waits, has joined it.
        nodes = start_nodes(programs.start_node, [*names[:3], 'driveline', *names[3:-1]], None)
        ticks = observing.observer.joints
        wait_until(lambda: observing.listen() and 0 in ticks, 'the first tick')
        nodes |= start_nodes(programs.start_node, names[-1:], None)
        driveline = nodes['driveline'].process
        wait_until(lambda: observing.listen() and driveline.poll() is not None, 'the end')
        replies = observing.observer.clutch_torque
        wait_until(lambda: observing.listen() and RUN.steps in replies, 'the last reply')
        finish_nodes(nodes)
        observing.observer.require_same(expected(RUN))
        assert len(observing.observer.joints) > 50
