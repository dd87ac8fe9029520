# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Waiting for small programs in tests."""

import time
from collections.abc import Callable
from pathlib import Path

WITHIN_S = 20.0
"""Timeout for the start or end of a small program on a loaded machine, s."""


def wait_until(condition: Callable[[], object]) -> None:
    """Wait for a condition, and fail when it takes too long."""
    deadline = time.monotonic() + WITHIN_S
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.01)


def gone(pid: int) -> bool:
    """Return whether a process has ended, waited for or not."""
    try:
        return Path(f'/proc/{pid}/stat').read_text().rpartition(')')[2].split()[0] in 'ZX'
    except OSError:
        return True
