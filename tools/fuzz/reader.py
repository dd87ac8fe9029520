# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
A reader of one kind of file, and what counts as a finding.

It returns, or raises DdctError in one line. Any other exception is a finding, and so are printed
text, and numbers of a damaged bag that differ from those of the good ones.
"""

import io
import shutil
import tempfile
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from ddct_plant.base.errors import DdctError

LONGEST_LINE = 5000
Read = Callable[[Path], object]
"""Function that reads a file, and returns what must not change where it accepts other bytes."""


@dataclass(frozen=True)
class Reader:
    """A reader of one kind of file."""

    name: str
    """Name of the reader, and of the folder of inputs found for it."""
    file: str
    """Name of the file that it reads."""
    read: Read
    seeds: tuple[bytes, ...]
    """Good inputs."""
    exact: bool = False
    """Whether an input must give what one of the good ones gives."""

    def finding(self, data: bytes, folder: Path) -> str:
        """Return what is wrong with the reader's treatment of an input, '' for nothing."""
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        file = folder / self.file
        file.write_bytes(data)
        printed = io.StringIO()
        with redirect_stdout(printed), redirect_stderr(printed):
            what = self._finding(file)
        return what or (f'prints {printed.getvalue()!r}' if printed.getvalue() else '')

    def _finding(self, file: Path) -> str:
        try:
            found = self.read(file)
        except DdctError as error:
            text = str(error)
            return '' if text.isprintable() and len(text) < LONGEST_LINE else f'text {text!r}'
        except (Exception, SystemExit) as error:  # any other exception is the finding
            return f'{type(error).__name__}: {error}'
        if self.exact and found not in self.expected:
            return 'other numbers than those of the good inputs'
        return ''

    @cached_property
    def expected(self) -> list[object]:
        """What the good inputs give."""
        found = []
        for data in self.seeds:
            with tempfile.TemporaryDirectory(prefix='good-') as folder:
                file = Path(folder) / self.file
                file.write_bytes(data)
                found.append(self.read(file))
        return found
