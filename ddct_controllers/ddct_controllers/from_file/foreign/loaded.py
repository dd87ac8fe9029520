# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Loaded compiled code: a process for each file, which forks a process for each controller."""

import contextlib
import os
import signal
import socket
import subprocess
import sys
import weakref
from collections.abc import Sequence
from pathlib import Path

from ddct_controllers.from_file.foreign import serving
from ddct_plant.files.json_records import parse_json

MOST_SECONDS = 10
"""Longest duration of a call in s; after it an alarm ends the process."""
_END_S = 1.0
"""Time in s for a process to end by itself, which writes what its code has printed."""


class CodeRefusedError(Exception):
    """Code that cannot be used: the text says why, not in which file."""


class CodeFailedError(Exception):
    """A call that failed, or did not return: the text says how, not in which file."""


class LoadedCode:
    """Code of one file in its process."""

    def __init__(self, script: Path, path: Path) -> None:
        """
        Start the process, in which `load` of `script` loads the file `path`.

        Raise CodeFailedError when it ends instead, CodeRefusedError when the code is unusable.
        """
        self._control, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        arguments = [serving.__file__, script, path.resolve(), theirs.fileno(), MOST_SECONDS]
        with theirs:
            process = subprocess.Popen(
                [sys.executable, '-P', *map(str, arguments)],
                pass_fds=[theirs.fileno()],
                stdin=subprocess.DEVNULL,
                stdout=2,  # what the code prints is no result of the program
            )
        self.end = weakref.finalize(self, _end_process, self._control, process, os.getpid())
        received = _received(self._control)
        if not received:
            code = process.wait()
            self.end()
            raise CodeFailedError(_exit_text(code))
        message = parse_json(received.decode())
        if 'error' in message:
            self.end()
            raise CodeRefusedError(message['error'])
        self.about = message['about']
        """Description of the code, as plain values."""

    @property
    def alive(self) -> bool:
        """Whether the process can start controllers; one that was killed cannot."""
        try:
            return bool(self._control.recv(1, socket.MSG_DONTWAIT | socket.MSG_PEEK))
        except BlockingIOError:
            return True
        except OSError:
            return False

    def start(self) -> 'ForeignProcess':
        """Start a process that calls the code; raise CodeFailedError when that fails."""
        ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with theirs, contextlib.suppress(OSError):  # it has ended; `ForeignProcess` raises
            socket.send_fds(self._control, [b'c'], [theirs.fileno()])
        return ForeignProcess(ours)


class ForeignProcess:
    """Process that makes the calls of one controller; it ends with this object."""

    def __init__(self, channel: socket.socket) -> None:
        """Wait for the process at the end of `channel`; raise CodeFailedError without one."""
        self._channel = channel
        process: list[int] = []
        self.end = weakref.finalize(self, _end_calls, channel, process)
        """Let the process end by itself, or end it."""
        (self.pid,) = serving.NUMBER.unpack(self._reply(serving.STARTED))
        process.append(self.pid)

    def call(self, request: bytes) -> bytes:
        """Return the reply to one request; raise CodeFailedError when the call failed or ended."""
        if len(request) > serving.MOST_BYTES:
            raise CodeFailedError(f'a call of {len(request)} bytes is too long')
        with contextlib.suppress(OSError):  # it ended before; `_reply` raises
            self._channel.send(request)
        return self._reply(serving.ANSWER)

    def _reply(self, expected: bytes) -> bytes:
        """Return the next message without its first byte; CodeFailedError for another kind."""
        message = _received(self._channel)
        kind, content = message[:1], message[1:]
        if kind == expected:
            return content
        if kind == serving.FAILED:
            raise CodeFailedError(content.decode())
        self.end()
        code = serving.NUMBER.unpack(content)[0] if kind == serving.EXITED else -signal.SIGKILL
        raise CodeFailedError(_exit_text(code))


_loaded: 'weakref.WeakValueDictionary[tuple[Path, int, int, int], LoadedCode]' = (
    weakref.WeakValueDictionary()
)
"""Code in use, by path and identity of the file; forked workers share it."""


def loaded_code(script: Path, path: Path) -> LoadedCode:
    """
    Return the code of a file, loaded once, and anew after the file has changed.

    Its process ends with the last controller or specification that has it. Raise the errors of
    `LoadedCode`.
    """
    status = path.stat()
    identity = path, status.st_ino, status.st_mtime_ns, status.st_size
    code = _loaded.get(identity)
    if code is None or not code.alive:
        code = _loaded[identity] = LoadedCode(script, path)
    return code


def _received(channel: socket.socket) -> bytes:
    """Return the next message, empty when the other end is closed."""
    try:
        return channel.recv(serving.MOST_BYTES)
    except OSError:
        return b''


def _exit_text(code: int) -> str:
    """Return how a process of compiled code has ended."""
    if code == -signal.SIGALRM:
        return f'it gave no answer within {MOST_SECONDS} s'
    if code < 0:
        names = {each.value: each.name for each in signal.Signals}
        return f'it crashed ({names.get(-code, f"signal {-code}")})'
    return f'it ended with exit code {code}'


def _end_calls(channel: socket.socket, process: Sequence[int]) -> None:
    """Let the process with this id, if it has one, end by itself, or end it with its files."""
    with channel, contextlib.suppress(OSError):
        channel.shutdown(socket.SHUT_WR)
        channel.settimeout(_END_S)
        for last in (False, True):
            try:
                while channel.recv(serving.MOST_BYTES):
                    pass
            except TimeoutError:
                if process and not last:
                    os.kill(process[0], signal.SIGKILL)
            else:
                return


def _end_process(control: socket.socket, process: 'subprocess.Popen[bytes]', owner: int) -> None:
    """Let the process that loaded the code end by itself, or end it."""
    control.close()
    if os.getpid() != owner:  # a forked worker, whose parent still uses it
        return
    try:
        process.wait(timeout=_END_S)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
