# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A server that fails on frames makes a finding of these frames, not of the next ones."""

import socket
from collections.abc import Iterator
from pathlib import Path
from threading import Thread
from types import SimpleNamespace

import pytest
from fuzz.reader import Reader
from fuzz.targets import live_readers
from fuzz.targets.live_readers import ADDRESS, read_frames

FATAL = b'fatal'
"""Frames after which the server serves nobody."""


def serve(listener: socket.socket) -> None:
    """Let viewers in and take their frames, until some are fatal."""
    fatal = False
    while not fatal:
        viewer, _ = listener.accept()
        with viewer:
            viewer.recv(4096)
            viewer.sendall(b'HTTP/1.1 101 Switching Protocols\r\n\r\n')
            frames = b''
            while part := viewer.recv(4096):
                frames += part
            fatal = FATAL in frames
            if fatal:
                listener.close()


@pytest.fixture(autouse=True)
def fragile_server(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Take the place of the live view's server."""
    with socket.create_server((ADDRESS, 0)) as listener:
        url = f'ws://{ADDRESS}:{listener.getsockname()[1]}'
        monkeypatch.setattr(live_readers, '_server', lambda: SimpleNamespace(url=url))
        thread = Thread(target=serve, args=(listener,), daemon=True)
        thread.start()
        yield
        thread.join(10.0)


def test_a_failure_is_a_finding_of_the_frames_that_cause_it(tmp_path: Path) -> None:
    reader = Reader('live_frames', 'frames', read_frames, (b'',))
    assert reader.finding(b'harmless', tmp_path / 'work') == ''
    assert reader.finding(FATAL, tmp_path / 'work').startswith('ConnectionRefusedError')
