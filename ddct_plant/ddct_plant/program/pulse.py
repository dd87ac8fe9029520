"""What a node tells its supervisor, if it has one: that it runs, and how it has ended."""

import contextlib
import os

PULSE_FD = 'DDCT_PULSE_FD'
"""Environment variable with the file descriptor, not blocking, that a supervisor has opened."""
FAREWELL = b'!'
"""Comes before the exit code of a node whose work is over."""


def beat() -> None:
    """Show that the node runs; called again and again."""
    _tell(b'.')


def farewell(code: int) -> None:
    """Say that the node's work is over with this exit code: it only has to leave the graph."""
    _tell(FAREWELL + str(code).encode())


def _tell(what: bytes) -> None:
    descriptor = os.environ.get(PULSE_FD, '')
    if descriptor.isdecimal():
        # Full or closed: the supervisor does not look at it now, or is gone.
        with contextlib.suppress(OSError):
            os.write(int(descriptor), what)
