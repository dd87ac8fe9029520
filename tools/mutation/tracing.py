# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Record which product lines a process runs, for which test; `coverage_run.py` reads the files.

A `.pth` file of the scratch copy's environment imports this in each process, so that nodes,
programs and their forks are part of the record. It does nothing unless `FOLDER` is set.
"""

import atexit
import os
import threading
import uuid
from pathlib import Path
from typing import Any, NoReturn

FOLDER = 'DDCT_COVERAGE_FOLDER'
"""Environment variable: folder of the records, one file a process."""
SOURCE = 'DDCT_COVERAGE_SOURCE'
"""Environment variable: root of the copy whose product code is recorded."""
TEST = 'PYTEST_CURRENT_TEST'
"""Environment variable in which pytest keeps the current test and its phase."""


class Recorder:
    """Coverage of this process from now on; one file, written at the end."""

    def __init__(self) -> None:
        """Start to record."""
        from coverage import Coverage

        self._process = os.getpid()
        self.file = Path(os.environ[FOLDER]) / f'{self._process}-{uuid.uuid4().hex}'
        root = os.environ[SOURCE]
        self.coverage = Coverage(
            data_file=str(self.file),
            include=[f'{root}/ddct_*/ddct_*/*'],
            config_file=False,
            messages=False,
        )
        self.coverage.set_option('run:disable_warnings', ['no-data-collected'])
        self.coverage.start()

    def write(self) -> None:
        """Write the record once, with the test that started this process in a file beside it."""
        global _recorder
        if _recorder is not self or self._process != os.getpid():
            return
        _recorder = None
        test = os.environ.get(TEST, '')
        self.coverage.stop()
        self.coverage.save()
        self.file.with_suffix('.test').write_text(test, encoding='utf-8')


_recorder: Recorder | None = None


def recorder() -> Recorder | None:
    """Return the recorder of this process."""
    return _recorder


def start() -> None:
    """Record this process, its forks too, if a folder for the records is given."""
    global _recorder
    if FOLDER not in os.environ or _recorder is not None:
        return
    _recorder = Recorder()
    atexit.register(_write)
    os.register_at_fork(after_in_child=_anew)
    exit_at_once = os._exit

    def write_and_exit(status: int) -> NoReturn:
        _write()
        exit_at_once(status)

    os._exit = write_and_exit


def _write() -> None:
    if _recorder is not None and threading.current_thread() is threading.main_thread():
        _recorder.write()


def _anew(*_: Any) -> None:
    """Leave the record so far to the parent."""
    global _recorder
    if _recorder is not None:
        _recorder.coverage.stop()
        _recorder = Recorder()
        atexit.register(_write)
