# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Inputs from the network: the frames of a viewer of the live view."""

import json
import socket
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path

import foxglove
from ddct_bringup.live.server import LiveServer

ADDRESS = '127.0.0.1'
_ANSWER_S = 10.0
_BLOCK_BYTES = 65536
_TEXT, _BINARY, _CLOSE, _PING = 1, 2, 8, 9
_MASK = b'mask'


class NoAnswerError(Exception):
    """The server no longer lets a viewer in."""


def frames() -> tuple[bytes, ...]:
    """Return what viewers send after the first lines."""
    subscribe = {'op': 'subscribe', 'subscriptions': [{'id': 1, 'channelId': 1}]}
    leave = {'op': 'unsubscribe', 'subscriptionIds': [1]}
    request = {'op': 'getParameters', 'parameterNames': ['x'], 'id': 'y'}
    texts = [json.dumps(each).encode() for each in (subscribe, leave, request)]
    return (
        b''.join(_frame(_TEXT, text) for text in texts),
        *(_frame(_TEXT, text) for text in texts),
        _frame(_BINARY, struct.pack('<BI', 1, 1) + b'\x00\x01\x00\x00'),
        _frame(_PING, b'now') + _frame(_CLOSE, struct.pack('>H', 1000)),
    )


def read_frames(file: Path) -> object:
    """
    Send frames to a server; raise NoAnswerError where it lets nobody in after them.

    It has taken all of them when it closes the connection. Without this wait, and without the
    second viewer, a failure would appear at a later input.
    """
    server = _server()
    with _connected(server) as viewer:
        viewer.sendall(file.read_bytes())
        viewer.shutdown(socket.SHUT_WR)
        while viewer.recv(_BLOCK_BYTES):
            pass
    with _connected(server):
        return None


@contextmanager
def _connected(server: LiveServer) -> Iterator[socket.socket]:
    port = int(server.url.rpartition(':')[2])
    with socket.create_connection((ADDRESS, port), _ANSWER_S) as viewer:
        viewer.sendall(_head())
        if not viewer.recv(4096).startswith(b'HTTP/1.1 101'):
            raise NoAnswerError('a viewer is not let in')
        try:
            yield viewer
        except (BrokenPipeError, ConnectionResetError):  # it may hang up on bad frames
            return


@cache
def _server() -> LiveServer:
    """Return the server of this process, which serves until the process ends."""
    # It would log every bad frame.
    foxglove.set_log_level('CRITICAL')
    return LiveServer(ADDRESS, 0, lambda _: None)


def _head() -> bytes:
    lines = [
        *('GET / HTTP/1.1', 'Host: 127.0.0.1:8765', 'Upgrade: websocket'),
        *('Connection: Upgrade', 'Sec-WebSocket-Version: 13'),
        *('Sec-WebSocket-Key: ' + 22 * 'A' + '==', 'Sec-WebSocket-Protocol: foxglove.sdk.v1'),
    ]
    return '\r\n'.join((*lines, '', '')).encode()


def _frame(kind: int, payload: bytes) -> bytes:
    """Return a masked frame, as viewers must send."""
    length = struct.pack('>B', 0x80 | len(payload))
    if len(payload) > 125:
        length = struct.pack('>BH', 0x80 | 126, len(payload))
    masked = bytes(byte ^ _MASK[place % 4] for place, byte in enumerate(payload))
    return bytes([0x80 | kind]) + length + _MASK + masked
