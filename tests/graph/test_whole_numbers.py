# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A node takes a whole number wherever it takes a number, at its start and while it runs."""

import math
from pathlib import Path
from typing import Any

import pytest
from rclpy.exceptions import ParameterNotDeclaredException
from rclpy.parameter import Parameter
from support.in_process_graph import GraphOf, by_hand
from support.processes import Programs
from support.runs import plan

from ddct_bringup.processes.graph_nodes import NODE_PROGRAMS
from ddct_plant.base.option import Option
from ddct_plant.graph.node import GraphNode
from ddct_plant.graph.settings import declare

SHIFT = plan('mpc3', scenario='upshift', duration_s=2.0)
"""A run with every node; its controller has many options, some without a value."""


def numbers_of(node: GraphNode) -> dict[str, float]:
    """Return the numbers with decimals among the parameters of a node, by name."""
    parameters = node.get_parameters(node.own_parameters())
    return {each.name: each.value for each in parameters if each.type_ is Parameter.Type.DOUBLE}


@pytest.mark.parametrize('spec', NODE_PROGRAMS, ids=lambda spec: spec.name)
def test_whole_numbers_are_values_of_each_parameter_that_is_a_number(
    graph_of: GraphOf, spec: Any
) -> None:
    graph = graph_of(SHIFT)
    # By hand: a program gives files in place of true values.
    by_hand(graph, {'scenario': 'upshift'})
    usual = numbers_of(graph.add(spec.path))
    controls = type(graph.nodes[spec.path]).KNOWN_ONLY
    wear = {'wear_gain', 'off_going_wear_gain'}
    # A node that controls does not know the wear.
    assert (wear & usual.keys()) == (set() if controls else wear)
    whole: dict[str, Any] = {name: math.ceil(value) for name, value in usual.items()}
    if spec.name == 'controller':
        whole['gains.highest_torque_n_m'] = 200  # it has no value by default
    node = graph.add(spec.path, whole, key='whole')
    assert numbers_of(node) == whole
    types = {name: node.describe_parameter(name).type for name in whole}
    assert types == dict.fromkeys(whole, Parameter.Type.DOUBLE.value)
    assert controls or isinstance(node.settings.case.wear_gain, float)


def test_a_gain_takes_a_whole_number_while_it_runs(graph_of: GraphOf) -> None:
    node: Any = graph_of(plan('pi')).add('controller')
    name = 'gains.proportional_gain'
    assert node.set_parameters([Parameter(name, value=1)])[0].successful
    assert node.get_parameter(name).type_ is Parameter.Type.DOUBLE
    assert node._controller.gains()['proportional_gain'] == 1.0
    for wrong in (True, '1'):
        (refused,) = node.set_parameters([Parameter(name, value=wrong)])
        assert not refused.successful and 'DOUBLE' in refused.reason
    assert node.get_parameter(name).value == 1.0


def test_a_parameter_of_whole_numbers_takes_those_with_a_decimal_point(graph_of: GraphOf) -> None:
    graph = by_hand(graph_of(plan('pi')), {})
    seed = graph.add('engine', {'seed': 3.0}).get_parameter('seed')
    assert (seed.type_, seed.value) == (Parameter.Type.INTEGER, 3)


def test_a_list_of_numbers_takes_whole_numbers(graph_of: GraphOf) -> None:
    node = graph_of(plan('pi')).add('engine', {'times': [1, 2]})
    described = Option((0.5,), 'times', 's', many=True)
    assert declare(node, 'times', described) == (1.0, 2.0)
    assert node.get_parameter('times').type_ is Parameter.Type.DOUBLE_ARRAY


def test_an_unknown_name_is_answered_with_the_known_ones(graph_of: GraphOf) -> None:
    node = graph_of(plan('pi')).add('controller')
    with pytest.raises(ParameterNotDeclaredException) as refused:
        node.set_parameters([Parameter('gains.nix', value=1.0)])
    assert str(refused.value) == (
        'unknown parameter gains.nix: known: gains.proportional_gain, gains.integral_gain'
    )
    with pytest.raises(ParameterNotDeclaredException, match='did you mean controller?'):
        node.set_parameters([Parameter('controler', value='pi')])


def test_the_command_line_and_a_parameter_file_take_whole_numbers(
    programs: Programs, tmp_path: Path
) -> None:
    file = tmp_path / 'parameters.yaml'
    file.write_text('/**: {ros__parameters: {wear_gain: 1}}\n', encoding='utf-8')
    driveline = programs.fork(
        'ddct_plant.nodes.driveline_node',
        *('--ros-args', '--params-file', str(file), '-p', 'answer_timeout_s:=1'),
    )
    assert driveline.wait() == 1
    assert 'for stamp 1000000000 ns (step 0) within 1 s' in driveline.errors()
