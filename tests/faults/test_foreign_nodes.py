# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Third parties' nodes in the graph: the recorder names their missing values."""

import pytest
from support.in_process_graph import GraphOf, node_class
from support.runs import plan

from ddct_bringup.processes.graph_nodes import GRAPH_NODES
from ddct_bringup.record import recorder_node
from ddct_plant.graph.node import GraphNode

NODE_NAMES = [node.name for node in GRAPH_NODES]


def test_a_waiting_recorder_names_the_missing_nodes(
    graph_of: GraphOf, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(recorder_node, 'PATIENCE_S', 0.3)
    graph = graph_of(plan())
    graph.add('recorder', {'nodes': [*NODE_NAMES, 'bench']})
    printed: list[str] = []

    def warned() -> bool:
        printed.append(capfd.readouterr().err)
        return 'no run_info came from' in ''.join(printed)

    graph.spin_until(warned, 'the warning of the recorder')
    words = ''.join(printed)
    for node in set(NODE_NAMES) - {'recorder'} | {'bench'}:
        assert node in words


@pytest.mark.parametrize(('node', 'key'), [('controller', 'controller'), ('driveline', 'steps')])
def test_a_run_info_without_what_the_bag_needs_is_named(
    graph_of: GraphOf, monkeypatch: pytest.MonkeyPatch, node: str, key: str
) -> None:
    def publish_without_extra(node: GraphNode, extra: object = None) -> None:
        GraphNode.publish_run_info(node)

    monkeypatch.setattr(node_class(node), 'publish_run_info', publish_without_extra)
    graph = graph_of(plan())
    graph.add_all()
    failed, complaint = graph.first_failure()
    assert failed == 'recorder'
    assert f'run_info of node /{node} has no {key}' in complaint
