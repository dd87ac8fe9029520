# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Processor time per step of runs without a graph: beside python-control, and of a gear shift."""

import time
from functools import partial

from bench.ratios import Comparison, Cost, NotMeasured
from ddct_bringup.run.headless import run_headless, run_loop
from ddct_controllers.loop import ClosedLoop
from ddct_controllers.registry import make_controller
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

LEAST_S = 0.05
"""Least duration of one measurement, s, so that the clock does not limit it."""


def step_s(controller: str, scenario: str = 'thesis') -> float:
    """
    Return the processor time per step in s of headless runs, without their set-up.

    It is that of this thread alone, so that other programs count less. Short runs are repeated.
    """
    settings = RunSettings(KnownSettings(load_scenario(scenario)))
    elapsed, steps = 0.0, 0
    while elapsed < LEAST_S:
        loop = ClosedLoop(settings, make_controller(controller, settings.known))
        started = time.thread_time()
        trajectory = run_loop(loop, settings.scenario.steps)
        elapsed += time.thread_time() - started
        steps += trajectory.steps
    return elapsed / steps


def _beside_python_control() -> tuple[Cost, Cost]:
    try:
        from bench.python_control_loop import PythonControlLoop
    except ImportError as error:
        raise NotMeasured(str(error)) from error
    settings = RunSettings(KnownSettings(load_scenario('thesis')))
    run = run_headless(settings, 'pi')
    peer = PythonControlLoop(settings, run)
    return partial(step_s, 'pi'), peer.step_s


HEADLESS = [
    Comparison('headless step of pi', 'python-control, interconnect', _beside_python_control),
    Comparison(
        'headless step of a gear shift, pi',
        'a launch',
        lambda: (
            partial(step_s, 'pi', 'upshift'),
            partial(step_s, 'pi', 'launch'),
        ),
    ),
]
