# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Processor time per step and run of many runs at once, beside one run step by step."""

import time
from functools import partial

import numpy as np

from bench.headless import step_s
from bench.ratios import Comparison, Cost
from ddct_bringup.batch.simulate import simulate_batch
from ddct_controllers.registry import make_controller
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

RUNS = 1000


def batch_step_s(controller: str, scenario: str) -> float:
    """
    Return the processor time per step and run in s of runs whose clutches are worn.

    It counts the set-up of the loops, and leaves out the scores.
    """
    known = KnownSettings(load_scenario(scenario))
    made = make_controller(controller, known)
    wear = np.linspace(0.7, 1.0, RUNS).tolist()
    runs = [RunSettings(known, CaseSettings(wear_gain=each)) for each in wear]
    started = time.thread_time()
    stack = simulate_batch(runs, [made] * RUNS)
    elapsed = time.thread_time() - started
    steps = int(stack.last.sum())
    assert not stack.unsure.any(), f'{controller} in {scenario}: a run goes step by step'
    return elapsed / steps


def _beside_one(controller: str, scenario: str) -> tuple[Cost, Cost]:
    return partial(batch_step_s, controller, scenario), partial(step_s, controller, scenario)


BATCH = [
    Comparison(
        f'step of a batch of {scenario}, {controller}',
        'headless step',
        partial(_beside_one, controller, scenario),
    )
    for scenario, controller in (
        *(('launch', name) for name in ('ls8', 'mpc3', 'mpc_wear', 'least_jerk')),
        ('upshift', 'ls8'),
    )
]
