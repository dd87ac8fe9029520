"""What the nodes say on `run_info`: each one thing, however often, and kept in one order."""

from collections.abc import Iterable, Mapping

from ddct_plant.base.errors import DdctError

RunInfoOfNodes = dict[str, Mapping[str, str]]
"""Per node name what it says of itself."""

_CONTROLLER_NODE = 'controller'


def note_run_info(said: RunInfoOfNodes, node: str, pairs: Mapping[str, str]) -> None:
    """Add what `node` says; raise DdctError when a node of this name has said another thing."""
    before = said.setdefault(node, pairs)
    if pairs == before:
        return
    key = next(key for key in (*before, *pairs) if before.get(key) != pairs.get(key))
    raise DdctError(
        f'run_info of node {node} came twice, with {key} {before.get(key, "missing")} and '
        f'{pairs.get(key, "missing")}: two nodes had this name, record the run again with one of '
        'them, or in another ROS_DOMAIN_ID'
    )


def run_info_order(nodes: Iterable[str]) -> list[str]:
    """
    Return the names of the nodes sorted, `controller` last.

    Viewers such as Foxglove keep only the last message of a topic when they are opened or moved
    in time; the controller's is the one that says which controller runs, and with which gains.
    """
    return sorted(nodes, key=lambda node: (node == _CONTROLLER_NODE, node))
