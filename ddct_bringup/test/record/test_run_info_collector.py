# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The collector of `run_info` names missing nodes, and two nodes of one name."""

import pytest
from refusals import refused

from ddct_bringup.record.run_info_collector import RunInfoCollector
from ddct_plant.base.errors import DdctError
from ddct_plant.graph.node_reports import controller_info, run_info_pairs


def collected(**extras: dict[str, str]) -> RunInfoCollector:
    nodes = RunInfoCollector(['driveline', 'controller'])
    for node, extra in extras.items():
        nodes.receive(f'/{node}', run_info_pairs(node, extra))
    return nodes


def test_missing_nodes_are_the_expected_ones_without_run_info():
    assert collected(load={}).missing() == ['/controller', '/driveline']
    assert collected(driveline={}, controller={}).missing() == []


def test_what_the_bag_needs_is_read_and_the_controller_comes_last():
    nodes = collected(controller={'controller': 'ls8'}, load={}, driveline={'steps': '80'})
    assert (nodes.controller, nodes.steps) == ('ls8', 80)
    assert list(nodes.received()) == ['/driveline', '/load', '/controller']
    assert nodes.received()['/controller']['controller'] == 'ls8'


@pytest.mark.parametrize('extras', [{}, {'driveline': {}}, {'driveline': {'steps': '8.5'}}])
def test_missing_or_unusable_steps_are_named(extras):
    with refused(DdctError, 'steps'):
        _ = collected(**extras).steps


def test_a_missing_name_of_the_controller_is_named():
    with refused(DdctError, 'controller'):
        _ = collected(controller={}).controller


def test_a_node_that_repeats_its_run_info_is_recorded_once():
    nodes = collected(controller={'controller': 'ls8'}, driveline={'steps': '80'})
    nodes.receive('/controller', run_info_pairs('controller', {'controller': 'ls8'}))
    assert list(nodes.received()) == ['/driveline', '/controller']


def test_a_node_name_with_two_different_run_info_is_refused():
    nodes = collected(controller={'controller': 'ls8'}, driveline={'steps': '80'})
    with refused(DdctError, 'controller'):
        nodes.receive('/controller', run_info_pairs('controller', {'controller': 'pi'}))
    assert nodes.controller == 'ls8'


def test_nodes_of_one_name_in_two_namespaces_are_two_nodes():
    nodes = RunInfoCollector(['actuator', '/off/actuator'])
    nodes.receive('/actuator', run_info_pairs('actuator', {'timeout': '1'}))
    assert nodes.missing() == ['/off/actuator']
    nodes.receive('/off/actuator', run_info_pairs('actuator', {'timeout': '2'}))
    assert [pairs['timeout'] for pairs in nodes.received().values()] == ['1', '2']
    assert nodes.has('/off/actuator')
    assert not nodes.has('/other/actuator')


def test_the_controller_announces_its_torque_parts():
    assert collected(load={}).torque_parts is None, 'not known yet'
    assert collected(controller={'controller': 'mine'}).torque_parts is False
    assert collected(controller={'torque_parts': 'false'}).torque_parts is False
    assert collected(controller=controller_info({})).torque_parts is True
    with refused(DdctError, 'torque_parts'):
        _ = collected(controller={'torque_parts': 'yes'}).torque_parts
