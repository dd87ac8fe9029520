# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Short planned runs, and their recordings."""

from pathlib import Path
from typing import Any

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.bag.recording import Recording
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.run.execution import execute
from ddct_bringup.run.headless import run_headless
from ddct_bringup.run.plan import RunPlan
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

LAYOUTS = ('processes', 'single-process', 'headless')
SHORT_S = 1.0
"""Duration of a short run, s: 40 steps under control, which starts at 0.6 s."""


def plan(
    controller: str = 'ls8',
    layout: str = 'processes',
    *,
    scenario: str = 'thesis',
    duration_s: float = SHORT_S,
    wear_gain: float = 1.0,
    mode: str = 'lockstep',
    seed: int = 0,
    changes: tuple[str, ...] = (),
    **of_shift: Any,
) -> RunPlan:
    """Return a short run of a packaged scenario; `of_shift` are settings of a gear shift."""
    content = load_scenario(scenario, [f'duration_s={duration_s}', *changes])
    settings = RunSettings.of(
        content, {**of_shift, 'wear_gain': wear_gain, 'mode': mode, 'seed': seed}
    )
    return RunPlan(settings, controller, layout)


def record(run: RunPlan, folder: Path) -> Recording:
    """Execute a run into a new folder and return its recording."""
    folder.mkdir(parents=True)
    execute(run, folder)
    return read_bag(folder)


def expected(run: RunPlan) -> Trajectory:
    """Return the trajectory that the run must have, from the headless loop."""
    return run_headless(run.settings, run.controller)


def bag_bytes(folder: Path) -> dict[str, bytes]:
    """Return the deterministic files of a bag folder by name."""
    files = [*folder.glob('*.mcap'), *folder.glob('metadata.yaml')]
    assert len(files) == 2, sorted(folder.iterdir())
    return {file.name: file.read_bytes() for file in files}
