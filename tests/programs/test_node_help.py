# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`--help` of a node names its parameters as they are, and disturbs no graph."""

import importlib
import re
import subprocess
import sys
from collections.abc import Callable

import pytest
from support.in_process_graph import node_class
from waiting import WITHIN_S

from ddct_bringup.processes.graph_nodes import NODE_PROGRAMS


@pytest.fixture
def help_of(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Callable[..., str]:
    """Return a function that returns the help of a node, which runs in this process."""
    monkeypatch.setenv('COLUMNS', '200')

    def shown(module: str, *arguments: str) -> str:
        monkeypatch.setattr(sys, 'argv', [module, *arguments])
        assert importlib.import_module(module).main() == 0
        printed = capsys.readouterr()
        assert printed.err == ''
        return printed.out

    return shown


def test_a_process_of_a_node_prints_the_same_help(help_of):
    module = 'ddct_plant.nodes.load_node'
    done = subprocess.run(
        [sys.executable, '-m', module, '--help'],
        capture_output=True,
        text=True,
        timeout=WITHIN_S,
        check=True,
    )
    assert (done.stdout, done.stderr) == (help_of(module, '--help'), '')


@pytest.mark.parametrize('node', NODE_PROGRAMS, ids=lambda node: node.name)
def test_help_names_the_parameters_and_where_to_give_them(node, help_of):
    text = help_of(node.module, '--help')
    program = f'ddct node {node.name}'
    for expected in (program, 'scenario: ', "mode: 'lockstep'", '--ros-args -p'):
        assert expected in text
    assert ('wear_gain: 1.0' in text) == (not node_class(node.name).KNOWN_ONLY)
    assert 'use_sim_time' not in text
    for example in node_class(node.name).EXAMPLES:
        assert f'  {program} --ros-args {example}\n' in text
        for parameter in re.findall(r'([\w.]+):=', example):
            assert f'\n  {parameter}: ' in text


def test_no_example_makes_a_node_disagree_with_the_others():
    shared = {'scenario', 'architecture', 'wear_gain', 'mode', 'seed'}
    for node in NODE_PROGRAMS:
        for example in node_class(node.name).EXAMPLES:
            assert not shared & set(re.findall(r'(\w+):=', example)), example


@pytest.mark.parametrize('first', [True, False], ids=['in front', 'behind'])
def test_help_shows_the_node_with_the_parameters_that_are_given(first, help_of):
    given = ['--ros-args', '-p', 'controller:=pi', '-p', 'gains.proportional_gain:=0.2']
    arguments = ['--help', *given] if first else [*given, '--help']
    text = help_of('ddct_controllers.controller_node', *arguments)
    assert "  controller: 'pi'\n" in text
    assert '  gains.proportional_gain: 0.2\n' in text


def test_help_shows_the_options_of_the_chosen_controller_with_or_without_a_value(help_of):
    given = ['--ros-args', '-p', 'controller:=mpc3', '-p', 'gains.control_steps:=2']
    text = help_of('ddct_controllers.controller_node', '--help', *given)
    assert '  gains.control_steps: 2\n' in text
    assert '  gains.highest_torque_n_m: None\n' in text
    assert 'largest clutch torque request [N m] (above 0, at most 1e+06)' in text
