# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A node under a supervisor: it ends itself when it hangs, and announces its exit code."""

import ctypes
import faulthandler
import signal
import threading
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass

_SET_CHILD_SUBREAPER = 36


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


def adopt_orphans(*, adopt: bool) -> None:
    """Become the parent of each descendant whose own parent ends from now on, or not (Linux)."""
    ctypes.CDLL(None).prctl(_SET_CHILD_SUBREAPER, int(adopt))
