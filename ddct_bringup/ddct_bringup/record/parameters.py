# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Parameters of the recorder beside those that every node has."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ddct_bringup.processes.graph_nodes import nodes_of
from ddct_plant.base.errors import require_name
from ddct_plant.base.options import Option
from ddct_plant.graph.node import GraphNode
from ddct_plant.graph.settings import declare


@dataclass(frozen=True)
class RecorderParameters:
    """Folder of a recorder's bag, and the required contents of the bag."""

    folder: Path
    """Folder of the bag."""
    name: str
    """Name of the bag."""
    two_input: bool
    """Whether the controller commands the engine, so that the bag has its requests."""
    nodes: Sequence[str]
    """Nodes whose `run_info` the bag must hold, by name within the recorder's namespace."""


def declare_parameters(node: GraphNode) -> RecorderParameters:
    """Declare the parameters on the recorder; raise ParameterError for an unusable value."""
    folder = Path(
        declare(node, 'out', Option('recording', 'folder of the bag, created if absent'))
    )
    name = declare(node, 'name', Option('', 'name of the bag; empty is that of the folder'))
    if name:
        require_name('parameter name', name)
    two_input = declare(
        node,
        'two_input',
        Option(False, 'record engine/torque_request of a two-input controller'),
    )
    nodes = declare(
        node,
        'nodes',
        Option(
            tuple(each.path for each in nodes_of(shift=node.known.shift)),
            'nodes whose run_info the bag must hold, in a gear shift those of both sides; names '
            "without a leading slash are those of the recorder's namespace",
            kind=str,
            many=True,
        ),
    )
    return RecorderParameters(folder, name or folder.name, two_input, nodes)
