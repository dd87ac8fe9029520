# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The SROS 2 policy names the nodes and topics of the graph, and one publisher for each topic."""

import xml.etree.ElementTree as ElementTree
from collections import defaultdict
from pathlib import Path

from ddct_bringup.processes.graph_nodes import GRAPH_NODES, SHIFT_NODES
from ddct_plant.signals.topics import OFF_GOING_RUN_SETTINGS, RUN_SETTINGS, TOPICS

NAMED = (*TOPICS, RUN_SETTINGS, OFF_GOING_RUN_SETTINGS)
ROOT = Path(__file__).parents[2]
OF_ROS = {'/rosout', '/parameter_events'}
SHARED = {
    '/diagnostics': {'driveline', 'engine', 'actuator', 'off_going/actuator'},
    '/run_info': {node.path for node in (*GRAPH_NODES, *SHIFT_NODES) if not node.namespace},
    '/off_going/run_info': {node.path for node in SHIFT_NODES if node.namespace},
}
"""Nodes that publish the topics which more than one publishes."""


def allowed(kind: str) -> dict[str, set[str]]:
    """Return the nodes that may publish or subscribe to each topic, by its name."""
    found = defaultdict(set)
    tree = ElementTree.parse(ROOT / 'docs' / 'use' / 'sros2_policy.xml')
    for enclave in tree.iter('enclave'):
        node = enclave.attrib['path'].removeprefix('/ddct/')
        (profile,) = enclave.iter('profile')
        assert f'{profile.attrib["ns"]}/{profile.attrib["node"]}'.lstrip('/') == node
        for topics in profile.iter('topics'):
            if topics.get(kind) == 'ALLOW':
                for topic in topics:
                    found[topic.text].add(node)
    return {topic: nodes for topic, nodes in found.items() if topic not in OF_ROS}


def test_each_topic_has_the_publisher_of_the_table() -> None:
    expected = {
        topic.resolved_name: SHARED.get(topic.resolved_name, {topic.publisher}) for topic in NAMED
    }
    assert allowed('publish') == expected


def test_every_node_may_read_every_topic() -> None:
    nodes = {node.path for node in (*GRAPH_NODES, *SHIFT_NODES)} | {'live'}
    assert allowed('subscribe') == {topic.resolved_name: nodes for topic in NAMED}
