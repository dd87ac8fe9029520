# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Controllers bring the slip to zero while the reference holds the engine at a speed."""

import numpy as np
import pytest

from ddct_bringup.run.headless import run_headless
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

TARGET = [
    'reference.shape=engine_speed_target',
    'engine_speed_reference.time_s=[0.0]',
    'engine_speed_reference.speed_rad_s=[210.0]',
]


@pytest.mark.parametrize('controller', ['mpc_preview', 'mpc4_wear'])
def test_controllers_of_one_and_two_inputs_follow_it(controller):
    settings = RunSettings(KnownSettings(load_scenario('thesis', TARGET)))
    run = run_headless(settings, controller)
    start = settings.scenario.control_start_step
    error = run.slip_reference[:, 0] - run.slip_speed
    assert not np.any(error[: start + 1])
    assert run.slip_reference[start + 5, 0] > 10.0
    assert not np.any(run.slip_reference[-20:])
    assert np.abs(run.slip_speed[-20:]).max() < 3.0
