"""The middleware's shared memory of killed nodes (Fast DDS on Linux); needs no ROS."""

import contextlib
import fcntl
import os
import re
from collections.abc import Iterable
from pathlib import Path

SHARED_MEMORY = Path('/dev/shm')
_LOCK = '_el'
_LOCK_FILE = re.compile(f'fastrtps_.+{_LOCK}')
"""A live owner of segment `fastrtps_X` holds a lock on the file `fastrtps_X_el`."""


def segments_of(pid: int) -> set[str]:
    """Return the segments that a running process has locked, empty for one that has ended."""
    segments = set()
    with contextlib.suppress(OSError):  # it ends while we look
        for link in Path(f'/proc/{pid}/fd').iterdir():
            with contextlib.suppress(OSError):  # it closes this one while we look
                file = link.readlink()
                if file.parent == SHARED_MEMORY and _LOCK_FILE.fullmatch(file.name):
                    segments.add(file.name.removesuffix(_LOCK))
    return segments


def remove_segments(segments: Iterable[str]) -> None:
    """Remove those of the segments that no live process owns, perhaps under a name used again."""
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
        except OSError:  # locked by a live owner, or not ours
            continue
        finally:
            os.close(descriptor)
