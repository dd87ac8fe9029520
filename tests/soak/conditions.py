# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The conditions under which a soak measures, and one measurement under one of them."""

import platform
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, nullcontext
from dataclasses import asdict, dataclass
from typing import Any

from bench.skeleton.history import load_now
from bench.skeleton.interruption import uninterrupted
from soak.process_use import Sample, machine_use, sample_of, use_between
from soak.sides import Graph, SoakError, chain, graph

WARM_UP_S = 15.0
"""Time in s from the start to the first sample of what the nodes use."""
SAMPLE_S = 5.0
"""Period of the samples in s; reading one takes well below 1 ms."""


@dataclass(frozen=True)
class Condition:
    """What is different from an idle machine, and the options that the graph gets."""

    what: str
    """Description for tables."""
    busy: bool = False
    """Whether another program keeps one core busy all the time."""
    options: Sequence[str] = ()
    """Further options of `bringup`."""


CONDITIONS: Mapping[str, Condition] = {
    'idle': Condition('nothing else'),
    'busy': Condition('one core busy', busy=True),
    'preferred': Condition(
        'one core busy, the graph preferred',
        busy=True,
        options=('--realtime-priority', '20', '--lock-memory'),
    ),
}


def measure(name: str, steps: int) -> dict[str, Any]:
    """Run graph and chain at once under a condition; return the record of what was measured."""
    condition = CONDITIONS[name]
    load, before = load_now(), machine_use()
    with (
        _busy_core() if condition.busy else nullcontext(),
        graph(steps, condition.options) as ours,
        chain(steps) as bare,
    ):
        nodes = _watch(ours)
        sides = {'graph': _kept(ours.result()), 'chain': _kept(bare.result())}
    for side in sides.values():
        if side['steps'] != steps:
            raise SoakError(f'{side["steps"]} of {steps} steps were taken')
    others, stolen = machine_use().since(before)
    return {
        'condition': name,
        'what': condition.what,
        'load_before': round(load, 1),
        'other_cores': round(others, 3),
        'stolen_cores': round(stolen, 4),
        'sides': sides,
        'nodes': nodes,
    }


def kernel() -> str:
    """Return release of the kernel and how it may be preempted."""
    words = platform.version().split()
    kinds = [word for word in words if word.startswith('PREEMPT')]
    return ' '.join([platform.release(), *kinds])


@contextmanager
def _busy_core() -> Iterator[None]:
    with uninterrupted():
        program = 'import os\nparent = os.getppid()\nwhile os.getppid() == parent: pass'
        process = subprocess.Popen([sys.executable, '-c', program])
    try:
        yield
    finally:
        process.kill()
        process.wait()


def _watch(ours: Graph) -> dict[str, dict[str, float]]:
    """Return what each process of the graph uses between the warm-up and its end, by name."""
    first: dict[str, Sample] = {}
    last: dict[str, Sample] = {}
    pids: dict[str, int] = {}
    warm_at = time.monotonic() + WARM_UP_S
    while ours.process.poll() is None:
        time.sleep(SAMPLE_S)
        if time.monotonic() < warm_at:
            continue
        pids = pids or ours.pids()
        found = {name: sample for name, pid in pids.items() if (sample := sample_of(pid))}
        if 'driveline' not in found:
            break
        first, last = first or found, found
    if first.keys() != last.keys() or not first:
        raise SoakError('the graph ended too early to be watched: give more minutes')
    return {
        name: {key: round(value, 4) for key, value in asdict(use).items()}
        for name in first
        if (use := use_between(first[name], last[name])) and last[name].at_s > first[name].at_s
    }


def _kept(timing: Mapping[str, Any]) -> dict[str, Any]:
    """Return what a record keeps of the timing of a side."""
    states = {'safe_states': sorted(timing['safe_states'])} if 'safe_states' in timing else {}
    return {key: timing[key] for key in ('steps', 'missed_steps', 'durations')} | states
