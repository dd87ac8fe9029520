"""Options of a controller as parameters; gains change while it runs, all of a request or none."""

from collections.abc import Iterable, Mapping
from typing import Any

from rcl_interfaces.msg import SetParametersResult
from rclpy.parameter import Parameter
from support.in_process_graph import GraphOf
from support.runs import plan

from ddct_controllers.mpc.variants import PREDICTIVE
from ddct_plant.graph.node import GraphNode

UNSET = {'highest_torque_n_m', 'lowest_slip_rpm', 'iteration_limit'}
"""Options of mpc3 without a value."""


def change(node: GraphNode, gains: Mapping[str, float]) -> SetParametersResult:
    parameters = [Parameter(f'gains.{name}', value=value) for name, value in gains.items()]
    return node.set_parameters_atomically(parameters)


def declared(node: GraphNode, names: Iterable[str]) -> dict[str, Any]:
    return {name: node.get_parameter(f'gains.{name}').value for name in names}


def test_a_refused_request_leaves_every_gain_as_it_was(graph_of: GraphOf) -> None:
    node: Any = graph_of(plan('pi')).add('controller')
    running = node._controller
    before = dict(running.gains())
    refused = change(node, {'proportional_gain': 0.2, 'integral_gain': -1.0})
    assert not refused.successful
    assert 'integral_gain is -1' in refused.reason
    assert running.gains() == before == declared(node, before)
    wanted = {'proportional_gain': 0.2, 'integral_gain': 0.03}
    assert change(node, wanted).successful
    assert running.gains() == wanted == declared(node, wanted)


def test_every_option_of_a_controller_is_a_parameter_that_reaches_it(graph_of: GraphOf) -> None:
    graph = graph_of(plan('mpc3', changes=('controllers.mpc3.control_steps=3',)))
    given = {'gains.prediction_steps': 9, 'gains.torque_rate_n_m_s': 100.0}
    node: Any = graph.add('controller', given)
    settings = node._controller.settings
    assert (settings.prediction_steps, settings.control_steps) == (9, 3)
    assert settings.inputs[0].rate_n_m_s == 100.0
    assert declared(node, PREDICTIVE['mpc3'].options.keys() - UNSET)['backend'] == 'daqp'
    assert not change(node, {'control_steps': 2}).successful
    described = node.describe_parameter('gains.torque_rate_n_m_s')
    assert 'largest rate of the clutch torque request' in described.description
    assert described.description.endswith('[N m/s] (above 0, at most 1e+06)')
    assert described.floating_point_range[0].to_value == 1e6
