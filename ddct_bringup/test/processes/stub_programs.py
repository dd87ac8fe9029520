"""What the tests of small programs share."""

import time
from collections.abc import Callable
from pathlib import Path

WITHIN_S = 20.0
"""How long a small program may take to start or to end on a loaded machine."""


def wait_until(condition: Callable[[], object]) -> None:
    """Wait for a condition, and fail when it takes too long."""
    deadline = time.monotonic() + WITHIN_S
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.01)


def gone(pid: int) -> bool:
    """Say whether a process has ended, waited for or not."""
    try:
        return Path(f'/proc/{pid}/stat').read_text().rpartition(')')[2].split()[0] in 'ZX'
    except OSError:
        return True
