# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The thesis's scenario does not start in equilibrium."""

import numpy as np

from ddct_bringup.run.headless import run_headless
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.models.driveline_model import driveline_matrices
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.initial_state import initial_state
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')))


def test_the_start_makes_this_acceleration_and_this_slip_after_10_ms():
    start = initial_state(SETTINGS)
    model = driveline_matrices(SETTINGS.scenario.driveline)
    state = start.states
    torques = [start.engine_torque, start.sides[0].torque, start.load_torque]
    shaft = (model.a @ np.array(state) + model.b @ np.array(torques))[1]
    run = run_headless(SETTINGS, 'pi')
    slip = rpm_from_rad_s(run.slip_speed[1])
    twist = rpm_from_rad_s(run.joint_speed[1, 3])
    assert (round(shaft), round(slip), round(twist)) == (-779, 38, -4)
