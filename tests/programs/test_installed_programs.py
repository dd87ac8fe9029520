# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The programs as colcon installs them: `install/<package>/lib/<package>/<program>`."""

import shutil
from pathlib import Path

import pytest
from support.processes import Program, Programs, package_of, ros_arguments
from support.runs import bag_bytes, plan, record

from ddct_bringup.processes.graph_nodes import GRAPH_NODES
from ddct_plant.program.start import programs as installed_programs

PROGRAMS = sorted(
    (point.module.partition('.')[0], name) for name, point in installed_programs().items()
)
RUN = plan('ls8', 'headless', duration_s=3.0)


def installed(package: str, program: str) -> str:
    """Return the path of an installed program, or skip the test without a sourced workspace."""
    index = pytest.importorskip('ament_index_python.packages', reason='no ROS environment')
    try:
        prefix = index.get_package_prefix(package)
    except (index.PackageNotFoundError, OSError):  # OSError: nothing at all is sourced
        pytest.skip(f'{package} is not installed: build the workspace and source install/setup.*')
    return str(Path(prefix) / 'lib' / package / program)


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


@pytest.mark.parametrize(('package', 'program'), PROGRAMS, ids=[name for _, name in PROGRAMS])
def test_every_program_is_installed_in_the_folder_of_ros2_run(package: str, program: str) -> None:
    assert Path(installed(package, program)).is_file()


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


def test_the_installed_bringup_runs_and_scores(programs: Programs, tmp_path: Path) -> None:
    out = str(tmp_path / 'runs')
    command = [installed('ddct_bringup', 'bringup'), '--duration', '1', '--out', out]
    bringup = programs.start(command)
    assert bringup.wait() == 0, bringup.errors()
    score = programs.start([installed('ddct_bringup', 'score'), out])
    assert score.wait() == 0, score.errors()
    assert 'pi' in score.output()
