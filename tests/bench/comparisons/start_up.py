# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Time of a run through the graph beside its ticks."""

import json
import time
from collections.abc import Iterator, Mapping
from pathlib import Path

from bench.comparisons.graph import CHAIN, timing_of
from bench.peers.chain_processes import Chain
from bench.skeleton.comparison import Bench, Sides, comparison
from bench.skeleton.workspace import Workspace

ROUND = Path(__file__).parents[1] / 'peers' / 'start_up_round.py'
BASE = 'the base commit'
WARM_PARENT = Path('ddct_bringup', 'ddct_bringup', 'processes', 'warm_parent.py')
STEPS = 300


@comparison('graph: one run by bringup, beside its ticks', CHAIN)
def beside_its_ticks(bench: Bench) -> Iterator[Sides]:
    """Wall time of `ddct bringup` with a process for each node, less that of its ticks."""

    def ours() -> float:
        started = time.monotonic()
        ticks_s = timing_of(bench.ours)['wall_time_s']
        return time.monotonic() - started - ticks_s

    yield Sides(ours, Chain(STEPS).beside_steps_s, warm_up=False)


@comparison(
    'start-up of the graph',
    BASE,
    at_most={'one run, to its first tick': 1 / 3, 'one run, beside its ticks': 1 / 3},
)
def beside_the_base(bench: Bench) -> Iterator[Sides]:
    """Wall and processor time of the first and of each further run of one program."""
    base = bench.require_base()
    # The bound is that of the change to a warm parent.
    before = not (base.folder / WARM_PARENT).exists()
    yield Sides(
        lambda: round_of(bench.ours), lambda: round_of(base), bounded=before, warm_up=False
    )


def round_of(workspace: Workspace) -> Mapping[str, float]:
    """Return the times in s of a process that carries out three runs, by quantity."""
    return json.loads(workspace.run('python', '-P', ROUND).output)
