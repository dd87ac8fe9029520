# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A ROS_DOMAIN_ID that is none ends nodes and programs with one line, before anything is left."""

import subprocess
import sys
from contextlib import ExitStack
from pathlib import Path
from types import ModuleType

import pytest
from refusals import refused
from support.complaints import assert_one_line
from support.processes import Programs

from ddct_bringup.programs import bringup, compare
from ddct_plant.base.errors import DdctError
from ddct_plant.graph import domain
from ddct_plant.graph.domain import LAST_DOMAIN, own_domain, require_domain


@pytest.mark.parametrize('given', ['abc', '-1', '233'])
def test_a_node_names_it(programs: Programs, monkeypatch: pytest.MonkeyPatch, given: str) -> None:
    monkeypatch.setenv('ROS_DOMAIN_ID', given)
    program = programs.start_node('ddct_plant.nodes.engine_node', {})
    assert program.wait() == 1
    assert_one_line(program.errors(), 'engine', 'ROS_DOMAIN_ID', repr(given), '0 to 232')


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
    assert bringup.main(['--headless', '--duration', '0.7', '--out', str(tmp_path / 'out')]) == 0


def test_each_graph_has_another_domain_than_the_one_before(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Killed nodes stay visible in the last domain, and keep its shared memory."""
    monkeypatch.delenv('ROS_DOMAIN_ID')
    domains = []
    for _ in range(10):
        with own_domain() as each:
            domains.append(each)
    assert len(set(domains)) == len(domains)


def test_the_lowest_and_the_highest_domain_are_respected(monkeypatch: pytest.MonkeyPatch) -> None:
    for given in (0, LAST_DOMAIN):
        monkeypatch.setenv('ROS_DOMAIN_ID', str(given))
        assert require_domain() == given
        with own_domain() as each:
            assert each == given
        assert require_domain() == given


def test_each_program_begins_with_another_domain_than_the_one_before(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It follows from the id of the process; these are so far apart that no graph is between."""
    monkeypatch.delenv('ROS_DOMAIN_ID')
    program = (
        'import os\n'
        'os.getpid = lambda: {}\n'
        'from ddct_plant.graph.domain import own_domain\n'
        'with own_domain() as each:\n'
        '    print(each)\n'
    )
    commands = [[sys.executable, '-c', program.format(pid)] for pid in (5000, 5033, 5066)]
    domains = [subprocess.check_output(command, text=True) for command in commands]
    assert len(set(domains)) == 3


def test_no_graph_takes_the_domain_that_another_one_has(monkeypatch: pytest.MonkeyPatch) -> None:
    """Among three domains, whose ports are others than those of the graphs of this machine."""
    monkeypatch.setattr(domain, '_DOMAINS', range(1, 4))
    monkeypatch.setattr(domain, '_FIRST_PORT', 28000)
    taken = []
    with ExitStack() as graphs:
        for _ in range(3):
            monkeypatch.delenv('ROS_DOMAIN_ID')
            taken.append(graphs.enter_context(own_domain()))
        assert sorted(taken) == [1, 2, 3]
        monkeypatch.delenv('ROS_DOMAIN_ID')
        with refused(DdctError), own_domain():
            pass
