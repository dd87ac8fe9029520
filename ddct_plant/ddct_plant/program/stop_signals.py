"""What SIGINT and SIGTERM do for a while, and what ends a process whose parent is gone."""

import ctypes
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

_CAUGHT = (signal.SIGINT, signal.SIGTERM)
_SET_PARENT_DEATH_SIGNAL = 1


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
def _handled(by: Callable[[int, Any], Any] | signal.Handlers) -> Iterator[None]:
    before = {number: signal.signal(number, by) for number in _CAUGHT}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
