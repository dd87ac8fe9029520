# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Time of metrics and verdict of one recorded run."""

import statistics
import tempfile
import time
from pathlib import Path

from ddct_bringup.bag.reader import Recording, read_bag
from ddct_bringup.run.execution import execute
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.scores.scoring import score_recording
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

GOAL_MS = 10.0


def measure(repeats: int = 30) -> float:
    """Return the median time in ms over recordings of `thesis`; each is read anew, uncached."""
    with tempfile.TemporaryDirectory() as folder:
        execute(RunPlan(RunSettings(load_scenario('thesis')), 'ls8', 'headless'), Path(folder))
        recordings = [read_bag(Path(folder)) for _ in range(repeats)]
        return statistics.median(_ms(recording) for recording in recordings)


def _ms(recording: Recording) -> float:
    started = time.perf_counter()
    score_recording(recording, 'bag', packaged_limits())
    return 1e3 * (time.perf_counter() - started)
