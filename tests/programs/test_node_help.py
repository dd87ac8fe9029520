"""`--help` of a node names its parameters as they are, and disturbs no graph."""

import subprocess
import sys

import pytest

from ddct_bringup.run.graph_nodes import GRAPH_NODES


@pytest.mark.parametrize('node', GRAPH_NODES, ids=lambda node: node.name)
def test_help_names_the_parameters_and_where_to_give_them(node):
    done = subprocess.run(
        [sys.executable, '-m', node.module, '--help'],
        capture_output=True,
        text=True,
        timeout=60.0,
        check=True,
    )
    assert f'ros2 run {node.package} {node.name}' in done.stdout
    for expected in ('scenario: ', 'wear_gain: 1.0', "mode: 'lockstep'", '--ros-args -p'):
        assert expected in done.stdout
    assert 'use_sim_time' not in done.stdout
    assert done.stderr == ''
