# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What processes use over time: share of a core and memory, read from /proc (Linux)."""

import os
import resource
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

_UTIME, _STIME = 14 - 3, 15 - 3
"""Index of the two times behind the process name in /proc/PID/stat, by man 5 proc."""
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


@dataclass(frozen=True)
class Use:
    """What a process has used from one sample to another."""

    core_share: float
    """Mean share of a core."""
    memory_mb: float
    """Memory in RAM at the end, MB."""
    growth_mb: float
    """Difference of the memory from that at the beginning, MB."""


def sample_of(pid: int) -> Sample | None:
    """Return a sample of a process; None when it has ended."""
    folder = Path(f'/proc/{pid}')
    try:
        fields = (folder / 'stat').read_text(encoding='ascii', errors='replace')
        pages = int((folder / 'statm').read_text(encoding='ascii').split()[1])
    except (OSError, IndexError):
        return None
    times = fields.rpartition(')')[2].split()
    processor_s = (int(times[_UTIME]) + int(times[_STIME])) / _TICKS_PER_S
    return Sample(time.monotonic(), processor_s, pages * resource.getpagesize() / _MB)


def use_between(first: Sample, last: Sample) -> Use:
    """Return what a process has used from one sample to a later one."""
    share = (last.processor_s - first.processor_s) / (last.at_s - first.at_s)
    return Use(share, last.memory_mb, last.memory_mb - first.memory_mb)


def children_by_module(modules: Mapping[str, str], session: int) -> dict[str, int]:
    """
    Return the process ids of the descendants of a process, by the name of their module.

    `modules` has the name that stands for each module behind `-m`.
    """
    found = {}
    for pid in _descendants(session):
        with suppress(OSError):
            words = Path(f'/proc/{pid}/cmdline').read_text(errors='replace').split('\0')
            if '-m' in words and (name := modules.get(words[words.index('-m') + 1])):
                found[name] = pid
    return found


def _descendants(ancestor: int) -> list[int]:
    children: dict[int, list[int]] = {}
    for folder in Path('/proc').iterdir():
        if folder.name.isdecimal():
            with suppress(OSError):
                text = (folder / 'stat').read_text(encoding='ascii', errors='replace')
                children.setdefault(int(text.rpartition(')')[2].split()[1]), []).append(
                    int(folder.name)
                )
    found, left = [], [ancestor]
    while left:
        more = children.get(left.pop(), [])
        found += more
        left += more
    return found


@dataclass(frozen=True)
class MachineUse:
    """Processor times of this machine since its start, all cores together."""

    at_s: float
    """Steady clock, s."""
    busy_s: float
    """Time for which its programs and its kernel have computed, s."""
    ours_s: float
    """Processor time of this process and its children that have ended, s."""
    stolen_s: float
    """Time for which other virtual machines had its cores, s."""

    def since(self, before: 'MachineUse') -> tuple[float, float]:
        """Return the mean number of cores that others used, and that the host took."""
        took_s = self.at_s - before.at_s
        others_s = (self.busy_s - before.busy_s) - (self.ours_s - before.ours_s)
        return max(others_s, 0.0) / took_s, (self.stolen_s - before.stolen_s) / took_s


def machine_use() -> MachineUse:
    """Return the processor times of now."""
    fields = Path('/proc/stat').read_text(encoding='ascii').splitlines()[0].split()[1:9]
    user, nice, system, _, _, irq, soft_irq, stolen = (int(each) / _TICKS_PER_S for each in fields)
    ours = (resource.getrusage(each) for each in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return MachineUse(
        time.monotonic(),
        user + nice + system + irq + soft_irq,
        sum(each.ru_utime + each.ru_stime for each in ours),
        stolen,
    )
