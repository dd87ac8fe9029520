# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
End of a process, and its messages to the supervisor.

Handlers of SIGINT and SIGTERM, signals at the end of the parent process, the pulse of a running
node, and its announced exit code.
"""

import atexit
import ctypes
import operator
import os
import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from types import FrameType
from typing import Any

PULSE_FD = 'DDCT_PULSE_FD'
"""Environment variable with the non-blocking file descriptor that a supervisor has opened."""
EXIT_MARK = b'!'
"""Byte before the announced exit code of a node whose work is over."""
_CAUGHT = (signal.SIGINT, signal.SIGTERM)
_SET_PARENT_DEATH_SIGNAL = 1
_SET_TAKES_ORPHANS, _GET_TAKES_ORPHANS = 36, 37


_interruptions: list[int] = []
"""Signals that were received since the outermost `interruptible` began."""
_depth = 0
"""Number of `interruptible` within one another."""
_reported = False
"""Whether an interruption was reported since the outermost of them began."""


@contextmanager
def interruptible(*, ends_process: bool = False) -> Iterator[Callable[[Callable[[], Any]], Any]]:
    """
    Yield a function that calls another, and raises KeyboardInterrupt at either signal meanwhile.

    `interrupted_by` then returns which signal it was. A signal before the call is raised at its
    beginning, and one after it only noted: raised while an earlier one is reported, it would end
    the program with a traceback. Where the process ends after the outermost `interruptible`, a
    second SIGINT gives no traceback there either.

    An ignored signal stays ignored, as SIGINT is in the background of a shell. Outside of the main
    thread, which alone may set handlers, the function only calls the other.
    """
    global _depth, _reported
    if threading.current_thread() is not threading.main_thread():
        yield operator.call
        return
    if not _depth:
        _interruptions.clear()
        _reported = False
    kept = [number for number in _CAUGHT if signal.getsignal(number) != signal.SIG_IGN]
    _depth += 1
    try:
        with _handled(_interrupt, kept) as before:
            yield _called
            if ends_process and _depth == 1 and _reported and signal.SIGINT in before:
                before[signal.SIGINT] = _end_at_once
                # Python gives SIGINT its default action back while it frees its modules.
                atexit.register(signal.signal, signal.SIGINT, signal.SIG_IGN)
    finally:
        _depth -= 1


def interrupted_by() -> int:
    """Return the first signal that was received since `interruptible` began, 0 for none."""
    return next(iter(_interruptions), 0)


def stems_from_interrupt(error: BaseException | None) -> bool:
    """
    Return whether an exception is a KeyboardInterrupt, or began as one.

    Python wraps what is raised in `__set_name__`, and some modules report any failure while they
    are imported as an ImportError.
    """
    passed: set[int] = set()
    while error is not None and id(error) not in passed:
        if isinstance(error, KeyboardInterrupt):
            return True
        passed.add(id(error))
        error = error.__cause__ or error.__context__
    return False


def is_first_report() -> bool:
    """Return whether no program within the outermost `interruptible` reports it before this."""
    global _reported
    first, _reported = not _reported, True
    return first


def _called(work: Callable[[], Any]) -> Any:
    """Return the result of `work`; a signal is raised while this is on the stack."""
    if _interruptions:
        raise KeyboardInterrupt
    return work()


def _interrupt(caught: int, frame: FrameType | None) -> None:
    _interruptions.append(caught)
    calls = 0
    while frame is not None:
        calls += frame.f_code is _called.__code__
        frame = frame.f_back
    if calls == _depth:  # else the innermost program has not begun its work or has ended it
        raise KeyboardInterrupt


def _end_at_once(_caught: int, _frame: object) -> None:
    os._exit(128 + interrupted_by())


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
) -> Iterator[dict[signal.Signals, Any]]:
    """Handle signals within; yield the handlers from before, which are restored at the end."""
    before: dict[signal.Signals, Any] = {}
    try:
        for number in numbers:
            before[number] = signal.signal(number, by)
        yield before
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
