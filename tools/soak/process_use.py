# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What processes use over time: share of a core and memory, read from /proc (Linux)."""

import os
import resource
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

_PARENT, _UTIME, _STIME = 4 - 3, 14 - 3, 15 - 3
"""Index of parent and times behind the process name in /proc/PID/stat, by man 5 proc."""
_TICKS_PER_S = os.sysconf('SC_CLK_TCK')
_MB = 1e6


@dataclass(frozen=True)
class Sample:
    """Processor time and memory of a process at one instant."""

    at_s: float
    """Steady clock, s."""
    processor_s: float
    """Processor time since its start, s."""
    memory_mb: float
    """Memory that it has in RAM, MB."""


def samples_below(ancestor: int) -> dict[str, Sample]:
    """Return a sample of a process and each descendant, by the name of its node or program."""
    parents, samples = {}, {}
    for folder in Path('/proc').iterdir():
        if not folder.name.isdecimal():
            continue
        with suppress(OSError, IndexError):  # it may end meanwhile
            fields = (folder / 'stat').read_text(errors='replace').rpartition(')')[2].split()
            pid = int(folder.name)
            parents[pid] = int(fields[_PARENT])
            samples[pid] = (_name(folder), _sample(folder, fields))
    found = {}
    for pid, (name, sample) in samples.items():
        above = pid
        while above not in (ancestor, 0):
            above = parents.get(above, 0)
        if above == ancestor:
            found[name] = sample
    return found


def _name(folder: Path) -> str:
    words = (folder / 'cmdline').read_text(errors='replace').split('\0')
    if '-c' in words:  # a fork has the words of its server, and a name of its own
        return (folder / 'comm').read_text(errors='replace').strip().removesuffix('_node')
    return Path(words[1] or words[0]).name


def _sample(folder: Path, fields: list[str]) -> Sample:
    pages = int((folder / 'statm').read_text(encoding='ascii').split()[1])
    processor_s = (int(fields[_UTIME]) + int(fields[_STIME])) / _TICKS_PER_S
    return Sample(time.monotonic(), processor_s, pages * resource.getpagesize() / _MB)
