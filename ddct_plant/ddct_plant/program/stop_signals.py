"""Catch SIGINT and SIGTERM for a while, so that work ends in an orderly way."""

import signal
from collections.abc import Iterator
from contextlib import contextmanager

_CAUGHT = (signal.SIGINT, signal.SIGTERM)


@contextmanager
def stop_signals() -> Iterator[list[int]]:
    """Give the list that the signals are put into; what they did before comes back at the end."""
    received: list[int] = []
    before = {
        number: signal.signal(number, lambda caught, _frame: received.append(caught))
        for number in _CAUGHT
    }
    try:
        yield received
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
