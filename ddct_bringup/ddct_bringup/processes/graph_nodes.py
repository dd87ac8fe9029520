# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Nodes of the graph: their modules, namespaces, arguments, start order and timeout."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from ddct_bringup.processes.graph_names import GraphNames
from ddct_plant.graph.node_names import name_in_graph
from ddct_plant.graph.node_reports import CONTROL_NODES
from ddct_plant.program.command_line import ROS_ARGUMENTS
from ddct_plant.shift.roles import OFF_GOING


@dataclass(frozen=True)
class NodeSpec:
    """Node of the graph: its name, module and namespace."""

    name: str
    """Name in its namespace, and of its program."""
    module: str
    """Module whose `main` runs the node."""
    namespace: str = ''
    """Namespace within that of the graph; empty for the graph's own."""

    arguments: Sequence[str] = ()
    """Arguments of its program before those of ROS."""

    @property
    def title(self) -> str:
        """Subject of a sentence about its process."""
        return 'the process of all nodes' if self.name == ALL_NODES else f'node {self.path}'

    @property
    def path(self) -> str:
        """Full name within the graph, without a leading slash: 'off_going/actuator'."""
        return f'{self.namespace}/{self.name}' if self.namespace else self.name

    @property
    def controls(self) -> bool:
        """Whether it has the known settings of the run alone."""
        return name_in_graph(self.path) in CONTROL_NODES

    @property
    def log_name(self) -> str:
        """Name of the file with its output: 'off_going_actuator.log'."""
        return f'{self.path.replace("/", "_")}.log'

    @property
    def class_name(self) -> str:
        """Name of the node's class in that module."""
        return f'{self.name.capitalize()}Node'


RECORDER = NodeSpec('recorder', 'ddct_bringup.record.recorder_node')
CLUTCH = NodeSpec('clutch', 'ddct_plant.nodes.clutch_node')
ACTUATOR = NodeSpec('actuator', 'ddct_plant.nodes.actuator_node')
HANDOVER = NodeSpec('handover', 'ddct_controllers.handover.handover_node')
DRIVELINE = NodeSpec('driveline', 'ddct_plant.nodes.driveline_node')

GRAPH_NODES: Sequence[NodeSpec] = (
    RECORDER,
    NodeSpec('engine', 'ddct_plant.nodes.engine_node'),
    NodeSpec('load', 'ddct_plant.nodes.load_node'),
    CLUTCH,
    ACTUATOR,
    NodeSpec('reference', 'ddct_reference.reference_node'),
    NodeSpec('controller', 'ddct_controllers.controller_node'),
    DRIVELINE,
)
"""Nodes of every run in start order; `driveline` owns time and ends the run."""

SHIFT_NODES: Sequence[NodeSpec] = (
    HANDOVER,
    replace(CLUTCH, namespace=OFF_GOING),
    replace(ACTUATOR, namespace=OFF_GOING),
)
"""Nodes that a run with a gear shift has besides."""

NODE_PROGRAMS: Sequence[NodeSpec] = (*GRAPH_NODES, HANDOVER)
"""Nodes with a program of their own, which the off-going side shares."""

ALL_NODES = 'all_nodes'
"""Name of the one process that runs all nodes of a run."""
_OF_A_SHIFT = '--shift'
"""Argument of that process for the nodes of a gear shift."""

ANSWER_TIMEOUT_S = 20.0
"""Wall time within which a node of a supervised graph must answer, s."""


def nodes_of(*, shift: bool) -> list[NodeSpec]:
    """Return the nodes of a run in start order; those of a gear shift only with `shift`."""
    others = [node for node in GRAPH_NODES if node is not DRIVELINE]
    return [*others, *(SHIFT_NODES if shift else ()), DRIVELINE]


def all_nodes(*, shift: bool) -> NodeSpec:
    """Return the one process that runs all nodes of a run, as if it were a node."""
    arguments = (_OF_A_SHIFT,) if shift else ()
    return NodeSpec(ALL_NODES, 'ddct_bringup.processes.single_process', arguments=arguments)


def nodes_of_process(arguments: Sequence[str]) -> list[NodeSpec]:
    """Return the nodes that the process of all nodes runs with these arguments, in order."""
    return nodes_of(shift=_OF_A_SHIFT in arguments)


@dataclass(frozen=True)
class NodeArguments:
    """
    ROS arguments of the nodes of a run: their parameter files and names.

    Files of nodes that control cannot name what these do not know.
    """

    control: Path
    """File of the nodes that have the known settings alone."""
    plant: Path
    """File of the plant and the recorder, which have the case too."""
    names: GraphNames = field(default_factory=GraphNames)
    """Namespace of the graph, and topics with other names."""

    def of(self, node: NodeSpec) -> list[str]:
        """Return the ROS arguments of the process of a node."""
        files = [self.control if node.controls else self.plant]
        if node.name == ALL_NODES:
            files = [self.control, self.plant]
        parameters = [each for file in files for each in ('--params-file', str(file))]
        return [ROS_ARGUMENTS, *parameters, *self.names.remaps(node.namespace)]
