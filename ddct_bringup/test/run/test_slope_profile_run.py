# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""On a road whose slope changes, plant and controller use the same load."""

import pytest

from ddct_bringup.run.headless import run_headless
from ddct_plant.models.static_torque import constant_slip_torque
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings


def test_the_open_loop_uses_the_load_at_the_present_instant():
    changes = ['slope={time_s: [0.0, 2.0], slope_rad: [0.0, 0.2]}', 'duration_s=1.0']
    scenario = load_scenario('thesis', [*changes, 'score_window_s=[0.6, 1.0]'])
    run = run_headless(RunSettings(KnownSettings(scenario)), 'pi')
    for step in (0, 30, 90):
        engine, load = run.engine_torque[step], run.load_torque[step]
        expected = constant_slip_torque(scenario.driveline, engine, load)
        assert run.open_loop_torque[step] == pytest.approx(expected)
    assert run.load_torque[90] - run.load_torque[0] == pytest.approx(
        9.81 * 1500 * 0.09 * 0.32, rel=0.02
    )
