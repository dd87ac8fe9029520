# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Gear shifts whose floors are tested."""

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.floor.case import Case, case_of_run
from ddct_bringup.floor.control_start import control_start
from ddct_bringup.floor.lock import lock_of
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings


def settings_of(scenario='upshift', overrides=(), **further) -> RunSettings:
    """Return the settings of a shift with overrides KEY=VALUE."""
    loaded = load_scenario(scenario, overrides, clutch='stick_slip')
    return RunSettings(loaded, clutch='stick_slip', **further)


def case_with(settings: RunSettings, run: Trajectory) -> Case | None:
    """Return the runs that lock when a run does, which include it."""
    start = control_start(settings)
    lock = lock_of(run, start.step)
    return None if lock is None else case_of_run(settings, start, lock, run)
