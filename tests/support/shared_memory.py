# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Segments of shared memory and their owners, found by another way than that of the programs."""

import contextlib
import fcntl
from pathlib import Path

from ddct_bringup.processes.shared_memory import LOCK
from ddct_plant.graph.half_made_ports import SHARED_MEMORY


def segments_of(pid: int) -> set[str]:
    """Return the segments that a running process has open, none for one that has ended."""
    segments = set()
    with contextlib.suppress(OSError):  # the process may end during the scan
        for link in Path(f'/proc/{pid}/fd').iterdir():
            with contextlib.suppress(OSError):  # the process may close this file during the scan
                file = link.readlink()
                if file.parent == SHARED_MEMORY and file.name.endswith(LOCK):
                    segments.add(file.name.removesuffix(LOCK))
    return segments


def has_owner(segment: str) -> bool:
    """Return whether a live process owns a segment of shared memory: it holds its lock."""
    try:
        with (SHARED_MEMORY / f'{segment}{LOCK}').open() as lock:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except FileNotFoundError:
        return False
    return False
