# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Helper processes that a browser starts, and that may end after it."""

import contextlib
import time
from pathlib import Path

from waiting import WITHIN_S

MARK = 'DDCT_BROWSER'
"""Environment variable that marks a browser and every process that it starts."""


def wait_for_helpers(mark: str, within_s: float = WITHIN_S) -> list[int]:
    """
    Wait until every process with this mark has ended; return those that still run, by id.

    The crash handler is in a session of its own. It ends by itself a moment after the browser,
    later on a loaded machine.
    """
    deadline = time.monotonic() + within_s
    while (left := _marked(mark)) and time.monotonic() < deadline:
        time.sleep(0.01)
    return left


def _marked(mark: str) -> list[int]:
    entry = f'{MARK}={mark}'.encode()
    found = []
    for folder in Path('/proc').iterdir():
        if folder.name.isdigit():
            with contextlib.suppress(OSError):  # it may end, or belong to another user
                if entry in (folder / 'environ').read_bytes().split(b'\0'):
                    found.append(int(folder.name))
    return found
