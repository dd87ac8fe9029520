# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""One warm parent for all tests of this process, as importing takes a run longest."""

import os
from pathlib import Path

from ddct_bringup.processes.warm_parent import WarmParent

TEST_ID = 'DDCT_TEST_ID'
"""Environment variable that marks every process which a test starts, directly or not."""
_shared: list[WarmParent] = []
"""The warm parent; none before the first run."""


def _place() -> tuple[Path, str | None]:
    """Return what forks have from their parent alone: current folder and Python path."""
    return Path.cwd(), os.environ.get('PYTHONPATH')


_PLACE = _place()


def shared_parent() -> WarmParent | None:
    """Return the warm parent; None where the test has changed the folder or the Python path."""
    if _place() != _PLACE:
        return None
    if not _shared:
        # It belongs to no test; its forks are found as children of this process.
        mark = os.environ.pop(TEST_ID, None)
        try:
            _shared.append(WarmParent())
        finally:
            if mark is not None:
                os.environ[TEST_ID] = mark
    return _shared[0]


def is_shared(pid: int) -> bool:
    """Return whether a process is the warm parent of all tests."""
    return any(parent.process.pid == pid for parent in _shared)
