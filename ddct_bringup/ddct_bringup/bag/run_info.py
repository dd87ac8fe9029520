# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The `run_info` of the nodes of a run: its topics, its order, and a check of names."""

from collections.abc import Iterable, Mapping

from ddct_plant.base.errors import DdctError
from ddct_plant.shift.roles import OFF_GOING
from ddct_plant.signals.topic import Topic
from ddct_plant.signals.topics import OFF_GOING_RUN_INFO, RUN_INFO

RunInfoOfNodes = dict[str, Mapping[str, str]]
"""Key-value pairs that each node publishes on `run_info`, by full node name."""
RUN_INFO_TOPICS = (RUN_INFO, OFF_GOING_RUN_INFO)
"""Topics on which the nodes of a run publish their parameters and version."""
CONTROLLER_NODE = '/controller'
DRIVELINE_NODE = '/driveline'


def add_run_info(received: RunInfoOfNodes, node: str, pairs: Mapping[str, str]) -> None:
    """
    Add the key-value pairs that `node` published on `run_info`; `node` is its full name.

    Raise DdctError where a node of this name has published different pairs before.
    """
    before = received.setdefault(node, pairs)
    if pairs == before:
        return
    key = next(key for key in (*before, *pairs) if before.get(key) != pairs.get(key))
    raise DdctError(
        f'run_info of node {node} came twice, with {key} {before.get(key, "missing")} and '
        f'{pairs.get(key, "missing")}: two nodes had this name, record the run again with one of '
        'them, or in another ROS_DOMAIN_ID',
        key=key,
    )


def run_info_topic(node: str) -> Topic:
    """Return the topic of the `run_info` of a node: the one in its namespace, of its full name."""
    return OFF_GOING_RUN_INFO if node.startswith(f'/{OFF_GOING}/') else RUN_INFO


def run_info_order(nodes: Iterable[str]) -> list[str]:
    """
    Return the full names of the nodes sorted, `/controller` last.

    Viewers such as Foxglove keep only the last message of a topic when they are opened or moved
    in time; the controller's names the controller that runs and its gains.
    """
    return sorted(nodes, key=lambda node: (node == CONTROLLER_NODE, node))
