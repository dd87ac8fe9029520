# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Without ROS a headless run works, and a graph ends with one line; nightly all programs do."""

import subprocess
import sys
from pathlib import Path

import pytest
from support.declared import ROS
from support.documented import ROOT
from support.runs import bag_bytes, plan, record
from support.without_ros import fill_site, python

FIND_ROS = f'import importlib.util as u; print([n for n in {sorted(ROS)} if u.find_spec(n)])'


pytestmark = pytest.mark.slow


@pytest.fixture(scope='module')
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return fill_site(tmp_path_factory.mktemp('site'))


def test_help_of_the_trial_by_pip_tries_nothing() -> None:
    command = [sys.executable, str(ROOT / 'tools' / 'without_ros'), '--help']
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=60)
    assert done.stdout.startswith('usage: python tools/without_ros')


def test_ros_is_not_there(site: Path, tmp_path: Path) -> None:
    assert python(site, tmp_path, '-c', FIND_ROS).stdout == '[]\n'


def test_a_graph_without_ros_ends_with_one_line_that_names_rclpy(
    site: Path, tmp_path: Path
) -> None:
    done = python(site, tmp_path, '-m', 'ddct_bringup.programs.bringup', '--out', 'runs')
    assert done.returncode == 1
    assert done.stdout == ''
    (line,) = done.stderr.splitlines()
    assert 'rclpy is not installed' in line
    assert 'headless' in line
    assert not (tmp_path / 'runs').exists()


def test_a_bag_of_a_headless_run_has_the_same_bytes_as_with_ros(
    site: Path, tmp_path: Path
) -> None:
    options = ('--controller', 'pi', '--headless', '--duration', '1', '--out', 'runs')
    done = python(site, tmp_path, '-m', 'ddct_bringup.programs.bringup', *options)
    assert done.returncode == 0, done.stderr
    record(plan('pi', 'headless'), tmp_path / 'pi')
    assert bag_bytes(tmp_path / 'runs' / 'pi') == bag_bytes(tmp_path / 'pi')
