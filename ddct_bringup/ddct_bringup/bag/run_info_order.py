"""The order in which the nodes' `run_info` is written and sent."""

from collections.abc import Iterable

_CONTROLLER_NODE = 'controller'


def run_info_order(nodes: Iterable[str]) -> list[str]:
    """
    Return the names of the nodes sorted, `controller` last.

    Viewers such as Foxglove keep only the last message of a topic when they are opened or moved
    in time; the controller's is the one that says which controller runs, and with which gains.
    """
    return sorted(nodes, key=lambda node: (node == _CONTROLLER_NODE, node))
