# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Nodes of the graph: their modules, start order and timeout."""

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class NodeSpec:
    """Node of the graph: its name and module."""

    name: str
    module: str
    """Module whose `main` runs the node."""

    @property
    def class_name(self) -> str:
        """Name of the node's class in that module."""
        return f'{self.name.capitalize()}Node'


GRAPH_NODES: Sequence[NodeSpec] = (
    NodeSpec('recorder', 'ddct_bringup.record.recorder_node'),
    NodeSpec('engine', 'ddct_plant.nodes.engine_node'),
    NodeSpec('load', 'ddct_plant.nodes.load_node'),
    NodeSpec('clutch', 'ddct_plant.nodes.clutch_node'),
    NodeSpec('actuator', 'ddct_plant.nodes.actuator_node'),
    NodeSpec('reference', 'ddct_reference.reference_node'),
    NodeSpec('controller', 'ddct_controllers.controller_node'),
    NodeSpec('driveline', 'ddct_plant.nodes.driveline_node'),
)
"""Nodes in start order; `driveline` owns time and ends the run."""

NODE_NAMES = tuple(node.name for node in GRAPH_NODES)
"""Names of the nodes, in start order."""

ANSWER_TIMEOUT_S = 20.0
"""Wall time within which a node of a supervised graph must answer, s."""
