# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Time of a headless run with the stick-slip clutch over that with the linear one, without set-up.

The linear clutch refuses the other packaged scenarios, so their steps are compared with those of
`thesis` with the linear clutch and the same controller.
"""

import statistics
import time
from typing import Any

from ddct_bringup.run.headless import ClosedLoop, run_loop
from ddct_controllers.registry import controller_names, make_controller
from ddct_plant.scenario.file import load_scenario, scenario_names
from ddct_plant.scenario.settings import RunSettings

MEDIAN_GOAL, WORST_GOAL = 1.5, 3.0
_ROUNDS = 9


def measure() -> dict[str, Any]:
    """Return the ratios of times: by controller on `thesis`, and by packaged scenario with PI."""
    thesis = {name: _ratio('thesis', name) for name in controller_names()}
    others = {name: _ratio(name, 'pi') for name in scenario_names() if name != 'thesis'}
    return {'controllers': thesis, 'scenarios': others}


def print_table(results: dict[str, Any]) -> None:
    """Print the results of `measure`."""
    ratios = sorted(results['controllers'].values())
    runs = {**results['controllers'], **results['scenarios']}
    worst = max(runs, key=lambda name: runs[name])
    median = statistics.median(ratios)
    met = median <= MEDIAN_GOAL and runs[worst] <= WORST_GOAL
    print(
        f'stick_slip over linear, headless (goal: median {MEDIAN_GOAL:g}, worst {WORST_GOAL:g}: '
        f'{"met" if met else "MISSED"}): median {median:.2f} ({ratios[0]:.2f} to '
        f'{ratios[-1]:.2f}), worst {runs[worst]:.2f} with {worst}'
    )


def _ratio(scenario: str, controller: str) -> float:
    """Return the median ratio of the times per step, measured in turn, to linear `thesis`."""
    runs = [
        RunSettings(load_scenario('thesis'), clutch='linear'),
        RunSettings(load_scenario(scenario), clutch='stick_slip'),
    ]
    ratios = []
    for _ in range(_ROUNDS):
        linear, stick_slip = (_step_s(settings, controller) for settings in runs)
        ratios.append(stick_slip / linear)
    return statistics.median(ratios)


def _step_s(settings: RunSettings, controller: str) -> float:
    """Return the processor time per step in s of this thread alone, as others must not count."""
    loop = ClosedLoop(settings, make_controller(controller, settings))
    started = time.thread_time()
    trajectory = run_loop(loop, settings.scenario.steps)
    return (time.thread_time() - started) / (len(trajectory.slip_speed) - 1)
