# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
End of a process, and its messages to the supervisor.

Handlers of SIGINT and SIGTERM, signals at the end of the parent process, the pulse of a running
node, and its announced exit code.
"""

import ctypes
import os
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any

PULSE_FD = 'DDCT_PULSE_FD'
"""Environment variable with the non-blocking file descriptor that a supervisor has opened."""
EXIT_MARK = b'!'
"""Byte before the announced exit code of a node whose work is over."""
_CAUGHT = (signal.SIGINT, signal.SIGTERM)
_SET_PARENT_DEATH_SIGNAL = 1
_SET_TAKES_ORPHANS, _GET_TAKES_ORPHANS = 36, 37


@contextmanager
def stop_signals() -> Iterator[list[int]]:
    """Yield the list of received signals; the handlers from before are restored at the end."""
    received: list[int] = []
    with _handled(lambda caught, _frame: received.append(caught)):
        yield received


@contextmanager
def ends_at_once() -> Iterator[None]:
    """Let the kernel end the process at either signal, even if it hangs in foreign code."""
    with _handled(signal.SIG_DFL):
        yield


def end_with_parent(by: signal.Signals = signal.SIGTERM) -> None:
    """Let the kernel send this process the signal `by` when its parent ends (Linux)."""
    ctypes.CDLL(None).prctl(_SET_PARENT_DEATH_SIGNAL, by)


@contextmanager
def adopting_orphans() -> Iterator[None]:
    """Become the parent of all descendants whose parent ends meanwhile (Linux)."""
    prctl = ctypes.CDLL(None).prctl
    before = ctypes.c_int()
    prctl(_GET_TAKES_ORPHANS, ctypes.byref(before))
    prctl(_SET_TAKES_ORPHANS, 1)
    try:
        yield
    finally:
        prctl(_SET_TAKES_ORPHANS, before.value)


@contextmanager
def _handled(by: Callable[[int, Any], Any] | signal.Handlers) -> Iterator[None]:
    before = {number: signal.signal(number, by) for number in _CAUGHT}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def beat() -> None:
    """Send the supervisor one pulse of the running node; called periodically."""
    _write_to_supervisor(b'.')


def announce_exit(code: int) -> None:
    """Send the supervisor the exit code of the node, which only has to leave the graph."""
    _write_to_supervisor(EXIT_MARK + str(code).encode())


def _write_to_supervisor(data: bytes) -> None:
    descriptor = os.environ.get(PULSE_FD, '')
    if descriptor.isdecimal():
        # Full or closed: the supervisor does not read it now, or has ended.
        with suppress(OSError):
            os.write(int(descriptor), data)
