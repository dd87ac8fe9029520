# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Time per step of the headless loop: each controller, sticking plates, and python-control.

The linear clutch refuses the other packaged scenarios, so their steps with sticking plates are
compared with those of `thesis` with the linear clutch and the same controller.
"""

import statistics
import time
from collections.abc import Iterator, Mapping
from typing import Any

from bench.peers.numpy_loop import LEAST_S, NAME, numpy_loop_s
from bench.skeleton.comparison import Bench, Sides, comparison, extra

from ddct_bringup.run.headless import closed_loop, run_headless, run_loop
from ddct_controllers.registry import controller_names, make_controller
from ddct_plant.models.clutch import LINEAR, STICK_SLIP
from ddct_plant.scenario.file import load_scenario, scenario_names
from ddct_plant.scenario.settings import RunSettings

MEDIAN, WORST = 'median of controllers', 'costliest of controllers and scenarios'
"""Quantities of sticking plates beside the linear clutch."""
SCENARIOS = [
    name for name in scenario_names() if name != 'thesis' and not load_scenario(name).shift
]


def step_s(controller: str, scenario: str = 'thesis', clutch: str = LINEAR) -> float:
    """
    Return the processor time per step in s of headless runs, without their set-up.

    It is that of this thread alone, so that other programs count less. Short runs are repeated.
    """
    settings = RunSettings(load_scenario(scenario, clutch=clutch), clutch=clutch)
    elapsed, steps = 0.0, 0
    while elapsed < LEAST_S:
        loop = closed_loop(settings, make_controller(controller, settings))
        started = time.thread_time()
        trajectory = run_loop(loop, settings.scenario.steps)
        elapsed += time.thread_time() - started
        steps += trajectory.steps
    return elapsed / steps


def steps_s(clutch: str = LINEAR) -> Mapping[str, float]:
    """Return the processor time per step in s of `thesis`, by controller."""
    return {name: step_s(name, clutch=clutch) for name in controller_names()}


@comparison('headless step', NAME)
def headless_step(bench: Bench) -> Iterator[Sides]:
    """Processor time per step of the scenario `thesis`, by controller."""
    yield Sides(steps_s, numpy_loop_s)


@comparison('sticking plates', 'the linear clutch', at_most={MEDIAN: 1.5, WORST: 3.0})
def sticking_plates(bench: Bench) -> Iterator[Sides]:
    """Processor time per step of a headless run, each controller and packaged scenario."""
    yield Sides(
        lambda: {
            **steps_s(STICK_SLIP),
            **{name: step_s('pi', name, STICK_SLIP) for name in SCENARIOS},
        },
        steps_s,
        ratios=ratios,
    )


def ratios(ours: Mapping[str, float], linear: Mapping[str, float]) -> Mapping[str, float]:
    """Return the median ratio over the controllers, and the largest with the scenarios."""
    by_controller = [ours[name] / linear[name] for name in linear]
    by_scenario = [ours[name] / linear['pi'] for name in SCENARIOS]
    return {MEDIAN: statistics.median(by_controller), WORST: max(by_controller + by_scenario)}


@comparison('headless step of PI', 'python-control, blocks', at_most=1 / 3)
def beside_blocks(bench: Bench) -> Iterator[Sides]:
    """Processor time per step; python-control simulates blocks that `interconnect` wires."""
    loop, run = _loop_and_run()
    yield Sides(lambda: step_s('pi'), lambda: loop.response(loop.blocks(), run))


@comparison('headless step of PI', 'python-control, one block written by hand')
def beside_one_block(bench: Bench) -> Iterator[Sides]:
    """Processor time per step; python-control simulates one system of 13 states."""
    loop, run = _loop_and_run()
    yield Sides(lambda: step_s('pi'), lambda: loop.response(loop.one_block(), run))


def _loop_and_run() -> tuple[Any, Any]:
    """Return the loop in python-control and our run; raise NotMeasured without the package."""
    extra('control')
    from bench.peers.python_control_loop import PythonControlLoop

    settings = RunSettings(load_scenario('thesis'))
    run = run_headless(settings, 'pi')
    return PythonControlLoop(settings, run), run
