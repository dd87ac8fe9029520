# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Processor time per run of a batch in one process, over runs that all differ.

Each run has a driveline, wear, engine torque and reference of its own.
"""

import dataclasses
import time
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from bench.peers.numpy_loop import NAME, STEPS, numpy_loop_s
from bench.skeleton.comparison import Bench, Sides, comparison, curve

from ddct_bringup.batch.results import stacked_results
from ddct_bringup.batch.run_batch import MOST_RUNS, Run, trajectories
from ddct_bringup.metrics.engagement import Engagement
from ddct_bringup.metrics.values import raw_metrics, window_steps
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.registry import make_controller
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import RunSettings

CONTROLLERS = ('pi', 'ls8', 'hinf1')
LOOP = f'{NAME} of as many runs'


@comparison('batch of 1000 runs, run', LOOP)
def batch(bench: Bench) -> Iterator[Sides]:
    """Processor time per run of simulation, metrics and verdict, by controller."""
    chunks = {name: runs_of(name, MOST_RUNS) for name in CONTROLLERS}

    def ours() -> Mapping[str, float]:
        return {
            f'{name}, {part}': seconds / MOST_RUNS
            for name, runs in chunks.items()
            for part, seconds in times_of(runs).items()
        }

    yield Sides(ours, lambda: STEPS * numpy_loop_s(MOST_RUNS) / MOST_RUNS)


@curve('batch of PI, step', NAME, 'runs', (1, 3, 10, 30, 100, 300, 1000, 3000))
def batch_of_runs(bench: Bench, count: int) -> Iterator[Sides]:
    """Processor time per step and run of simulation and metrics, beside one run in numpy."""
    runs = runs_of('pi', count)
    repeats = max(1, 300 // count)

    def ours() -> float:
        # At most MOST_RUNS at once, as campaigns and `run_batch` do.
        chunks = [runs[first : first + MOST_RUNS] for first in range(0, count, MOST_RUNS)]
        taken = [times_of(chunk) for _ in range(repeats) for chunk in chunks]
        seconds = sum(each['simulation'] + each['metrics'] for each in taken)
        return seconds / repeats / count / STEPS

    yield Sides(ours, numpy_loop_s)


def runs_of(controller: str, count: int) -> list[Run]:
    """Return runs that all differ, with one controller."""
    random, thesis = np.random.default_rng(5), load_scenario('thesis')
    made = make_controller(controller, RunSettings(thesis))
    return [(_varied(thesis, random), made) for _ in range(count)]


def times_of(runs: list[Run]) -> dict[str, float]:
    """Return the processor times in s of the parts of a batch."""
    settings, limits = [each for each, _ in runs], packaged_limits()
    scenario = settings[0].scenario
    window = window_steps(scenario.score_window_s)
    started = time.process_time()
    stack = trajectories(runs)
    simulated = time.process_time()
    raw_metrics(Engagement(stack, scenario.control_start_step, window))
    scored = time.process_time()
    stacked_results(settings, stack, limits)
    judged = time.process_time()
    # The last call computes the metrics once more.
    return {
        'simulation': simulated - started,
        'metrics': scored - simulated,
        'verdict': judged - scored - (scored - simulated),
    }


def _varied(thesis: Scenario, random: np.random.Generator) -> RunSettings:
    def changed(part: Any, **names: float) -> Any:
        values = {
            name: getattr(part, name) * random.uniform(1 - x, 1 + x) for name, x in names.items()
        }
        return dataclasses.replace(part, **values)

    torques = tuple(torque * random.uniform(0.9, 1.1) for torque in thesis.engine.torque_n_m)
    scenario = dataclasses.replace(
        thesis,
        given_driveline=changed(
            thesis.given_driveline, engine_inertia=0.1, halfshaft_stiffness=0.1
        ),
        engine=dataclasses.replace(thesis.engine, torque_n_m=torques),
        reference=changed(thesis.reference, slope_rad_s2=0.3),
    )
    return RunSettings(scenario, wear_gain=float(random.uniform(0.7, 1.3)))
