# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Owners of shared memory, found by another way than that of the programs."""

import fcntl

from ddct_bringup.processes.shared_memory import SHARED_MEMORY


def has_owner(segment: str) -> bool:
    """Return whether a live process owns a segment of shared memory: it holds its lock."""
    try:
        with (SHARED_MEMORY / f'{segment}_el').open() as lock:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except FileNotFoundError:
        return False
    return False
