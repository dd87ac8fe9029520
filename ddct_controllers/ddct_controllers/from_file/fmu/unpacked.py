# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Temporary folders with the unpacked files of FMUs, each locked by the process that uses it.

A process that crashes leaves its folder behind: whoever unpacks an FMU next, or has waited for
the process, removes it.
"""

import fcntl
import os
import shutil
import tempfile
from contextlib import suppress
from pathlib import Path
from typing import Any

_PREFIX = 'ddct_fmu_'


class UnpackedFmu:
    """A new folder with the files of an FMU; the code in it is loaded apart from other copies."""

    def __init__(self, fmpy: Any, path: Path) -> None:
        """Unpack the FMU in a file."""
        remove_left_folders()
        self.path = Path(tempfile.mkdtemp(prefix=_PREFIX))
        self._lock = os.open(self.path, os.O_RDONLY)
        fcntl.flock(self._lock, fcntl.LOCK_SH)
        try:
            fmpy.extract(path, self.path)
        except BaseException:
            self.remove()
            raise

    def remove(self) -> None:
        """Remove the folder."""
        shutil.rmtree(self.path, ignore_errors=True)
        os.close(self._lock)


def remove_left_folders() -> None:
    """Remove the folders of processes that have ended."""
    for folder in Path(tempfile.gettempdir()).glob(f'{_PREFIX}*'):
        with suppress(OSError):  # in use, or another user's
            lock = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                shutil.rmtree(folder, ignore_errors=True)
            finally:
                os.close(lock)
