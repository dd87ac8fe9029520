# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Time of metrics and verdict of one recorded run."""

import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from bench.peers.numpy_loop import NAME, STEPS, numpy_loop_s
from bench.skeleton.comparison import Bench, Sides, comparison

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.run.execution import execute
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.scores.scored_recording import score_recording
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

_REPEATS = 10


@comparison('metrics and verdict of a run', f'{NAME} of as many steps')
def metrics_and_verdict(bench: Bench) -> Iterator[Sides]:
    """Processor time of scoring a recording of `thesis`; each is read anew, uncached."""
    limits = packaged_limits()
    with tempfile.TemporaryDirectory() as folder:
        execute(RunPlan(RunSettings(load_scenario('thesis')), 'ls8', 'headless'), Path(folder))

        def ours() -> float:
            recordings = [read_bag(Path(folder)) for _ in range(_REPEATS)]
            started = time.thread_time()
            for recording in recordings:
                score_recording(recording, 'bag', limits)
            return (time.thread_time() - started) / _REPEATS

        yield Sides(ours, lambda: STEPS * numpy_loop_s())
