# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`bringup --live`, and `compare --live`, when there is no viewer, or no way to serve one."""

import signal
import socket
from pathlib import Path

import pytest
from support.complaints import assert_one_line
from support.processes import Programs
from waiting import wait_until

from ddct_bringup.programs import bringup, compare


@pytest.mark.parametrize('layout', ['--headless', '--single-process'])
def test_it_needs_a_process_per_node(
    capfd: pytest.CaptureFixture[str], tmp_path: Path, layout: str
) -> None:
    assert bringup.main(['--live', '0', layout, '--out', str(tmp_path / 'runs')]) == 1
    assert_one_line(capfd.readouterr().err, 'bringup', '--live', layout)
    assert not (tmp_path / 'runs').exists()


def test_compare_shows_one_run(capfd: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    out = str(tmp_path / 'runs')
    assert compare.main(['--controllers', 'pi,ls8', '--live', '0', '--out', out]) == 1
    assert_one_line(capfd.readouterr().err, 'ddct compare', '--live shows one run, not 2')


@pytest.mark.usefixtures('extras')
def test_a_taken_port_ends_it_before_the_run(
    capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    with socket.create_server(('127.0.0.1', 0)) as taken:
        port = str(taken.getsockname()[1])
        assert bringup.main(['--live', port, '--out', str(tmp_path / 'runs')]) == 1
    assert_one_line(capfd.readouterr().err, 'bringup', f'port {port}', 'in use')


@pytest.mark.usefixtures('extras')
def test_ctrl_c_ends_the_wait_for_a_viewer(programs: Programs, tmp_path: Path) -> None:
    program = programs.start_module(
        'ddct_bringup.programs.bringup', '--live', '0', '--out', str(tmp_path / 'runs')
    )
    wait_until(lambda: 'ws://' in program.errors(), 'the address of the live view')
    program.send(signal.SIGINT)
    assert program.wait() == 130
    (last,) = program.errors().splitlines()[1:]
    assert last.startswith('bringup: interrupted: ')
