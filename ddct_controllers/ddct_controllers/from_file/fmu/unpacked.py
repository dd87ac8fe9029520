# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Temporary folders with the unpacked files of FMUs, each locked by the process that uses it.

A process that crashes leaves its folder behind. The process that waited for it, or the next one
that unpacks an FMU, removes it.
"""

import shutil
import tempfile
from contextlib import suppress
from pathlib import Path
from typing import Any

from ddct_plant.program.lock_file import LockFile

_PREFIX = 'ddct_fmu_'
_LOCK = '.lock'
"""Suffix of the name of the lock file beside a folder."""


class UnpackedFmu:
    """A new folder with the files of an FMU; the code in it is loaded apart from other copies."""

    def __init__(self, fmpy: Any, path: Path) -> None:
        """Unpack the FMU in a file."""
        remove_left_folders()
        self.path = Path(tempfile.mkdtemp(prefix=_PREFIX))
        self._lock = LockFile(_lock_of(self.path))
        try:
            fmpy.extract(path, self.path)
        except BaseException:
            self.remove()
            raise

    def remove(self) -> None:
        """Remove the folder."""
        shutil.rmtree(self.path, ignore_errors=True)
        self._lock.release()


def remove_left_folders() -> None:
    """Remove the folders of processes that have ended."""
    place = Path(tempfile.gettempdir())
    for name in {each.name.removesuffix(_LOCK) for each in place.glob(f'{_PREFIX}*')}:
        folder = place / name
        with suppress(OSError), LockFile(_lock_of(folder)):  # in use, or another user's
            shutil.rmtree(folder, ignore_errors=True)


def _lock_of(folder: Path) -> Path:
    return folder.with_name(f'{folder.name}{_LOCK}')
