# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
End of a process: by a signal, with its parent, or by itself when it hangs.

Handlers of SIGINT and SIGTERM, signals at the end of the parent process, the watch over a running
node, and its announced exit code.
"""

import atexit
import ctypes
import faulthandler
import operator
import os
import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from types import FrameType
from typing import Any

_CAUGHT = (signal.SIGINT, signal.SIGTERM)
_SET_PARENT_DEATH_SIGNAL = 1
_SET_CHILD_SUBREAPER = 36


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
    """Return the first signal since the outermost `interruptible` began, 0 for none."""
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
        if _depth:
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


def adopt_orphans(*, adopt: bool) -> None:
    """Become the parent of each descendant whose own parent ends from now on, or not (Linux)."""
    ctypes.CDLL(None).prctl(_SET_CHILD_SUBREAPER, int(adopt))


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


@dataclass(frozen=True)
class Patience:
    """
    Wall times in s after which a supervised node ends itself.

    The first two are less than the driveline waits for an answer, so that the node is named.
    """

    start_s: float = 18.0
    """Without a beat since its start."""
    silent_s: float = 18.0
    """Since its last beat."""
    leave_s: float = 2.0
    """While it leaves the graph, where Fast DDS may hang."""


_supervised: tuple[Patience, Callable[[int], None]] | None = None
"""Patience with this process, a supervised node, and a function that announces its exit code."""


def supervise(patience: Patience, announce: Callable[[int], None]) -> None:
    """
    Let this process, a node, end itself when it hangs, with its stacks on standard error.

    `announce(code)` passes on the exit code of a node whose work is over. A thread of C looks
    after the time, so that a node is watched which keeps the interpreter's lock.
    """
    global _supervised
    _supervised = patience, announce
    faulthandler.dump_traceback_later(patience.start_s, exit=True)


def is_supervised() -> bool:
    """Return whether a supervisor has started this process, a node."""
    return _supervised is not None


def beat() -> None:
    """Tell the watch that the node runs; called periodically."""
    if _supervised:
        faulthandler.dump_traceback_later(_supervised[0].silent_s, exit=True)


def announce_exit(code: int) -> None:
    """Announce the exit code of the node, which only has to leave the graph, in a limited time."""
    if _supervised:
        patience, announce = _supervised
        with suppress(OSError):  # the supervisor has ended
            announce(code)
        faulthandler.cancel_dump_traceback_later()
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
        end_after(patience.leave_s, ask=False)


def end_after(timeout_s: float, *, ask: bool = True) -> None:
    """Let the kernel end this process after a time in s; `ask` it by SIGTERM at once."""
    # Its action is the default one unless foreign code has set another.
    signal.setitimer(signal.ITIMER_REAL, timeout_s)
    main = threading.main_thread().ident
    if ask and main is not None:
        # Not to the process: while its main thread is resumed another one would receive it, and
        # a system call of the main thread went on.
        signal.pthread_kill(main, signal.SIGTERM)
