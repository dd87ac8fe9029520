# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Loaded libraries: one process for each, which forks a process for each controller."""

import contextlib
import os
import signal
import socket
import subprocess
import sys
import weakref
from pathlib import Path

from ddct_controllers.from_file.c_library import host
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.files.input_file import parse_json

_END_S = 1.0
"""Time in s for a process to end by itself, which writes what C has printed."""


class LoadedLibrary:
    """A library in its process."""

    def __init__(self, path: Path, where: str) -> None:
        """Start the process; raise ParameterError, beginning with `where`, if it is unusable."""
        self._control, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with theirs:
            process = subprocess.Popen(
                [sys.executable, '-P', host.__file__, str(path.resolve()), str(theirs.fileno())],
                pass_fds=[theirs.fileno()],
                stdin=subprocess.DEVNULL,
                stdout=2,  # what C prints is no result of the program
            )
        self.end = weakref.finalize(self, _end_host, self._control, process, os.getpid())
        message = received(self._control)
        if not message:
            code = process.wait()
            self.end()
            raise DdctError(f'{where}: {exit_text(code)} when it was loaded: mend the C')
        about = parse_json(message.decode())
        if 'error' in about:
            self.end()
            raise ParameterError(f'{where}: {about["error"]}')
        self.preview_steps: int = about['preview_steps']
        self.commands_engine: bool = about['two_input']

    @property
    def alive(self) -> bool:
        """Whether the process can start controllers; one that was killed cannot."""
        try:
            return bool(self._control.recv(1, socket.MSG_DONTWAIT | socket.MSG_PEEK))
        except BlockingIOError:
            return True
        except OSError:
            return False

    def start(self) -> tuple[socket.socket, int]:
        """Start a process that calls the library; return its socket and its id."""
        ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with theirs:
            socket.send_fds(self._control, [b'c'], [theirs.fileno()])
        (process,) = host.STARTED.unpack(received(ours))
        return ours, process


_loaded: 'weakref.WeakValueDictionary[tuple[Path, int, int, int], LoadedLibrary]' = (
    weakref.WeakValueDictionary()
)
"""Libraries in use, by path and identity of the file; forked workers share them."""


def loaded_library(path: Path, where: str) -> LoadedLibrary:
    """
    Return the library of a file, loaded once, and anew after it was compiled again.

    Its process ends with the last controller or specification that has it.
    """
    status = path.stat()
    identity = path, status.st_ino, status.st_mtime_ns, status.st_size
    library = _loaded.get(identity)
    if library is None or not library.alive:
        library = _loaded[identity] = LoadedLibrary(path, where)
    return library


def received(channel: socket.socket) -> bytes:
    """Return the next message, empty when the other end is closed."""
    try:
        return channel.recv(host.MOST_BYTES)
    except OSError:
        return b''


def exit_text(code: int) -> str:
    """Return how a process of C has ended."""
    if code == -signal.SIGALRM:
        return f'it gave no answer within {host.MOST_SECONDS} s'
    if code < 0:
        return f'it crashed ({signal.Signals(-code).name})'
    return f'it ended with exit code {code}'


def end_process(channel: socket.socket, process: int) -> None:
    """Let the process of a controller end by itself, or end it."""
    with channel, contextlib.suppress(OSError):
        channel.shutdown(socket.SHUT_WR)
        channel.settimeout(_END_S)
        try:
            while channel.recv(host.MOST_BYTES):
                pass
        except TimeoutError:
            os.kill(process, signal.SIGKILL)


def _end_host(control: socket.socket, process: 'subprocess.Popen[bytes]', owner: int) -> None:
    control.close()
    if os.getpid() != owner:  # a forked worker, whose parent still uses it
        return
    try:
        process.wait(timeout=_END_S)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
