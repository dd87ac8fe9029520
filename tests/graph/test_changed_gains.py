# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Options of a controller as parameters; gains change while it runs, all of a request or none."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import pytest
from rcl_interfaces.msg import SetParametersResult
from rclpy.parameter import Parameter
from support.in_process_graph import GraphOf
from support.runs import plan
from support.third_party import EXAMPLE, example_entry_points, install

from ddct_bringup.run.plan import RunPlan
from ddct_controllers.mpc.variants import PREDICTIVE
from ddct_plant.graph.node import GraphNode
from ddct_plant.scenario.file import load_scenario, scenario_to_yaml
from ddct_plant.scenario.settings import RunSettings

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


def test_options_of_a_third_party_are_set_alike_by_set_a_file_and_parameters(
    graph_of: GraphOf, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    install(monkeypatch, tmp_path / 'site', EXAMPLE, example_entry_points())
    wanted = {'proportional_gain': 0.3, 'dead_zone_rpm': 2.0}
    keys = tuple(f'controllers.dead_zone.{name}={value}' for name, value in wanted.items())
    file = tmp_path / 'mine.yaml'
    file.write_text(scenario_to_yaml(load_scenario('thesis', keys)), encoding='utf-8')
    from_set = graph_of(plan('dead_zone', changes=keys)).add('controller')
    settings = RunSettings(load_scenario(str(file)))
    from_file = graph_of(RunPlan(settings, 'dead_zone')).add('controller')
    given = {f'gains.{name}': value for name, value in wanted.items()}
    from_parameters = graph_of(plan('dead_zone')).add('controller', given)
    nodes: list[Any] = [from_set, from_file, from_parameters]
    for node in nodes:
        assert declared(node, wanted) == wanted
        controller = node._controller
        assert (controller._gain, controller._dead_zone_rpm) == (0.3, 2.0)
        described = node.describe_parameter('gains.dead_zone_rpm').description
        assert described == 'half the width of the dead zone [rpm] (at least 0)'
