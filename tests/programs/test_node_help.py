# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`--help` of a node names its parameters as they are, and disturbs no graph."""

import re
import subprocess
import sys

import pytest
from support.in_process_graph import node_class

from ddct_bringup.processes.graph_nodes import NODE_PROGRAMS


def _help(module: str, *arguments: str) -> str:
    done = subprocess.run(
        [sys.executable, '-m', module, *arguments],
        capture_output=True,
        text=True,
        timeout=60.0,
        check=True,
    )
    assert done.stderr == ''
    return done.stdout


@pytest.mark.parametrize('node', NODE_PROGRAMS, ids=lambda node: node.name)
def test_help_names_the_parameters_and_where_to_give_them(node):
    text = _help(node.module, '--help')
    program = f'ddct {node.name}'
    for expected in (program, 'scenario: ', 'wear_gain: 1.0', "mode: 'lockstep'", '--ros-args -p'):
        assert expected in text
    assert 'use_sim_time' not in text
    for example in node_class(node.name).EXAMPLES:
        assert f'  {program} --ros-args {example}\n' in text
        for parameter in re.findall(r'([\w.]+):=', example):
            assert f'\n  {parameter}: ' in text


def test_no_example_makes_a_node_disagree_with_the_others():
    shared = {'scenario', 'architecture', 'clutch', 'wear_gain', 'mode', 'seed'}
    for node in NODE_PROGRAMS:
        for example in node_class(node.name).EXAMPLES:
            assert not shared & set(re.findall(r'(\w+):=', example)), example


@pytest.mark.parametrize('first', [True, False], ids=['in front', 'behind'])
def test_help_shows_the_node_with_the_parameters_that_are_given(first):
    given = ['--ros-args', '-p', 'controller:=pi', '-p', 'gains.proportional_gain:=0.2']
    arguments = ['--help', *given] if first else [*given, '--help']
    text = _help('ddct_controllers.controller_node', *arguments)
    assert "  controller: 'pi'\n" in text
    assert '  gains.proportional_gain: 0.2\n' in text


def test_help_shows_the_options_of_the_chosen_controller_with_or_without_a_value():
    given = ['--ros-args', '-p', 'controller:=mpc3', '-p', 'gains.control_steps:=2']
    text = _help('ddct_controllers.controller_node', '--help', *given)
    assert '  gains.control_steps: 2\n' in text
    assert '  gains.highest_torque_n_m: None\n' in text
    assert 'largest clutch torque request [N m] (above 0, at most 1e+06)' in text
