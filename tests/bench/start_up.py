# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Time of a run through the graph beside its ticks: until the first tick, and in total.

`python start_up.py [--base FOLDER]` measures this workspace, and in turn with it another one,
built and of any version: rounds alternate, so that a busy machine slows both. A round is a process
of its own that does what `ddct` does: it starts a warm parent, where the version has one, imports
the program, plans, and carries out three runs. The first is what `bringup` does; the processor
time of the warm parent is part of it. The further ones are those of `compare`.
"""

import argparse
import inspect
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from pathlib import Path
from typing import Any

RUNS = 3
GOAL = 1.0 / 3.0
"""Goal of the ratio to the time of the base, at most."""
QUANTITIES = ('first_tick_s', 'overhead_s', 'processor_s')
"""
Keys of the results, in s.

The time from the call to the first tick, the wall time less that of the ticks, and the processor
time of all processes.
"""
POLL_S = 0.002
TIMING_FILE = 'timing.json'
ROOT = Path(__file__).resolve().parents[2]
Round = list[dict[str, float]]


def measure(base: Path | None = None, rounds: int = 5) -> dict[str, list[Round]]:
    """Return the measured rounds of this workspace, and of the one in the folder `base`."""
    folders = {'ours': ROOT} | ({'base': base} if base else {})
    found: dict[str, list[Round]] = {name: [] for name in folders}
    for _ in range(rounds):
        for name, folder in folders.items():
            found[name].append(_round(folder))
    return found


def print_table(found: dict[str, list[Round]]) -> None:
    """Print medians, and the ratios of the rounds where there is a base."""
    for kind, runs in (('one run', slice(0, 1)), ('each further run', slice(1, None))):
        for quantity in QUANTITIES:
            ours, base = (
                _values(found.get(name, []), quantity, runs) for name in ('ours', 'base')
            )
            line = f'{kind}, {quantity}: {statistics.median(ours):.2f}'
            if base:
                ratios = sorted(one / other for one, other in zip(ours, base, strict=True))
                line += (
                    f', base {statistics.median(base):.2f}, '
                    f'ratio {statistics.median(ours) / statistics.median(base):.2f} '
                    f'(rounds {ratios[0]:.2f} to {ratios[-1]:.2f}; at most {GOAL:.2f} wanted)'
                )
            print(line, flush=True)


def _values(rounds: list[Round], figure: str, runs: slice) -> list[float]:
    return [statistics.mean(run[figure] for run in each[runs]) for each in rounds]


def _round(workspace: Path) -> Round:
    """Measure one round with the Python and the set-up script of a workspace."""
    command = f'. install/setup.sh; exec .venv/bin/python -P {Path(__file__)} --round'
    inherited = {key: os.environ[key] for key in ('HOME', 'PATH') if key in os.environ}
    done = subprocess.run(
        ['sh', '-c', command],
        cwd=workspace,
        env={**inherited, 'OPENBLAS_NUM_THREADS': '1'},
        stdout=subprocess.PIPE,
        check=True,
    )
    return json.loads(done.stdout)


def _runs() -> Round:
    before = _processor_s()
    found = []
    with _started_ahead():
        from ddct_bringup.run import execution
        from ddct_bringup.run.plan import RunPlan
        from ddct_plant.scenario.file import load_scenario
        from ddct_plant.scenario.settings import RunSettings

        plan = RunPlan(RunSettings(load_scenario('thesis', ['duration_s=3.0'])), 'pi')
        # A version without warm parents takes none.
        shared = 'parent' in inspect.signature(execution.execute).parameters
        planned = _processor_s() - before
        with execution.parent_for(plan.layout) if shared else nullcontext() as parent:
            options: dict[str, Any] = {'parent': parent} if shared else {}
            execute = partial(execution.execute, plan, **options)
            found += [_run(execute, plan.name) for _ in range(RUNS)]
    further = sum(run['processor_s'] for run in found[1:])
    found[0]['processor_s'] = _processor_s() - before - planned - further
    return found


def _started_ahead() -> AbstractContextManager[None]:
    try:
        from ddct_bringup.processes.warm_parent import started_ahead
    except ImportError:  # an older version
        return nullcontext()
    return started_ahead()


def _run(execute: Callable[[Path], None], name: str) -> dict[str, float]:
    """Carry out one run in a new folder and return its results in s, by `QUANTITIES`."""
    before, begun = _processor_s(), time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        first_tick = FirstTick(Path(folder) / f'{name}_0.mcap')
        first_tick.start()
        execute(Path(folder))
        ended, used = time.monotonic(), _processor_s() - before
        first_tick.join()
        timing = json.loads((Path(folder) / TIMING_FILE).read_text(encoding='utf-8'))
    return {
        'first_tick_s': first_tick.at - begun,
        'overhead_s': ended - begun - timing['wall_time_s'],
        'processor_s': used,
    }


class FirstTick(threading.Thread):
    """Thread that waits for the bag, which the recorder opens at the first tick."""

    def __init__(self, bag: Path) -> None:
        super().__init__(daemon=True)
        self._bag = bag
        self.at = 0.0

    def run(self) -> None:
        """Store the time at which the bag exists."""
        while not self._bag.exists():
            time.sleep(POLL_S)
        self.at = time.monotonic()


def _processor_s() -> float:
    """Return the processor time of this process and of its children that have ended, in s."""
    uses = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(use.ru_utime + use.ru_stime for use in uses)


def main() -> int:
    """Measure, print, and write the JSON where it is requested."""
    parser = argparse.ArgumentParser(description='Measure what a run costs beside its ticks.')
    parser.add_argument('--base', type=Path, metavar='FOLDER', help='a built workspace')
    parser.add_argument('--rounds', type=int, default=5)
    parser.add_argument('--json', metavar='FILE')
    parser.add_argument('--round', action='store_true', help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.round:
        json.dump(_runs(), sys.stdout)
        return 0
    found = measure(options.base, options.rounds)
    print_table(found)
    if options.json:
        Path(options.json).write_text(json.dumps(found), encoding='utf-8')
    return 0


if __name__ == '__main__':
    raise SystemExit(main())
