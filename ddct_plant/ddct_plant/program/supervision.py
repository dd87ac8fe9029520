"""
How a process ends, and what it tells whoever supervises it.

What SIGINT and SIGTERM do for a while, what ends a process whose parent is gone; the pulse of a
node that runs, and its announced exit.
"""

import ctypes
import os
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any

PULSE_FD = 'DDCT_PULSE_FD'
"""Environment variable with the file descriptor, not blocking, that a supervisor has opened."""
EXIT_MARK = b'!'
"""Comes before the exit code of a node whose work is over."""
_CAUGHT = (signal.SIGINT, signal.SIGTERM)
_SET_PARENT_DEATH_SIGNAL = 1
_SET_TAKES_ORPHANS, _GET_TAKES_ORPHANS = 36, 37


@contextmanager
def stop_signals() -> Iterator[list[int]]:
    """Give the list that the signals are put into; what they did before comes back at the end."""
    received: list[int] = []
    with _handled(lambda caught, _frame: received.append(caught)):
        yield received


@contextmanager
def ends_at_once() -> Iterator[None]:
    """Let the kernel end the process by either signal, were it to hang in foreign code."""
    with _handled(signal.SIG_DFL):
        yield


def end_with_parent(by: signal.Signals = signal.SIGTERM) -> None:
    """Let the kernel send this process a signal when its parent ends, be it killed (Linux)."""
    ctypes.CDLL(None).prctl(_SET_PARENT_DEATH_SIGNAL, by)


@contextmanager
def adopting_orphans() -> Iterator[None]:
    """Become the parent of those descendants whose parent ends meanwhile (Linux)."""
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
    """Show that the node runs; called again and again."""
    _tell(b'.')


def announce_exit(code: int) -> None:
    """Say that the node's work is over with this exit code: it only has to leave the graph."""
    _tell(EXIT_MARK + str(code).encode())


def _tell(what: bytes) -> None:
    descriptor = os.environ.get(PULSE_FD, '')
    if descriptor.isdecimal():
        # Full or closed: the supervisor does not look at it now, or is gone.
        with suppress(OSError):
            os.write(int(descriptor), what)
