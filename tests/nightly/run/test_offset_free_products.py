# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Offset-free and wear-compensating predictive control: every wear, load and architecture."""

from dataclasses import replace

import numpy as np
import pytest
from wrong_engine_torque import WrongEngineTorque

from ddct_bringup.reproduction.studies.changed_loops import slip_after_load_step
from ddct_bringup.reproduction.studies.study import FINER_WEAR_GAINS
from ddct_bringup.reproduction.studies.wear import LOAD_STEP_N_M
from ddct_bringup.reproduction.study_run import study_run
from ddct_bringup.run.headless import run_headless
from ddct_controllers.registry import make_controller
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.scenario.choices.settings import ARCHITECTURES
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

SCENARIO = load_scenario('thesis')
LONG = replace(SCENARIO, duration_s=5.0)
OWN = ('mpc_offset_free', 'mpc_torsion', 'mpc_wear')


def settings(wear_gain=1.0, scenario=SCENARIO, architecture='detailed'):
    return RunSettings(KnownSettings(scenario, architecture), CaseSettings(wear_gain=wear_gain))


@pytest.mark.parametrize('wear_gain', FINER_WEAR_GAINS)
@pytest.mark.parametrize('name', OWN)
def test_the_slip_ends_within_1_rpm_of_zero(name, wear_gain):
    assert abs(study_run(settings(wear_gain), name).metrics['slip_final_rpm']) <= 1.0


@pytest.mark.parametrize('wear_gain', [0.7, 1.0, 1.3])
@pytest.mark.parametrize('name', OWN)
def test_an_unknown_load_step_leaves_no_slip(name, wear_gain):
    run = settings(wear_gain)
    slip = slip_after_load_step(run, make_controller(name, run.known), LOAD_STEP_N_M, 150)
    assert abs(rpm_from_rad_s(slip[-1])) <= 1.0


@pytest.mark.parametrize('wear_gain', FINER_WEAR_GAINS)
def test_weighting_w_sr_lowers_it_at_every_wear(wear_gain):
    damped = study_run(settings(wear_gain), 'mpc_torsion').metrics['torsion_speed_std_rpm']
    free = study_run(settings(wear_gain), 'mpc_offset_free').metrics['torsion_speed_std_rpm']
    assert damped < 0.9 * free


@pytest.mark.parametrize('architecture', ARCHITECTURES)
@pytest.mark.parametrize('wear_gain', [0.7, 1.3])
@pytest.mark.parametrize('name', OWN)
def test_they_work_in_every_architecture(name, wear_gain, architecture):
    run = settings(wear_gain, architecture=architecture)
    trajectory = run_headless(run, name)
    assert dict(trajectory.status[-1])['fallbacks'] == '0'
    assert abs(rpm_from_rad_s(trajectory.slip_speed[-1])) <= 1.0


@pytest.mark.parametrize('wear_gain', [0.4, 1.6, 2.5])
@pytest.mark.parametrize('name', ['mpc_offset_free', 'mpc_wear'])
def test_the_slip_ends_at_zero_far_beyond_that(name, wear_gain):
    slip = run_headless(settings(wear_gain, LONG, 'feedforward'), name).slip_speed
    assert rpm_from_rad_s(np.abs(slip[-50:]).max()) < 0.3


@pytest.mark.parametrize('error_n_m', [-40.0, 20.0, 40.0])
@pytest.mark.parametrize('name', OWN)
def test_an_error_of_the_engine_torque_beyond_what_wear_explains_leaves_no_slip(name, error_n_m):
    weak = ['duration_s=4.0', 'engine.torque_n_m=[0, 60]', 'engine.time_s=[0, 0.4]']
    run = settings(scenario=load_scenario('thesis', weak))
    slip = run_headless(
        run, WrongEngineTorque(make_controller(name, run.known), error_n_m)
    ).slip_speed
    assert rpm_from_rad_s(np.abs(slip[-50:]).max()) < 0.5
