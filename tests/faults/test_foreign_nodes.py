"""Nodes of others in the graph: the recorder says what it misses of them."""

import pytest
from support.in_process_graph import GraphOf, node_class
from support.runs import plan

from ddct_bringup.processes.graph_nodes import NODE_NAMES
from ddct_bringup.record import recorder_node
from ddct_plant.graph.node import GraphNode


def test_a_recorder_that_waits_says_for_whom_while_it_waits(
    graph_of: GraphOf, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(recorder_node, 'PATIENCE_S', 0.3)
    graph = graph_of(plan())
    graph.add('recorder', {'nodes': [*NODE_NAMES, 'bench']})
    printed: list[str] = []

    def said() -> bool:
        printed.append(capfd.readouterr().err)
        return 'no run_info came from' in ''.join(printed)

    graph.spin_until(said, 'whom the recorder waits for')
    words = ''.join(printed)
    for node in set(NODE_NAMES) - {'recorder'} | {'bench'}:
        assert node in words


@pytest.mark.parametrize(('node', 'key'), [('controller', 'controller'), ('driveline', 'steps')])
def test_a_run_info_without_what_the_bag_needs_is_named(
    graph_of: GraphOf, monkeypatch: pytest.MonkeyPatch, node: str, key: str
) -> None:
    def say_little(node: GraphNode, extra: object = None) -> None:
        GraphNode.publish_run_info(node)

    monkeypatch.setattr(node_class(node), 'publish_run_info', say_little)
    graph = graph_of(plan())
    graph.add_all()
    failed, complaint = graph.first_failure()
    assert failed == 'recorder'
    assert f'run_info of node {node} has no {key}' in complaint
