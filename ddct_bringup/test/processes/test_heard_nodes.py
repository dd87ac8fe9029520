"""What the recorder makes of `run_info`."""

import pytest

from ddct_bringup.record.heard_nodes import HeardNodes
from ddct_plant.base.errors import DdctError
from ddct_plant.graph.run_info import run_info_pairs
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

SETTINGS = RunSettings(load_scenario('thesis'))


def heard(**said: dict[str, str]) -> HeardNodes:
    nodes = HeardNodes(SETTINGS, two_input=False, expected=['driveline', 'controller'])
    for node, extra in said.items():
        nodes.hear(node, dict(run_info_pairs(SETTINGS, extra)))
    return nodes


def test_silent_nodes_are_those_expected_and_not_heard():
    assert heard(load={}).silent() == ['controller', 'driveline']
    assert heard(driveline={}, controller={}).silent() == []


def test_what_the_bag_needs_is_read_and_the_controller_comes_last():
    nodes = heard(controller={'controller': 'ls8'}, load={}, driveline={'steps': '80'})
    assert (nodes.controller, nodes.steps) == ('ls8', 80)
    assert list(nodes.said()) == ['driveline', 'load', 'controller']
    assert nodes.said()['controller']['controller'] == 'ls8'


@pytest.mark.parametrize('said', [{}, {'driveline': {}}, {'driveline': {'steps': '8.5'}}])
def test_missing_or_unusable_steps_are_named(said):
    with pytest.raises(DdctError, match='run_info of node driveline has .*steps'):
        _ = heard(**said).steps


def test_a_missing_name_of_the_controller_is_named():
    with pytest.raises(DdctError, match='run_info of node controller has no controller'):
        _ = heard(controller={}).controller


def test_other_settings_are_refused():
    nodes = heard()
    with pytest.raises(DdctError, match='node load runs with seed 7 and the recorder with 0'):
        nodes.hear('load', {'seed': '7'})
    with pytest.raises(DdctError, match=r'two_input true and .* -p two_input:=true'):
        nodes.hear('engine', {'two_input': 'true'})


def test_a_node_that_says_the_same_again_is_heard_once():
    nodes = heard(controller={'controller': 'ls8'}, driveline={'steps': '80'})
    nodes.hear('controller', dict(run_info_pairs(SETTINGS, {'controller': 'ls8'})))
    assert list(nodes.said()) == ['driveline', 'controller']


def test_a_node_name_with_two_different_run_info_is_refused():
    nodes = heard(controller={'controller': 'ls8'}, driveline={'steps': '80'})
    with pytest.raises(DdctError, match='node controller came twice, with controller ls8 and pi'):
        nodes.hear('controller', dict(run_info_pairs(SETTINGS, {'controller': 'pi'})))
    assert nodes.controller == 'ls8'
