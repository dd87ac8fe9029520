# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The conditions under which a soak measures, and one measurement under one of them."""

import os
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from typing import Any

from soak.process_use import Sample
from soak.sides import Graph, SoakError, chain, graph

WARM_UP_S = 15.0
"""Time in s from the start to the first sample of what the nodes use."""
SAMPLE_S = 5.0
"""Period of the samples in s; reading one takes well below 1 ms."""


@dataclass(frozen=True)
class Condition:
    """What is different from an idle machine, and how the graph is started."""

    what: str
    """Description for tables."""
    busy: bool = False
    """Whether another program keeps one core busy all the time."""
    prefix: Sequence[str] = ()
    """Command that runs `bringup`."""


CONDITIONS: Mapping[str, Condition] = {
    'idle': Condition('nothing else'),
    'busy': Condition('one core busy', busy=True),
    'preferred': Condition(
        'one core busy, the graph preferred',
        busy=True,
        prefix=('chrt', '--fifo', '20'),
    ),
}


def measure(name: str, steps: int) -> dict[str, Any]:
    """Run graph and chain at once under a condition; return what was measured, as JSON."""
    condition, load = CONDITIONS[name], os.getloadavg()[0]
    with (
        busy_cores(1) if condition.busy else nullcontext(),
        graph(steps, condition.prefix) as ours,
        chain(steps) as bare,
    ):
        processes = _watch(ours)
        sides = {'graph': ours.result(), 'chain': bare.result()}
    for side in sides.values():
        if side['steps'] != steps:
            raise SoakError(f'{side["steps"]} of {steps} steps were taken')
    return {
        'condition': condition.what,
        'load_in_the_minute_before': load,
        'sides': sides,
        'processes': processes,
    }


@contextmanager
def busy_cores(count: int) -> Iterator[None]:
    """Keep some cores busy with a process for each."""
    program = 'import os\nparent = os.getppid()\nwhile os.getppid() == parent: pass'
    processes = [subprocess.Popen([sys.executable, '-c', program]) for _ in range(count)]
    try:
        yield
    finally:
        for process in processes:
            process.kill()
            process.wait()


def _watch(ours: Graph) -> dict[str, dict[str, float]]:
    """Return what each process of the graph uses between the warm-up and its end, by name."""
    first: dict[str, Sample] = {}
    last: dict[str, Sample] = {}
    warm_at = time.monotonic() + WARM_UP_S
    while ours.process.poll() is None:
        time.sleep(SAMPLE_S)
        if time.monotonic() < warm_at:
            continue
        found = ours.samples()
        if 'driveline' not in found:
            break
        first, last = first or found, found
    return {
        name: {
            'core_share': (last[name].processor_s - start.processor_s)
            / (last[name].at_s - start.at_s),
            'memory_mb': last[name].memory_mb,
            'growth_mb': last[name].memory_mb - start.memory_mb,
        }
        for name, start in first.items()
        if name in last and last[name].at_s > start.at_s
    }
