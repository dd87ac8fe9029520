# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Shared memory that killed nodes leave (Fast DDS on Linux); needs no ROS."""

import contextlib
import fcntl
import time
from pathlib import Path

from ddct_plant.graph.half_made_ports import SHARED_MEMORY

LOCK = '_el'
"""End of the name of a file `fastrtps_X_el`, which a live owner of the segment X locks."""
YOUNG_S = 0.2
"""Age in s below which a segment may have an owner that has not locked it yet."""


def remove_dead_segments() -> None:
    """Remove the segments that no live process owns, as `fastdds shm clean` does."""
    for lock in SHARED_MEMORY.glob(f'fastrtps_*{LOCK}'):
        # Its owner may remove it meanwhile, or have locked it, or be another user.
        with contextlib.suppress(OSError):
            _remove_unless_owned(lock)


def _remove_unless_owned(lock: Path) -> None:
    age_s = time.time() - lock.stat().st_mtime
    if 0.0 <= age_s < YOUNG_S:
        time.sleep(YOUNG_S - age_s)
    with lock.open('rb') as file:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        segment = lock.name.removesuffix(LOCK)
        for name in (segment, f'sem.{segment}_mutex', lock.name):
            lock.with_name(name).unlink(missing_ok=True)
