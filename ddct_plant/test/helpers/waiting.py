# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Wait for something with a deadline."""

import time
from collections.abc import Callable

WITHIN_S = 90.0
"""
Bound of a wait, s: it ends a test that hangs, and is no claim about the speed of anything.

It is below `faulthandler_timeout` of pyproject.toml, so that the test says what it waits for.
"""


def wait_until(condition: Callable[[], object], what: str, within_s: float = WITHIN_S) -> None:
    """Wait until `condition()` holds; fail with `what` when it does not in time."""
    deadline = time.monotonic() + within_s
    while not condition():
        assert time.monotonic() < deadline, f'{what}: not within {within_s:g} s'
        time.sleep(0.005)
