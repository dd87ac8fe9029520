# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Small programs in tests, their start and their end."""

from collections.abc import Callable
from pathlib import Path

from ddct_bringup.processes.forked import Forked

Start = Callable[..., Forked]
SMALL_SERVER = """
from ddct_bringup.processes import fork_server
fork_server._PRELOADED = 'small_preload'
"""
"""Code after which the fork server of a program imports no nodes; see the fixture."""


def gone(pid: int) -> bool:
    """Return whether a process has ended, waited for or not."""
    try:
        return Path(f'/proc/{pid}/stat').read_text().rpartition(')')[2].split()[0] in 'ZX'
    except OSError:
        return True
