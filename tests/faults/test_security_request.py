# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A request for DDS security is refused where it might be ignored; discovery is local."""

import os
from pathlib import Path
from types import ModuleType

import pytest
import rclpy
from rclpy.context import Context
from refusals import refused
from support.complaints import assert_one_line

from ddct_bringup.programs import bringup, compare
from ddct_plant.base.errors import DdctError
from ddct_plant.graph.arguments import init_ros
from ddct_plant.graph.domain import SECURITY, STRATEGY, require_ros
from ddct_plant.nodes.engine_node import EngineNode

RANGE = 'ROS_AUTOMATIC_DISCOVERY_RANGE'


@pytest.fixture
def requested(monkeypatch: pytest.MonkeyPatch) -> None:
    """Request security as ROS takes it by default: a node without keys runs unsecured."""
    monkeypatch.setenv(SECURITY, 'true')
    monkeypatch.delenv(STRATEGY, raising=False)


@pytest.mark.usefixtures('requested')
@pytest.mark.parametrize('program', [bringup, compare])
def test_a_program_refuses_it_before_it_makes_a_folder(
    program: ModuleType, capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    out = tmp_path / 'out'
    assert program.main(['--out', str(out)]) == 1
    assert_one_line(capfd.readouterr().err, program.PROGRAM, SECURITY)
    assert not out.exists()


@pytest.mark.usefixtures('requested')
def test_it_is_taken_where_ros_starts_no_node_without_it(monkeypatch: pytest.MonkeyPatch) -> None:
    for strategy in ('', 'Permissive', 'enforce'):
        monkeypatch.setenv(STRATEGY, strategy)
        with refused(DdctError, SECURITY):
            require_ros()
    monkeypatch.setenv(STRATEGY, 'Enforce')
    require_ros()


@pytest.mark.filterwarnings('ignore:Failed to fini rosout publisher')
@pytest.mark.usefixtures('requested')
def test_enforced_security_that_is_missing_is_an_error_of_one_line(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Without keys rclpy does not begin; with a keystore the wheels' middleware makes no node."""
    monkeypatch.setenv(STRATEGY, 'Enforce')
    context = Context()
    with pytest.raises(DdctError, match=r'^failed to initialize rcl.*: mend what .* ROS_\*$'):
        init_ros([], context)
    (tmp_path / 'enclaves').mkdir()
    monkeypatch.setenv('ROS_SECURITY_KEYSTORE', str(tmp_path))
    init_ros([], context)
    try:
        words = r'^error creating node: .*: mend the environment variables ROS_\*$'
        with pytest.raises(DdctError, match=words):
            EngineNode(context=context)
    finally:
        context.try_shutdown()


def test_no_request_is_no_error(monkeypatch: pytest.MonkeyPatch) -> None:
    for value in ('false', ''):
        monkeypatch.setenv(SECURITY, value)
        require_ros()
    monkeypatch.delenv(SECURITY)
    require_ros()


def test_a_node_started_by_hand_finds_this_machine_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    found = []
    monkeypatch.delenv(SECURITY, raising=False)
    monkeypatch.setattr(rclpy, 'init', lambda **_: found.append(os.environ[RANGE]))
    monkeypatch.delenv(RANGE, raising=False)
    init_ros([])
    monkeypatch.setenv(RANGE, 'SUBNET')
    init_ros([])
    assert found == ['LOCALHOST', 'SUBNET']
