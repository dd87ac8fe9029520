# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A ROS_DOMAIN_ID that is none ends nodes and programs with one line, before anything is left."""

from pathlib import Path
from types import ModuleType

import pytest
from support.complaints import assert_one_line
from support.processes import Programs

from ddct_bringup.programs import bringup, compare
from ddct_plant.graph.domain import own_domain


@pytest.mark.parametrize('domain', ['abc', '-1', '233'])
def test_a_node_names_it(programs: Programs, monkeypatch: pytest.MonkeyPatch, domain: str) -> None:
    monkeypatch.setenv('ROS_DOMAIN_ID', domain)
    program = programs.start_node('ddct_plant.nodes.engine_node', {})
    assert program.wait() == 1
    assert_one_line(program.errors(), 'engine', 'ROS_DOMAIN_ID', repr(domain), '0 to 232')


@pytest.mark.parametrize('program', [bringup, compare])
def test_a_run_names_it_once_and_makes_no_folder(
    program: ModuleType,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
    tmp_path: Path,
) -> None:
    monkeypatch.setenv('ROS_DOMAIN_ID', '999')
    name, out = program.PROGRAM, tmp_path / 'out'
    assert program.main(['--out', str(out)]) == 1
    assert_one_line(capfd.readouterr().err, name, 'ROS_DOMAIN_ID', "'999'")
    assert not list(tmp_path.iterdir())


def test_a_run_without_a_graph_does_not_read_it(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv('ROS_DOMAIN_ID', '999')
    assert bringup.main(['--headless', '--out', str(tmp_path / 'out')]) == 0


def test_each_graph_has_another_domain_than_the_one_before(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Killed nodes stay visible in the last domain, and keep its shared memory."""
    monkeypatch.delenv('ROS_DOMAIN_ID')
    domains = []
    for _ in range(10):
        with own_domain() as domain:
            domains.append(domain)
    assert len(set(domains)) == len(domains)
