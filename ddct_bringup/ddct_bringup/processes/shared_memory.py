# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Shared memory that killed nodes leave (Fast DDS on Linux); needs no ROS."""

import contextlib
import fcntl
import os
import re
from collections.abc import Iterable
from pathlib import Path

SHARED_MEMORY = Path('/dev/shm')
_LOCK = '_el'
_LOCK_FILE = re.compile(f'fastrtps_.+{_LOCK}')
"""Pattern of the file `fastrtps_X_el`, which a live owner of segment `fastrtps_X` locks."""


def segments_of(pid: int) -> set[str]:
    """Return the segments that a running process has locked, none for one that has ended."""
    segments = set()
    with contextlib.suppress(OSError):  # the process may end during the scan
        for link in Path(f'/proc/{pid}/fd').iterdir():
            with contextlib.suppress(OSError):  # the process may close this file during the scan
                file = link.readlink()
                if file.parent == SHARED_MEMORY and _LOCK_FILE.fullmatch(file.name):
                    segments.add(file.name.removesuffix(_LOCK))
    return segments


def remove_segments(segments: Iterable[str]) -> None:
    """Remove the given segments that no live process owns; a new process may use a name again."""
    for segment in segments:
        lock = SHARED_MEMORY / f'{segment}{_LOCK}'
        try:
            descriptor = os.open(lock, os.O_RDONLY | os.O_CLOEXEC)
        except OSError:  # its owner has removed it
            continue
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            for file in (segment, f'sem.{segment}_mutex', lock.name):
                (SHARED_MEMORY / file).unlink(missing_ok=True)
        except OSError:  # locked by a live owner, or of another user
            continue
        finally:
            os.close(descriptor)
