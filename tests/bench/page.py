# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Time until a browser has drawn all charts of a report."""

import statistics
import sys
import tempfile
from pathlib import Path
from typing import Any

from ddct_bringup.bag.trajectory_bag import write_trajectory
from ddct_bringup.report.page import report_page
from ddct_bringup.report.runs import read_run
from ddct_bringup.run.description import custom_data
from ddct_bringup.run.headless import run_headless
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.registry import own_controller_names
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

sys.path.append(str(Path(__file__).parents[1] / 'report'))
from headless_chromium import chromium, visit

GOALS_MS = {5: 2000.0, len(own_controller_names()): 4000.0}
"""Goal of the time until all charts are drawn in ms, by number of runs."""


def measure(repeats: int = 5) -> dict[str, Any]:
    """Return median times in ms from opening the file, and sizes in MB, by number of runs."""
    if chromium() is None:
        return {'skipped': 'no Chromium on this machine'}
    return {str(count): _measure(own_controller_names()[:count], repeats) for count in GOALS_MS}


def print_table(results: dict[str, Any]) -> None:
    """Print the results of `measure`."""
    if 'skipped' in results:
        print(f'report drawn: not measured: {results["skipped"]}')
        return
    for count, goal_ms in GOALS_MS.items():
        found = results[str(count)]
        print(
            f'report of {count} runs drawn: {found["median_ms"]:.0f} ms (goal {goal_ms:.0f} ms), '
            f'{found["megabytes"]:.2f} MB'
        )


def _measure(controllers: list[str], repeats: int) -> dict[str, float]:
    settings = RunSettings(load_scenario('thesis'))
    trajectory = run_headless(settings, 'ls8')  # drawing takes as long whichever run it is
    steps = settings.scenario.steps
    with tempfile.TemporaryDirectory() as folder:
        bags = [Path(folder) / name for name in controllers]
        for bag in bags:
            write_trajectory(trajectory, bag, bag.name, custom_data(settings, bag.name, steps), {})
        limits = packaged_limits()
        runs = [read_run(bag, Path(folder), limits) for bag in bags]
        page = Path(folder) / 'report.html'
        page.write_text(report_page(runs, [], limits), encoding='utf-8')
        times = [visit(page).ready_ms for _ in range(repeats)]
        return {
            'median_ms': statistics.median(times),
            'megabytes': page.stat().st_size / 1e6,
        }
