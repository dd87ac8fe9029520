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
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from typing import Any

PULSE_FD = 'DDCT_PULSE_FD'
"""Environment variable with the non-blocking file descriptor that a supervisor has opened."""
EXIT_MARK = b'!'
"""Byte before the announced exit code of a node whose work is over."""
_CAUGHT = (signal.SIGINT, signal.SIGTERM)
_SET_PARENT_DEATH_SIGNAL = 1
_SET_TAKES_ORPHANS, _GET_TAKES_ORPHANS = 36, 37


_interruptions: list[int] = []
"""Signals that were received since `interruptible` began."""


@contextmanager
def interruptible() -> Iterator[None]:
    """
    Raise KeyboardInterrupt at either signal; `interrupted_by` then returns which one it was.

    An ignored signal stays ignored, as SIGINT is in the background of a shell. Outside of the main
    thread, which alone may set handlers, this does nothing.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    _interruptions.clear()
    kept = [number for number in _CAUGHT if signal.getsignal(number) != signal.SIG_IGN]
    with _handled(_interrupt, kept):
        yield


def interrupted_by() -> int:
    """Return the first signal that was received since `interruptible` began, 0 for none."""
    return next(iter(_interruptions), 0)


def _interrupt(caught: int, _frame: object) -> None:
    _interruptions.append(caught)
    raise KeyboardInterrupt


@contextmanager
def stop_signals() -> Iterator[list[int]]:
    """Yield the list of received signals; the handlers from before are restored at the end."""
    received: list[int] = []

    def note(caught: int, _frame: object) -> None:
        received.append(caught)
        _interruptions.append(caught)

    with _handled(note):
        yield received


@contextmanager
def deferred_signals() -> Iterator[None]:
    """Handle a signal that is received within at the end, by the handler from before."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    with stop_signals() as received:
        yield
    for number in received[:1]:
        signal.raise_signal(number)


@contextmanager
def ends_at_once() -> Iterator[None]:
    """Let the kernel end the process at either signal, even if it hangs in foreign code."""
    with _handled(signal.SIG_DFL):
        yield


def end_with_parent(parent: int, by: signal.Signals = signal.SIGTERM) -> None:
    """
    Let the kernel send this process the signal `by` when its parent ends (Linux).

    `parent` is its process id. Where it has ended already, this process gets the signal at once:
    the kernel sends none for an end before this call.
    """
    ctypes.CDLL(None).prctl(_SET_PARENT_DEATH_SIGNAL, by)
    if os.getppid() != parent:
        os.kill(os.getpid(), by)


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
def _handled(
    by: Callable[[int, Any], Any] | signal.Handlers, numbers: Iterable[signal.Signals] = _CAUGHT
) -> Iterator[None]:
    before = {number: signal.signal(number, by) for number in numbers}
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
