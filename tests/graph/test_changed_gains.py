"""Gains that change while the controller runs: all of one request, or none."""

from collections.abc import Mapping

from rcl_interfaces.msg import SetParametersResult
from rclpy.parameter import Parameter
from support.in_process_graph import GraphOf
from support.runs import plan

from ddct_plant.graph.node import GraphNode


def change(node: GraphNode, gains: Mapping[str, float]) -> SetParametersResult:
    parameters = [Parameter(f'gains.{name}', value=value) for name, value in gains.items()]
    return node.set_parameters_atomically(parameters)


def declared(node: GraphNode, names: Mapping[str, float]) -> dict[str, float]:
    return {name: node.get_parameter(f'gains.{name}').value for name in names}


def test_a_refused_request_leaves_every_gain_as_it_was(graph_of: GraphOf) -> None:
    node = graph_of(plan('pi')).add('controller')
    running = node._controller
    before = dict(running.gains())
    refused = change(node, {'proportional_gain': 0.2, 'integral_gain': -1.0})
    assert not refused.successful
    assert 'integral_gain is -1' in refused.reason
    assert running.gains() == before == declared(node, before)
    wanted = {'proportional_gain': 0.2, 'integral_gain': 0.03}
    assert change(node, wanted).successful
    assert running.gains() == wanted == declared(node, wanted)
