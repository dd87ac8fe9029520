# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Time of a run through the graph beside its ticks: until the first tick, and in total.

`python start_up_round.py` in the environment of a workspace of any version prints one round as
JSON. A round does what `ddct` does: it starts a warm parent, where the version has one, imports
the program, plans, and carries out three runs. The first is what `bringup` does; the processor
time of the warm parent is part of it. The further ones are those of `compare`.
"""

import inspect
import json
import resource
import statistics
import tempfile
import threading
import time
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from pathlib import Path
from typing import Any

RUNS = 3
QUANTITIES = {
    'first_tick_s': 'to its first tick',
    'overhead_s': 'beside its ticks',
    'processor_s': 'processor time',
}
"""
Keys of the times of a run, in s, and their names in the output.

The time from the call to the first tick, the wall time less that of the ticks, and the processor
time of all processes.
"""
POLL_S = 0.002
TIMING_FILE = 'timing.json'


def main() -> None:
    """Print the times in s by quantity: of the first run, and the mean of the further ones."""
    first, *further = _runs()
    times = {f'one run, {name}': first[key] for key, name in QUANTITIES.items()}
    for key, name in QUANTITIES.items():
        times[f'a further run, {name}'] = statistics.mean(run[key] for run in further)
    print(json.dumps(times))


def _runs() -> list[dict[str, float]]:
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


if __name__ == '__main__':
    main()
