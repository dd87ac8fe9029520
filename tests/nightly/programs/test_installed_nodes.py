# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Nodes that are started one by one, as colcon installs them, leave the bag of a headless run."""

import shutil
from pathlib import Path

import pytest
from support.installed import installed
from support.processes import Program, Programs, package_of, ros_arguments
from support.runs import bag_bytes, plan, record

from ddct_bringup.processes.graph_nodes import GRAPH_NODES

RUN = plan('ls8', 'headless', duration_s=3.0)


def _run_graph(programs: Programs, commands: dict[str, list[str]], folder: Path) -> None:
    """Run the nodes that `commands` start, recorder included, until the driveline has ended."""
    own: dict[str, dict[str, object]] = {
        'controller': {'controller': 'ls8'},
        'driveline': {'require_recorder': True},
        'recorder': {'out': folder, 'name': 'ls8'},
    }
    nodes: dict[str, Program] = {
        name: programs.start([*command, *ros_arguments(own.get(name, {}))])
        for name, command in commands.items()
    }
    assert nodes['driveline'].wait() == 0, nodes['driveline'].errors()
    for name in sorted(nodes, key=lambda name: name == 'recorder'):
        if name != 'driveline':
            nodes[name].stop()


def test_installed_nodes_leave_the_bag_of_the_headless_run(
    programs: Programs, tmp_path: Path
) -> None:
    commands = {spec.name: [installed(package_of(spec), spec.name)] for spec in GRAPH_NODES}
    _run_graph(programs, commands, tmp_path / 'graph')
    record(RUN, tmp_path / 'headless')
    assert bag_bytes(tmp_path / 'graph') == bag_bytes(tmp_path / 'headless')


def test_ros2_run_leaves_the_bag_of_the_headless_run(programs: Programs, tmp_path: Path) -> None:
    ros2 = shutil.which('ros2')
    if ros2 is None:
        pytest.skip('no ros2 on PATH: ros2cli comes with apt, not with the wheels')
    for spec in GRAPH_NODES:
        installed(package_of(spec), spec.name)
    commands = {spec.name: [ros2, 'run', package_of(spec), spec.name] for spec in GRAPH_NODES}
    _run_graph(programs, commands, tmp_path / 'graph')
    record(RUN, tmp_path / 'headless')
    assert bag_bytes(tmp_path / 'graph') == bag_bytes(tmp_path / 'headless')
