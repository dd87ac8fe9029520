# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Statements of docs/thesis/calibration.md on the start of the thesis's scenario."""

from pathlib import Path

import numpy as np

from ddct_bringup.run.headless import run_headless
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.models.driveline_model import driveline_matrices
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.initial_state import initial_state
from ddct_plant.scenario.settings import KnownSettings, RunSettings

PAGE = Path(__file__).resolve().parents[3] / 'docs' / 'thesis' / 'calibration.md'
SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')))


def test_page_states_the_acceleration_and_the_slip_that_the_start_makes():
    start = initial_state(SETTINGS)
    model = driveline_matrices(SETTINGS.scenario.driveline)
    state = start.states
    torques = [start.engine_torque, start.sides[0].torque, start.load_torque]
    shaft = (model.a @ np.array(state) + model.b @ np.array(torques))[1]
    run = run_headless(SETTINGS, 'pi')
    slip = rpm_from_rad_s(run.slip_speed[1])
    twist = rpm_from_rad_s(run.joint_speed[1, 3])
    text = ' '.join(PAGE.read_text(encoding='utf-8').split())
    assert f'dw_p/dt = {shaft:.0f} rad/s²'.replace('-', '−') in text
    assert f'w_d is {slip:.0f} rpm and w_sr {twist:.0f} rpm'.replace('-', '−') in text
