# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`live` prints one line and ends with its exit code when it cannot serve or is stopped."""

import socket
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import pytest
from support.complaints import assert_one_line
from support.processes import Program, Programs

Start = Callable[..., tuple[Program, str]]
LIVE = 'ddct_bringup.programs.live'


def test_a_taken_port_is_named(extras: None, programs: Programs) -> None:
    with socket.create_server(('127.0.0.1', 0)) as taken:
        port = str(taken.getsockname()[1])
        program = programs.start_module(LIVE, '--port', port)
        assert program.wait() == 1
    assert_one_line(program.errors(), 'ddct live', f'port {port}', 'in use', '--port')
    assert not program.output()


def test_a_host_that_is_not_there_is_named(extras: None, programs: Programs) -> None:
    program = programs.start_module(LIVE, '--port', '0', '--host', 'no-such-host.invalid')
    assert program.wait() == 1
    assert_one_line(program.errors(), 'ddct live', 'no-such-host.invalid', '--host')


@pytest.mark.parametrize('port', ['-1', '65536'])
def test_a_port_out_of_range_is_named(programs: Programs, port: str) -> None:
    program = programs.start_module(LIVE, '--port', port)
    assert program.wait() == 1
    assert_one_line(program.errors(), 'ddct live', f'--port is {port}', '65535')


def test_without_the_extra_it_names_what_to_install(
    programs: Programs, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / 'foxglove.py').write_text('raise ImportError("No module named foxglove")')
    monkeypatch.setenv('PYTHONPATH', str(tmp_path), prepend=':')
    program = programs.start_module(LIVE, '--port', '0')
    assert program.wait() == 1
    assert_one_line(program.errors(), 'ddct live', 'foxglove-sdk', 'pip install foxglove-sdk')


@pytest.mark.parametrize(
    ('arguments', 'address'), [((), '127.0.0.1'), (('--host', '0.0.0.0'), '0.0.0.0')]
)
def test_it_listens_on_this_machine_alone_unless_the_user_names_another_address(
    live: Start, arguments: tuple[str, ...], address: str
) -> None:
    program, url = live(*arguments)
    found = listening(program.process.pid)
    program.stop()
    assert found == {(address, int(url.rpartition(':')[2]))}


def listening(pid: int) -> set[tuple[str, int]]:
    """Return the addresses and ports on which TCP connections of a process are accepted."""
    targets = []
    for link in Path(f'/proc/{pid}/fd').iterdir():
        with suppress(FileNotFoundError):  # closed meanwhile
            targets.append(link.readlink().name)
    prefix = 'socket:['
    sockets = {name[len(prefix) : -1] for name in targets if name.startswith(prefix)}
    found = set()
    for words in map(str.split, Path(f'/proc/{pid}/net/tcp').read_text().splitlines()[1:]):
        if words[9] in sockets and words[3] == '0A':
            address, _, port = words[1].partition(':')
            found.add((socket.inet_ntoa(bytes.fromhex(address)[::-1]), int(port, 16)))
    return found


def test_it_ends_with_code_0_when_stopped(live: Start) -> None:
    program, _ = live()
    program.stop()
    assert not program.errors()


def test_help_ends_with_code_0(programs: Programs) -> None:
    program = programs.start_module(LIVE, '--help')
    assert program.wait() == 0
    assert 'Foxglove' in program.output()
