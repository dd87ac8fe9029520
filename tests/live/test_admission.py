# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Who may connect to the live view: programs and Foxglove, and no other web page."""

import asyncio
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import pytest
from support.processes import Program

from ddct_bringup.live.gate import Gate, secret_address
from ddct_bringup.live.handshake import ORIGINS, Admission

Start = Callable[..., tuple[Program, str]]
KEY = ('Connection: Upgrade', 'Sec-WebSocket-Version: 13', 'Sec-WebSocket-Key: ' + 22 * 'A' + '==')
UPGRADE = ('Upgrade: websocket', 'Sec-WebSocket-Protocol: foxglove.sdk.v1', *KEY)
HERE = 'Host: 127.0.0.1:8765'
EVIL = 'https://evil.example'


def head(*fields: str, request: str = 'GET / HTTP/1.1') -> bytes:
    """Return the first lines of a connection with these fields."""
    return '\r\n'.join((request, *fields, '', '')).encode()


def status(text: bytes, admission: Admission) -> int:
    return admission.refusal(text)[0]


@pytest.mark.parametrize(
    ('text', 'expected'),
    [
        (head(HERE, *UPGRADE), 0),
        (head('Host: localhost:9000', *UPGRADE), 0),
        (head('Host: [::1]:8765', *UPGRADE), 0),
        *((head(HERE, f'Origin: {origin}', *UPGRADE), 0) for origin in ORIGINS),
        (head(HERE, f'Origin: {EVIL}', *UPGRADE), 403),
        (head(HERE, 'Origin: null', *UPGRADE), 403),
        (head(HERE, 'Origin: http://127.0.0.1:8765', *UPGRADE), 403),
        (head(HERE, f'origin: {ORIGINS[0]}.evil.example', *UPGRADE), 403),
        (head(HERE, f'Origin: {ORIGINS[0]}', f'Origin: {EVIL}', *UPGRADE), 400),
        (head(HERE, f'Origin : {EVIL}', *UPGRADE), 400),
        (head(HERE, f'X: 1\nOrigin: {EVIL}', *UPGRADE), 400),
        (head(HERE, f' Origin: {EVIL}', *UPGRADE), 400),
        (head('Host: evil.example', *UPGRADE), 403),
        (head('Host: 192.0.2.7:8765', *UPGRADE), 403),
        (head('Host: [', *UPGRADE), 403),
        (head(*UPGRADE), 403),
        (head(HERE, *KEY), 400),
        (head(HERE, *UPGRADE, request='GET /topics HTTP/1.1'), 404),
        (head(HERE, *UPGRADE, request='GET /?a=b HTTP/1.1'), 404),
        (head(HERE, *UPGRADE, request='POST / HTTP/1.1'), 400),
        (head(HERE, *UPGRADE, request='GET / HTTP/1.0'), 400),
        (b'\xff\x00', 400),
        (b'', 400),
    ],
)
def test_only_programs_and_foxglove_on_this_machine_may_connect(
    text: bytes, expected: int
) -> None:
    assert status(text, Admission('127.0.0.1')) == expected


def test_an_origin_and_other_machines_may_be_allowed() -> None:
    foreign = head(HERE, f'Origin: {EVIL}', *UPGRADE)
    assert status(foreign, Admission('127.0.0.1', (*ORIGINS, EVIL))) == 0
    by_address, by_name = (head(f'Host: {name}', *UPGRADE) for name in ('192.0.2.7', 'evil.name'))
    assert status(by_address, Admission('0.0.0.0')) == 0
    assert status(by_name, Admission('0.0.0.0')) == 403
    assert status(by_name, Admission('evil.name')) == 0


def answer(url: str, text: bytes) -> bytes:
    """Return the first line of what the server at `url` replies to raw bytes."""
    host, port = url.removeprefix('ws://').split(':')
    with socket.create_connection((host, int(port)), 30.0) as client:
        client.sendall(text)
        return client.makefile('rb').readline()


