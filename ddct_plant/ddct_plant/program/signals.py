# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
What SIGINT and SIGTERM do in each process.

| process | SIGINT, as of Ctrl-C | SIGTERM |
|---|---|---|
| a program in its work, `interruptible` | KeyboardInterrupt | KeyboardInterrupt |
| a program that reports an interruption | noted | noted |
| a program that has reported it and ends | ends it at once | ends it |
| a run, a campaign, a node, `stop_signals` | noted: it ends in order | noted |
| what must be whole, `deferred_signals` | taken at its end | taken at its end |
| a node that leaves the graph, `ends_at_once` | ends it | ends it |
| the fork server, `block_interrupts` | ignored | ends it |
| a worker, a process for foreign code, `obey_parent` | ignored | ends it |

The middleware gets no handlers: `init_ros` forbids them.
"""

import atexit
import operator
import os
import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

from ddct_plant.program.operating_system import end_with

_CAUGHT = (signal.SIGINT, signal.SIGTERM)
_received: list[int] = []
"""Signals that were received since the outermost `interruptible` began."""
_noting: list[list[int]] = []
"""Lists of `stop_signals`, the innermost last."""
_depth = 0
"""Number of `interruptible` within one another."""
_reported = False
"""Whether an interruption was reported since the outermost of them began."""
_ending = False
"""Whether this process, a program that has reported one, does nothing but end."""


def _handle(caught: int, frame: FrameType | None) -> None:
    """Handle either signal: the one handler of Python code."""
    if _depth or _ending:
        _received.append(caught)
    if _noting:
        _noting[-1].append(caught)
    elif _ending:
        os._exit(128 + interrupted_by())
    else:
        calls = 0
        while frame is not None:
            calls += frame.f_code is _called.__code__
            frame = frame.f_back
        if calls == _depth:  # else the innermost program has not begun its work or has ended it
            raise KeyboardInterrupt


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
    global _depth, _reported, _ending
    if threading.current_thread() is not threading.main_thread():
        yield operator.call
        return
    if not _depth:
        _received.clear()
        _reported = _ending = False
    kept = [number for number in _CAUGHT if signal.getsignal(number) != signal.SIG_IGN]
    _depth += 1
    try:
        with _handled(_handle, kept) as before:
            yield _called
            if ends_process and _depth == 1 and _reported and signal.SIGINT in before:
                _ending = True
                before[signal.SIGINT] = _handle
                # Python gives SIGINT its default action back while it frees its modules.
                atexit.register(signal.signal, signal.SIGINT, signal.SIG_IGN)
    finally:
        _depth -= 1


def _called(work: Callable[[], Any]) -> Any:
    """Return the result of `work`; a signal is raised while this is on the stack."""
    if _received:
        raise KeyboardInterrupt
    return work()


def interrupted_by() -> int:
    """Return the first signal since the outermost `interruptible` began, 0 for none."""
    return next(iter(_received), 0)


def stems_from_interrupt(error: BaseException | None) -> bool:
    """
    Return whether an exception is a KeyboardInterrupt, or began as one.

    Python wraps what is raised in `__set_name__`, and some modules report any failure while they
    are imported as an ImportError.
    """
    passed: set[int] = set()  # an exception may be raised from itself
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


@contextmanager
def stop_signals() -> Iterator[list[int]]:
    """Yield the list of received signals; the handlers from before are restored at the end."""
    received: list[int] = []
    with _handled(_handle):
        _noting.append(received)
        try:
            yield received
        finally:
            _noting.pop()


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


@contextmanager
def held_back() -> Iterator[None]:
    """Let SIGINT wait, here and in processes that are started within, which inherit that."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def block_interrupts() -> None:
    """Block SIGINT in this process, the fork server; one to a fork waits for `obey_interrupts`."""
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    # The library gives this handler back to a fork; SIG_IGN would discard what waits there.
    signal.signal(signal.SIGINT, signal.default_int_handler)


def obey_interrupts() -> None:
    """Take SIGINT as a new Python process does, in a fork, also one that came since the fork."""
    signal.signal(signal.SIGINT, signal.default_int_handler)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})


def obey_parent(parent: int) -> None:
    """Leave the signals of a terminal to the process `parent`, by its id, and end with it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    end_with(parent)


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
