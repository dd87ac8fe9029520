# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Segments of shared memory and their owners, found by another way than that of the programs."""

import fcntl

from ddct_bringup.processes.shared_memory import SHARED_MEMORY

_LOCK = '_el'


def segments_there() -> set[str]:
    """Return the segments that have an owner, or whose owner was killed."""
    return {file.name.removesuffix(_LOCK) for file in SHARED_MEMORY.glob(f'fastrtps_*{_LOCK}')}


def has_owner(segment: str) -> bool:
    """Return whether a live process owns a segment of shared memory: it holds its lock."""
    try:
        with (SHARED_MEMORY / f'{segment}{_LOCK}').open() as lock:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except FileNotFoundError:
        return False
    return False
