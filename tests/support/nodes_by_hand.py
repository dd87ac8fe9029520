# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Nodes started one program each, without bringup."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from ddct_bringup.processes.graph_nodes import GRAPH_NODES
from support.processes import Program
from support.runs import plan

RUN = plan(layout='headless', duration_s=3.0)
"""Run of nodes whose only parameter is the controller `ls8`."""
Start = Callable[[str, Mapping[str, object]], Program]
MODULES = {spec.name: spec.module for spec in GRAPH_NODES}


def start_nodes(start: Start, names: Sequence[str], bag: Path | None) -> dict[str, Program]:
    """Start nodes with the defaults of bringup, a controller and a recorder if `bag` is given."""
    own: dict[str, dict[str, object]] = {
        'controller': {'controller': 'ls8'},
        'driveline': {'require_recorder': bag is not None},
        'recorder': {'out': bag, 'name': 'ls8'},
    }
    return {name: start(MODULES[name], own.get(name, {})) for name in names}


def finish_nodes(nodes: dict[str, Program]) -> None:
    """Wait for the driveline, then stop the others, the recorder last; all must end with 0."""
    assert nodes['driveline'].wait() == 0, nodes['driveline'].errors()
    for name in sorted(nodes, key=lambda name: name == 'recorder'):
        if name != 'driveline':
            nodes[name].stop()
