# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The process that loads a third party's compiled code, and the processes that make its calls.

They are processes of their own because such code may crash, loop for ever, print, or end its
process. Each controller has a fork of the process that loaded the code, so that none has the
static variables of another. Replies go over a socket, a message each; a process ends when the
other end closes.

The program runs this file as a script, beside the file of one kind of code. Neither imports
anything of ours, so that the process starts quickly.
"""

import contextlib
import ctypes
import json
import os
import runpy
import signal
import socket
import struct
import sys
from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import NoReturn, Protocol

STARTED, ANSWER, FAILED, EXITED = b's', b'a', b'f', b'x'
"""
First byte of a message to the program.

STARTED continues with the id of the process that makes the calls, ANSWER with the reply of the
code, FAILED with a text on what failed, EXITED with the exit code of the process.
"""
NUMBER = struct.Struct('i')
"""Struct of a process id and of an exit code."""
MOST_BYTES = 1 << 16
"""Largest size of a message in bytes."""


class Code(Protocol):
    """Loaded code of one kind."""

    about: object
    """Description for the program, as plain values."""

    def open(self) -> None:
        """Load what runs code of the third party already when it is loaded."""

    def prepared(self) -> AbstractContextManager[object]:
        """Return a context manager with what the process of one controller needs."""

    def answer(self, request: bytes) -> bytes:
        """Execute one request and return the reply; any Exception's text goes to the program."""

    def end(self) -> None:
        """Free what a controller has taken."""


def main() -> None:
    """
    Load the file argv[2] by `load` of the script argv[1], and describe it over a socket.

    The socket has the file descriptor argv[3]; a call may take argv[4] seconds, after which an
    alarm ends its process. Each socket received there gets a process that calls the code.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the program
    script, path, descriptor, seconds = sys.argv[1:]
    load: Callable[[str], Code] = runpy.run_path(script)['load']
    with socket.socket(fileno=int(descriptor)) as control:
        try:
            code = load(path)
            signal.alarm(int(seconds))
            code.open()
        except Exception as error:
            control.send(json.dumps({'error': _text(error)}).encode())
            return
        control.send(json.dumps({'about': code.about}).encode())
        signal.alarm(0)
        signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # nobody waits for the processes below
        while channel := _received(control):
            # What the code has printed, a fork would print again.
            ctypes.CDLL(None).fflush(None)
            if not os.fork():
                control.close()
                _attend(code, channel, int(seconds))
                return
            channel.close()


def _received(control: socket.socket) -> socket.socket | None:
    """Return the socket of the next controller, None when the other end is closed."""
    _, descriptors, _, _ = socket.recv_fds(control, 1, 1)
    return socket.socket(fileno=descriptors[0]) if descriptors else None


def _attend(code: Code, channel: socket.socket, seconds: int) -> None:
    """Fork the process that calls the code; send its id first, and at its end its exit code."""
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    # It outlives the process below, whose files it removes; a closed terminal must not end it.
    for number in (signal.SIGHUP, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    with contextlib.suppress(OSError):  # the other end may be closed
        try:
            with code.prepared():
                process = os.fork()
                if not process:
                    _serve(code, channel, seconds)
                channel.send(STARTED + NUMBER.pack(process))
                _, status = os.waitpid(process, 0)
        except Exception as error:
            channel.send(FAILED + _text(error).encode())
        else:
            channel.send(EXITED + NUMBER.pack(os.waitstatus_to_exitcode(status)))
    os._exit(0)


def _serve(code: Code, channel: socket.socket, seconds: int) -> NoReturn:
    """Make the calls of one controller until the other end is closed, and end this process."""
    for number in (signal.SIGHUP, signal.SIGTERM):
        signal.signal(number, signal.SIG_DFL)
    try:
        while request := channel.recv(MOST_BYTES):
            signal.alarm(seconds)
            try:
                reply = ANSWER + code.answer(request)
            except Exception as error:
                reply = FAILED + _text(error).encode()
            signal.alarm(0)
            channel.send(reply)
        signal.alarm(seconds)
        code.end()
    finally:
        # As at the end of a program in C: what it has printed is written.
        ctypes.CDLL(None).exit(0)
        os._exit(0)


def _text(error: Exception) -> str:
    """Return the text of an error for a message; a path in it may be no UTF-8."""
    return str(error).encode(errors='replace').decode()[: MOST_BYTES // 8]


if __name__ == '__main__':
    main()