def test_a_raw_client_gets_what_the_admission_says(live: Start) -> None:
    program, url = live('--origin', 'https://own.example')
    for origin, line in (
        (ORIGINS[0], b'HTTP/1.1 101 '),
        ('https://own.example', b'HTTP/1.1 101 '),
        (EVIL, b'HTTP/1.1 403 '),
    ):
        assert answer(url, head(HERE, f'Origin: {origin}', *UPGRADE)).startswith(line), origin
    assert answer(url, head('Host: evil.example', *UPGRADE)).startswith(b'HTTP/1.1 403 ')
    assert answer(url, head(f'X: {9000 * "x"}')).startswith(b'HTTP/1.1 400 ')
    program.stop()
    refused = [line for line in program.output().splitlines() if 'was refused' in line]
    assert any(EVIL in line and '--origin' in line for line in refused)


def test_no_address_of_this_machine_that_a_page_can_guess_serves(live: Start) -> None:
    """The server behind the gate checks nothing: it listens where a page cannot find it."""
    program, url = live()
    pid = program.process.pid
    ports = listening(pid)
    program.stop()
    assert len(ports) == 2
    (inner,) = [address for address, port in ports if f':{port}' not in url]
    assert inner.startswith('127.') and inner != '127.0.0.1'


@pytest.fixture
def gate(monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[str, list[str]]]:
    """Yield the address of a gate that waits for a tenth of a second, and what it prints."""
    monkeypatch.setattr('ddct_bringup.live.gate._HEAD_S', 0.1)
    lines: list[str] = []
    gate = Gate(Admission('127.0.0.1'), 0, ('127.0.0.1', 1), lines.append)
    yield f'ws://127.0.0.1:{gate.port}', lines
    gate.stop()


def test_a_connection_without_first_lines_is_closed(gate: tuple[str, list[str]]) -> None:
    url, lines = gate
    assert answer(url, b'GET / HTTP/1.1') == b''
    assert not lines


async def accepted_one() -> None:
    """Wait until a connection has a task besides this one."""
    while len(asyncio.all_tasks()) < 2:
        await asyncio.sleep(0.01)


def test_a_gate_that_stops_does_not_wait_for_a_silent_connection(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr('ddct_bringup.live.gate._HEAD_S', 3600.0)
    gate = Gate(Admission('127.0.0.1'), 0, ('127.0.0.1', 1), lambda line: None)
    stopping = threading.Thread(target=gate.stop, daemon=True)
    with socket.create_connection(('127.0.0.1', gate.port), 30.0):
        asyncio.run_coroutine_threadsafe(accepted_one(), gate._loop).result(30.0)
        stopping.start()
        stopping.join(30.0)
        assert not stopping.is_alive()


def test_a_refusal_that_comes_again_is_printed_once(gate: tuple[str, list[str]]) -> None:
    url, lines = gate
    for origin in (EVIL, EVIL, 'null', EVIL):
        refused = answer(url, head(HERE, f'Origin: {origin}', *UPGRADE))
        assert refused.startswith(b'HTTP/1.1 403 ')
    assert [EVIL in line for line in lines] == [True, False]


def test_the_address_behind_the_gate_is_another_one_in_each_run() -> None:
    assert len({secret_address() for _ in range(5)}) > 1


def listening(pid: int) -> set[tuple[str, int]]:
    """Return the addresses and ports on which TCP connections of a process are accepted."""
    targets = []
    for link in Path(f'/proc/{pid}/fd').iterdir():
        with suppress(FileNotFoundError):  # closed meanwhile
            targets.append(link.readlink().name)
    prefix = 'socket:['
    sockets = {name[len(prefix) : -1] for name in targets if name.startswith(prefix)}
    lines = Path(f'/proc/{pid}/net/tcp').read_text().splitlines()[1:]
    found = set()
    for words in map(str.split, lines):
        if words[9] in sockets and words[3] == '0A':
            address, _, port = words[1].partition(':')
            found.add((socket.inet_ntoa(bytes.fromhex(address)[::-1]), int(port, 16)))
    return found
