# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Options of a controller as parameters; gains change while it runs, all of a request or none.

What changes in a run is in its bag.
"""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from rcl_interfaces.msg import SetParametersResult
from rclpy.parameter import Parameter
from support.in_process_graph import GraphOf
from support.runs import bag_bytes, expected, plan, record
from support.third_party import EXAMPLE, example_entry_points, install

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.run.headless import run_headless
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.scores.scored_recording import score_bag
from ddct_bringup.verdict.limits import load_limits
from ddct_controllers.mpc.variants import PREDICTIVE
from ddct_plant.graph.node import GraphNode
from ddct_plant.scenario.file import load_scenario, scenario_to_yaml
from ddct_plant.scenario.settings import KnownSettings, RunSettings
from ddct_plant.signals.gain_changes import GainChange

UNSET = {'highest_torque_n_m', 'lowest_slip_rpm', 'iteration_limit'}
"""Options of mpc3 without a value."""


def change(node: GraphNode, gains: Mapping[str, float]) -> SetParametersResult:
    parameters = [Parameter(f'gains.{name}', value=value) for name, value in gains.items()]
    return node.set_parameters_atomically(parameters)


def declared(node: GraphNode, names: Iterable[str]) -> dict[str, Any]:
    return {name: node.get_parameter(f'gains.{name}').value for name in names}


def has_come_to(node: Any, step: int) -> bool:
    """Return whether a node has answered this step."""
    answered: int = node.join.last_step
    return answered >= step


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
    settings = RunSettings(KnownSettings(load_scenario(str(file))))
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


def test_gains_changed_in_a_run_are_in_its_bag_from_the_tick_at_which_they_act(
    graph_of: GraphOf,
) -> None:
    run = plan('pi', duration_s=2.5)
    graph = graph_of(run)
    node: Any = graph.add('controller')
    assert change(node, {'integral_gain': 0.03}).successful
    graph.add_all()
    asked = [GainChange('integral_gain', 0.0223, 0.03, 0)]
    for step, before, after in ((10, 0.103, 0.25), (90, 0.25, 0.2), (120, 0.2, 0.103)):
        graph.spin_until(partial(has_come_to, node, step), f'step {step}')
        assert change(node, {'proportional_gain': after}).successful
        assert not change(node, {'proportional_gain': -1.0}).successful
        asked.append(GainChange('proportional_gain', before, after, node.join.last_step + 1))
    graph.run()
    scored = score_bag(graph.folder, 'pi', load_limits(None))
    assert scored.recording is not None
    assert scored.recording.gain_changes == scored.scores.gain_changes == tuple(asked)
    assert scored.recording.run_info['/controller']['gains.proportional_gain'] == '0.103'
    repeated = run_headless(run.settings, 'pi', changes=asked)
    assert scored.recording.trajectory.sha256() == repeated.sha256()
    assert repeated.sha256() != expected(run).sha256()
    assert scored.scores.metrics['engagement_time_s'] < 0.7  # 0.88 s with the first gains


def test_a_gain_changed_in_real_time_is_in_the_bag(graph_of: GraphOf) -> None:
    graph = graph_of(plan('pi', mode='realtime'))
    graph.add_all()
    node: Any = graph.nodes['controller']
    graph.spin_until(partial(has_come_to, node, 20), 'step 20')
    assert change(node, {'proportional_gain': 0.25}).successful
    at = node.join.last_step
    graph.run()
    (found,) = read_bag(graph.folder).gain_changes
    assert found[:3] == ('proportional_gain', 0.103, 0.25)
    assert found.step > at


def test_requests_that_change_nothing_leave_the_bytes_of_the_bag_as_they_are(
    graph_of: GraphOf, tmp_path: Path
) -> None:
    run = plan('pi')
    graph = graph_of(run)
    node: Any = graph.add('controller')
    graph.add_all()
    graph.spin_until(partial(has_come_to, node, 70), 'step 70')
    at = node.join.last_step
    assert not change(node, {'proportional_gain': 1e4}).successful
    assert change(node, {'proportional_gain': 0.103}).successful
    for value in (0.3, 0.103):
        assert change(node, {'proportional_gain': value}).successful
    assert node.join.last_step == at
    graph.run()
    record(replace(run, layout='headless'), tmp_path / 'headless')
    assert bag_bytes(graph.folder) == bag_bytes(tmp_path / 'headless')


def test_a_gain_of_a_shift_changed_while_the_off_going_clutch_carries_torque_is_in_the_bag(
    graph_of: GraphOf,
) -> None:
    run = plan('pi', scenario='upshift', duration_s=2.0)
    graph = graph_of(run)
    graph.add_all()
    node: Any = graph.nodes['controller']
    graph.spin_until(partial(has_come_to, node, 20), 'step 20')
    first = dict(node._controller.gains())['proportional_gain']
    assert change(node, {'proportional_gain': 0.2}).successful
    asked = (GainChange('proportional_gain', first, 0.2, node.join.last_step + 1),)
    graph.run()
    recording = read_bag(graph.folder)
    assert recording.gain_changes == asked
    repeated = run_headless(run.settings, 'pi', changes=asked)
    assert recording.trajectory.sha256() == repeated.sha256()


def test_no_node_but_the_controller_has_a_parameter_that_can_be_changed_in_a_run(
    graph_of: GraphOf,
) -> None:
    run = plan('pi', scenario='upshift', duration_s=2.0)
    graph = graph_of(run)
    graph.add_all()
    changeable = {
        f'{path} {name}'
        for path, node in graph.nodes.items()
        for name in node.own_parameters()
        if not node.describe_parameter(name).read_only
    }
    gains = graph.nodes['controller']._controller.gains()  # type: ignore[attr-defined]
    assert changeable == {f'controller gains.{name}' for name in gains}
