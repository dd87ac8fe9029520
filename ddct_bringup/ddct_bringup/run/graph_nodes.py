"""The nodes of the graph: where their programs are and which extra parameters they take."""

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class NodeSpec:
    """One node of the graph."""

    name: str
    package: str

    @property
    def module(self) -> str:
        """The module whose `main` runs it."""
        return f'{self.package}.{self.name}_node'

    @property
    def class_name(self) -> str:
        """The node's class in that module."""
        return f'{self.name.capitalize()}Node'


GRAPH_NODES: Sequence[NodeSpec] = (
    NodeSpec('recorder', 'ddct_bringup'),
    NodeSpec('engine', 'ddct_plant'),
    NodeSpec('load', 'ddct_plant'),
    NodeSpec('clutch', 'ddct_plant'),
    NodeSpec('actuator', 'ddct_plant'),
    NodeSpec('reference', 'ddct_reference'),
    NodeSpec('controller', 'ddct_controllers'),
    NodeSpec('driveline', 'ddct_plant'),
)
"""In starting order; `driveline` owns time and ends the run."""

NODE_NAMES = tuple(node.name for node in GRAPH_NODES)
