# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Nodes started by hand, one program each, without bringup: any order gives the same run."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import pytest
from support.observer import Observing
from support.processes import START_S, Program, Programs
from support.runs import expected, plan
from support.waiting import wait_until

from ddct_bringup.bag.reader import read_bag
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


def test_a_driveline_that_starts_long_before_the_others_waits_for_them(
    programs: Programs, tmp_path: Path
) -> None:
    bag = tmp_path / 'bag'
    with Observing() as observing:
        nodes = _start(programs.start_node, ['driveline'], bag)
        ticks = observing.observer.joints
        wait_until(lambda: observing.listen() and 0 in ticks, 'the first tick', START_S)
    others = [name for name in MODULES if name not in ('driveline', 'recorder')]
    nodes |= _start(programs.start_node, [*others, 'recorder'], bag)
    _finish(nodes)
    assert read_bag(bag).trajectory.sha256() == expected(RUN).sha256()
