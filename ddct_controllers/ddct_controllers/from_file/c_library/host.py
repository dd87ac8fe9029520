# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The process that loads a controller's library, and the processes that make its calls.

They are processes of their own because C may crash, loop for ever or print. The library is loaded
once. Each controller has a fork of the process that loaded it, so that none has the static
variables of another. Replies go over a socket, a message each; a process ends when the other end
closes.
"""

import contextlib
import json
import math
import os
import re
import signal
import socket
import struct
import sys
from pathlib import Path
from typing import Any

HEADER = 'ddct_controller.h'
TEMPLATE = Path(__file__).parent / 'template'
"""Path of the folder with the header and a controller to start from."""
RESET, UPDATE, HOLD = b'ruh'
"""
First byte of a request; UPDATE and HOLD continue with a measurement as C has it, then references.
"""
ANSWER = struct.Struct('ddi')
"""Struct of a reply: clutch and engine torque in N m, and the function's return value."""
STARTED, EXITED = struct.Struct('i'), struct.Struct('h')
"""
Structs of the first message for a controller, the id of its process, and of the last one, the
exit code of the process. No reply has the size of the last one.
"""
MOST_BYTES = 1 << 16
"""Largest size of a message in bytes."""
MOST_PREVIEW_STEPS = 1000
MOST_SECONDS = 10
"""Longest duration of a call in s; after it an alarm ends the process."""
_EXAMPLE = 'start from the template in docs/controllers/c_controller.md'


class LibraryError(Exception):
    """The library cannot be called."""


class Library:
    """A loaded library with the memory for one controller."""

    def __init__(self, path: str) -> None:
        """Load it; raise LibraryError when it is missing, no library, or of another interface."""
        # Only here: the program at the other end need not wait for it.
        import cffi

        self._ffi = ffi = cffi.FFI()
        header = (TEMPLATE / HEADER).read_text(encoding='utf-8')
        # cffi reads declarations alone; a macro goes on in the next line after a backslash. An
        # object that is const would be a constant of the compiler's, which it has none of.
        declarations = re.sub(r'^#(.*\\\n)*.*\n', '', header, flags=re.MULTILINE)
        ffi.cdef(declarations.replace('extern const ', 'extern '))
        ffi.cdef('int fflush(void *stream);')
        try:
            self._library = ffi.dlopen(path)
        except OSError as error:
            reason = str(error).partition('.  Additionally')[0]
            raise LibraryError(f'it cannot be loaded ({reason})') from error
        (version,) = re.findall(r'define DDCT_INTERFACE_VERSION (\d+)', header)
        about = self._symbol('ddct_controller')
        self._require('interface_version', about.interface_version, int(version))
        self._require('measurement_bytes', about.measurement_bytes, ffi.sizeof('ddct_measurement'))
        self._require('command_bytes', about.command_bytes, ffi.sizeof('ddct_command'))
        preview = range(MOST_PREVIEW_STEPS + 1)
        if about.preview_steps not in preview or about.commands_engine not in (0, 1):
            raise LibraryError(
                f'its preview_steps is {about.preview_steps} and its commands_engine '
                f'{about.commands_engine}: give 0 to {MOST_PREVIEW_STEPS} and 0 or 1'
            )
        self.preview_steps: int = about.preview_steps
        self.commands_engine = bool(about.commands_engine)
        self._calls = {
            RESET: self._symbol('ddct_controller_reset'),
            UPDATE: self._symbol('ddct_controller_update'),
            HOLD: getattr(self._library, 'ddct_controller_hold', None),
        }
        # Of doubles, so that whatever the struct holds is aligned.
        self._state = ffi.new('double[]', about.state_bytes // 8 + 1)
        self._measurement = ffi.new('ddct_measurement *')
        self._references = ffi.new('double[]', 2 * (self.preview_steps + 1))
        self._measurement.slip_reference = self._references
        self._measurement.slip_reference_rate = self._references + self.preview_steps + 1
        before_references = ffi.offsetof('ddct_measurement', 'slip_reference')
        self._scalars = ffi.buffer(self._measurement, before_references)

    def flush(self) -> None:
        """Write what C has printed, which a fork would print again."""
        self._ffi.dlopen(None).fflush(self._ffi.NULL)

    def answer(self, request: bytes) -> bytes:
        """Execute one request and return the reply."""
        kind = request[0]
        if kind == RESET or (kind == HOLD and self._calls[HOLD] is None):
            # NaN, so that what is not set shows at once, and not after a second run.
            self._ffi.buffer(self._state)[:] = b'\xff' * self._ffi.sizeof(self._state)
            self._calls[RESET](self._state)
            return ANSWER.pack(0.0, 0.0, 0)
        references = 1 + len(self._scalars)
        self._scalars[:] = request[1:references]
        self._ffi.buffer(self._references)[:] = request[references:]
        if kind == HOLD:
            return ANSWER.pack(0.0, 0.0, self._calls[HOLD](self._state, self._measurement))
        command = self._ffi.new('ddct_command *', (math.nan, math.nan))
        status = self._calls[UPDATE](self._state, self._measurement, command)
        return ANSWER.pack(command.clutch_torque, command.engine_torque, status)

    def _symbol(self, name: str) -> Any:
        try:
            return getattr(self._library, name)
        except (AttributeError, KeyError) as error:  # of a function, of an object
            raise LibraryError(f'it has no {name}: include {HEADER}, and {_EXAMPLE}') from error

    def _require(self, name: str, found: int, expected: int) -> None:
        if found != expected:
            raise LibraryError(
                f'its {name} is {found}, this ddct has {expected}: compile it with the '
                f'{HEADER} of this version, for this machine'
            )


def main() -> None:
    """
    Load the library argv[1] and describe it over the socket with the file descriptor argv[2].

    After that each socket received there gets a process that calls the library.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the program
    path, descriptor = sys.argv[1:]
    with socket.socket(fileno=int(descriptor)) as control:
        signal.alarm(MOST_SECONDS)
        try:
            library = Library(path)
        except LibraryError as error:
            words = str(error).encode(errors='replace').decode()  # a path may be no UTF-8
            control.send(json.dumps({'error': words}).encode())
            return
        about = {'preview_steps': library.preview_steps, 'two_input': library.commands_engine}
        control.send(json.dumps(about).encode())
        signal.alarm(0)
        signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # nobody waits for the processes below
        while channel := _received(control):
            library.flush()
            if not os.fork():
                control.close()
                _attend(library, channel)
                return
            channel.close()


def _received(control: socket.socket) -> socket.socket | None:
    """Return the socket of the next controller, None when the other end is closed."""
    _, descriptors, _, _ = socket.recv_fds(control, 1, 1)
    return socket.socket(fileno=descriptors[0]) if descriptors else None


def _attend(library: Library, channel: socket.socket) -> None:
    """Fork the process that calls the library; send its id first, and at its end its exit code."""
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    process = os.fork()
    if not process:
        _serve(library, channel)
        return
    with contextlib.suppress(OSError):  # the other end may be closed
        channel.send(STARTED.pack(process))
    _, status = os.waitpid(process, 0)
    with contextlib.suppress(OSError):
        channel.send(EXITED.pack(os.waitstatus_to_exitcode(status)))
    os._exit(0)


def _serve(library: Library, channel: socket.socket) -> None:
    """Make the calls of one controller until the other end is closed."""
    while request := channel.recv(MOST_BYTES):
        signal.alarm(MOST_SECONDS)
        answer = library.answer(request)
        signal.alarm(0)
        channel.send(answer)


if __name__ == '__main__':
    main()
