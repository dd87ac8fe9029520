# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The end of small programs in tests."""

from pathlib import Path


def gone(pid: int) -> bool:
    """Return whether a process has ended, waited for or not."""
    try:
        return Path(f'/proc/{pid}/stat').read_text().rpartition(')')[2].split()[0] in 'ZX'
    except OSError:
        return True
