"""What each node has said on `run_info`: one thing, however often it says it."""

from collections.abc import Mapping

from ddct_plant.base.errors import DdctError

RunInfoOfNodes = dict[str, Mapping[str, str]]
"""Per node name what it says of itself."""


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
