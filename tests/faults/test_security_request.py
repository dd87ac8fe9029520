# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A request for DDS security is refused where there is none; discovery is local by default."""

import os
import sys
from pathlib import Path
from types import ModuleType

import pytest
import rclpy
from refusals import refused
from support.complaints import assert_one_line
from support.processes import Programs

from ddct_bringup.programs import bringup, compare
from ddct_plant.base.errors import DdctError
from ddct_plant.graph.arguments import init_ros
from ddct_plant.graph.security import REQUEST, require_security_if_asked

RANGE = 'ROS_AUTOMATIC_DISCOVERY_RANGE'
NODES = (
    *('ddct_plant.nodes.engine_node', 'ddct_bringup.record.recorder_node'),
    'ddct_bringup.programs.live',
)


@pytest.fixture(autouse=True)
def without_security(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """Request security of a Fast DDS without it; return the file of its library."""
    library = tmp_path / 'ros' / 'lib' / 'libfastrtps.so'
    library.parent.mkdir(parents=True)
    library.write_bytes(b'Fast DDS')
    prefixes = os.environ['AMENT_PREFIX_PATH']
    monkeypatch.setenv('AMENT_PREFIX_PATH', f'{library.parents[1]}{os.pathsep}{prefixes}')
    monkeypatch.setenv(REQUEST, 'true')
    return library


@pytest.mark.parametrize('module', NODES)
def test_a_node_refuses_it(programs: Programs, module: str) -> None:
    node = programs.start_module(module)
    assert node.wait() == 1
    assert REQUEST in node.errors() and 'Traceback' not in node.errors()
    assert not node.output()


@pytest.mark.parametrize('program', [bringup, compare])
def test_a_program_refuses_it_before_it_makes_a_folder(
    program: ModuleType, capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    out = tmp_path / 'out'
    assert program.main(['--out', str(out)]) == 1
    assert_one_line(capfd.readouterr().err, program.PROGRAM, REQUEST)
    assert not out.exists()


def test_only_a_middleware_with_security_passes(
    without_security: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with refused(DdctError, REQUEST):
        require_security_if_asked()
    without_security.write_bytes(b'a plugin builtin.PKI-DH of Fast DDS')
    require_security_if_asked()
    without_security.write_bytes(b'Fast DDS')
    monkeypatch.setenv('RMW_IMPLEMENTATION', 'rmw_cyclonedds_cpp')
    require_security_if_asked()


def test_the_error_has_the_library_or_that_none_is_found(
    without_security: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with refused(DdctError, REQUEST) as caught:
        require_security_if_asked()
    assert f'({without_security})' in str(caught.value)
    without_security.unlink()
    monkeypatch.setenv('AMENT_PREFIX_PATH', str(without_security.parents[1]))
    monkeypatch.setattr(sys, 'prefix', str(without_security.parents[1]))
    with refused(DdctError, REQUEST) as caught:
        require_security_if_asked()
    assert '(not found)' in str(caught.value)


def test_a_library_with_security_behind_the_one_that_is_loaded_does_not_count(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    other = tmp_path / 'other' / 'lib' / 'libfastrtps.so'
    other.parent.mkdir(parents=True)
    other.write_bytes(b'builtin.PKI-DH')
    with_security, present = str(other.parents[1]), os.environ['AMENT_PREFIX_PATH']
    monkeypatch.setenv('AMENT_PREFIX_PATH', os.pathsep.join([present, with_security]))
    with refused(DdctError, REQUEST):
        require_security_if_asked()
    monkeypatch.setenv('AMENT_PREFIX_PATH', os.pathsep.join([with_security, present]))
    require_security_if_asked()


def test_the_library_is_found_in_the_folder_of_a_processor_too(without_security: Path) -> None:
    """Packages of Debian and Ubuntu have theirs in lib/x86_64-linux-gnu."""
    folder = without_security.parent / 'x86_64-linux-gnu'
    folder.mkdir()
    (folder / 'libfastrtps.so').write_bytes(b'builtin.PKI-DH')
    without_security.unlink()
    require_security_if_asked()


def test_no_request_is_no_error(monkeypatch: pytest.MonkeyPatch) -> None:
    for value in ('false', ''):
        monkeypatch.setenv(REQUEST, value)
        require_security_if_asked()
    monkeypatch.delenv(REQUEST)
    require_security_if_asked()


def test_a_node_started_by_hand_finds_this_machine_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    found = []
    monkeypatch.delenv(REQUEST)
    monkeypatch.setattr(rclpy, 'init', lambda **_: found.append(os.environ[RANGE]))
    monkeypatch.delenv(RANGE, raising=False)
    init_ros([])
    monkeypatch.setenv(RANGE, 'SUBNET')
    init_ros([])
    assert found == ['LOCALHOST', 'SUBNET']
