# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Gear shifts whose floors are tested."""

from collections.abc import Iterable

import numpy as np
import pytest

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.floor.case import Case, case_of_run
from ddct_bringup.floor.control_start import control_start
from ddct_bringup.floor.dynamics.start import start_of
from ddct_bringup.floor.lock import lock_of
from ddct_bringup.run.headless import run_loop
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.loop import ClosedLoop
from ddct_controllers.registry import make_controller, own_controller_names
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings


def settings_of(scenario='upshift', overrides=(), **further) -> RunSettings:
    """Return the settings of a shift with overrides KEY=VALUE."""
    loaded = load_scenario(scenario, overrides)
    return RunSettings.of(loaded, further)


def compared_starts(handover: str, names: Iterable[str]) -> int:
    """Require one state at the start of the inertia phase; return the number of controllers."""
    settings = settings_of(handover=handover)
    expected = control_start(settings)
    compared = 0
    for name in names:
        controller = make_controller(name, settings.known)
        if controller.commands_engine:
            continue
        run = run_loop(ClosedLoop(settings, controller), expected.step + 12)
        start = start_of(settings, run)
        assert start.step == expected.step, name
        for field in ('state', 'actuator', 'requests', 'accelerations', 'driving'):
            np.testing.assert_array_equal(getattr(start, field), getattr(expected, field), name)
        for field in ('requests', 'effects', 'most'):
            np.testing.assert_array_equal(
                getattr(start.off_going, field), getattr(expected.off_going, field), name
            )
        assert start.friction_work == pytest.approx(expected.friction_work, rel=1e-9)
        compared += 1
    return compared


def require_all_controllers_start_alike(handover: str) -> None:
    """Require that all controllers of the clutch reach the inertia phase in one state."""
    assert compared_starts(handover, own_controller_names()) >= 20


def case_with(settings: RunSettings, run: Trajectory) -> Case | None:
    """Return the runs that lock when a run does, which include it."""
    start = control_start(settings)
    lock = lock_of(run, start.step, packaged_limits().rules)
    return None if lock is None else case_of_run(settings, start, lock, run)
