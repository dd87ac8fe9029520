# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Processor time per run of a batch in one process, over runs that all differ.

Each run has a driveline, wear, engine torque and reference of its own.
"""

import dataclasses
import statistics
import time
from typing import Any

import numpy as np

from ddct_bringup.batch.results import stacked_results
from ddct_bringup.batch.run_batch import MOST_RUNS, Run, trajectories
from ddct_bringup.scores.metrics import metric_values
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.registry import make_controller
from ddct_plant.base.timebase import steps_in
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import RunSettings

GOAL_US = 100.0
"""Goal of the time per run of simulation and metrics, us."""
RUNS = 5000
CONTROLLERS = ('pi', 'ls8', 'hinf1')


def measure() -> dict[str, dict[str, float]]:
    """Return the times per run in us of simulation, metrics and verdict, by controller."""
    return {name: _times(name) for name in CONTROLLERS}


def print_table(results: dict[str, dict[str, float]]) -> None:
    """Print the results of `measure`."""
    for name, times in results.items():
        to_metrics = times['simulation'] + times['metrics']
        print(
            f'batch of {RUNS} runs, {name}: {to_metrics:.0f} us per run and core to every metric '
            f'(goal {GOAL_US:g}: {"met" if to_metrics <= GOAL_US else "MISSED"}), of which '
            f'simulation {times["simulation"]:.0f}; verdict with its criteria '
            f'{times["verdict"]:.0f} more'
        )


def _times(name: str) -> dict[str, float]:
    random, thesis = np.random.default_rng(5), load_scenario('thesis')
    controller = make_controller(name, RunSettings(thesis))
    chunks = [
        _chunk_s([(_varied(thesis, random), controller) for _ in range(MOST_RUNS)])
        for _ in range(RUNS // MOST_RUNS)
    ]
    return {
        part: 1e6 * statistics.median(chunk[part] for chunk in chunks) / MOST_RUNS
        for part in chunks[0]
    }


def _chunk_s(runs: list[Run]) -> dict[str, float]:
    settings, limits = [each for each, _ in runs], packaged_limits()
    scenario = settings[0].scenario
    window = tuple(steps_in('score_window_s', each) for each in scenario.score_window_s)
    started = time.process_time()
    stack = trajectories(runs)
    simulated = time.process_time()
    metric_values(stack, scenario.control_start_step, window)
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


if __name__ == '__main__':
    print_table(measure())
