# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`live` prints one line and ends with its exit code when it cannot serve or is stopped."""

import os
import socket
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path

import pytest
from support.complaints import assert_one_line
from support.processes import Program

from ddct_bringup.programs import live as live_program

Start = Callable[..., tuple[Program, str]]


@pytest.fixture
def refuses(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> Callable[..., None]:
    """Return a function that requires `live` to refuse arguments in one line with these words."""
    monkeypatch.setattr(os, 'nice', lambda _: 0)

    def require(arguments: Sequence[str], *words: str) -> None:
        assert live_program.main([*arguments]) == 1
        printed = capfd.readouterr()
        assert_one_line(printed.err, 'ddct live', *words)
        assert not printed.out

    return require


def test_a_taken_port_is_named(extras: None, refuses: Callable[..., None]) -> None:
    with socket.create_server(('127.0.0.1', 0)) as taken:
        port = str(taken.getsockname()[1])
        refuses(['--port', port], f'port {port}', 'in use', '--port')


def test_a_host_that_is_not_there_is_named(extras: None, refuses: Callable[..., None]) -> None:
    host = 'no-such-host.invalid'
    refuses(['--port', '0', '--host', host], host, '--host')


@pytest.mark.parametrize('port', ['-1', '65536'])
def test_a_port_out_of_range_is_named(refuses: Callable[..., None], port: str) -> None:
    refuses(['--port', port], f'--port is {port}', '65535')


def test_without_the_extra_it_names_what_to_install(
    refuses: Callable[..., None], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, 'foxglove', None)
    refuses(['--port', '0'], 'foxglove-sdk', 'pip install foxglove-sdk')


@pytest.mark.parametrize(
    ('arguments', 'address'), [((), '127.0.0.1'), (('--host', '0.0.0.0'), '0.0.0.0')]
)
def test_it_listens_on_this_machine_alone_unless_the_user_names_another_and_ends_when_stopped(
    live: Start, arguments: tuple[str, ...], address: str
) -> None:
    program, url = live(*arguments)
    found = listening(program.process.pid)
    program.stop()
    assert not program.errors()
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


def test_help_ends_with_code_0(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        live_program.main(['--help'])
    assert ended.value.code == 0
    assert 'Foxglove' in capsys.readouterr().out
