# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Lock-step runs of the graph on busy cores, each with the headless hash."""

import argparse
import os
import tempfile
from collections import Counter
from itertools import cycle
from pathlib import Path

from support.runs import expected, plan, record

from ddct_bringup.run.plan import RunPlan
from ddct_plant.base.errors import DdctError
from ddct_plant.graph.domain import own_domain
from soak.conditions import busy_cores

SAME = 'the headless hash'
PLANS = {
    'one clutch': plan('ls8', duration_s=0.7),
    'two clutches': plan(
        'pi',
        scenario='upshift',
        duration_s=0.7,
        changes=('score_window_s=[0.3, 0.7]',),
    ),
}


def main() -> int:
    """Run the program and return its exit code."""
    parser = argparse.ArgumentParser(prog='tools/run loaded_runs', description=__doc__)
    parser.add_argument('--runs', type=int, default=1000)
    options = parser.parse_args()
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
    hashes = {name: expected(run).sha256() for name, run in PLANS.items()}
    outcomes: Counter[str] = Counter()
    with busy_cores(os.cpu_count() or 1), own_domain(), tempfile.TemporaryDirectory() as folder:
        for number, (name, run) in zip(range(options.runs), cycle(PLANS.items()), strict=False):
            found = outcome(run, hashes[name], Path(folder) / str(number))
            outcomes[f'{name}: {found}'] += 1
            if (number + 1) % 50 == 0:
                print(f'loaded-runs: {number + 1} of {options.runs}: {dict(outcomes)}', flush=True)
    for text, count in sorted(outcomes.items()):
        print(f'loaded-runs: {count} runs with {text}')
    return 0 if all(text.endswith(SAME) for text in outcomes) else 1


def outcome(run: RunPlan, expected_hash: str, folder: Path) -> str:
    """Return what a run in the graph ended with; it ends by itself, by its own time limits."""
    try:
        found = record(run, folder).trajectory.sha256()
    except DdctError as error:
        return f'an error: {error}'
    return SAME if found == expected_hash else f'another hash, {found[:12]}'


if __name__ == '__main__':
    raise SystemExit(main())
