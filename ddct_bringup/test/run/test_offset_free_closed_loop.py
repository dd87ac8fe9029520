# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Offset-free and wear-compensating predictive control in the frozen scenario."""

import itertools
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from samples import sampled
from wrong_engine_torque import WrongEngineTorque

from ddct_bringup.reproduction.studies import wear
from ddct_bringup.reproduction.studies.changed_loops import NoisySpeeds, slip_after_load_step
from ddct_bringup.reproduction.studies.sweeps import torsion_weight
from ddct_bringup.reproduction.studies.wear import LOAD_STEP_N_M, wear_estimate
from ddct_bringup.reproduction.study_run import thesis_run
from ddct_bringup.run.headless import run_headless, run_loop
from ddct_controllers.loop import ClosedLoop
from ddct_controllers.mpc.estimate.observer import NoiseLevels
from ddct_controllers.mpc.estimate.wear_state import HIGHEST_GAIN, LOWEST_GAIN
from ddct_controllers.mpc.model.transmission_model import transmission_model
from ddct_controllers.registry import make_controller
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.models.linear_driveline import Driveline
from ddct_plant.scenario.choices.settings import ARCHITECTURES
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.initial_state import initial_request
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

pytestmark = pytest.mark.slow

SCENARIO = load_scenario('thesis')
LONG = replace(SCENARIO, duration_s=5.0)
OWN = ('mpc_offset_free', 'mpc_torsion', 'mpc_wear')


def settings(wear_gain=1.0, scenario=SCENARIO, architecture='detailed', **options):
    controllers = {**scenario.controllers, **options}
    return RunSettings(
        KnownSettings(replace(scenario, controllers=controllers), architecture),
        CaseSettings(wear_gain=wear_gain),
    )


@cache
def long_run(wear_gain):
    return run_headless(settings(wear_gain, LONG, 'feedforward'), 'mpc_wear')


@pytest.mark.parametrize(
    ('wear_gain', 'name'), sampled(itertools.product([0.7, 1.3], OWN), every=2)
)
def test_it_stays_there(name, wear_gain):
    slip = run_headless(settings(wear_gain, LONG), name).slip_speed
    assert rpm_from_rad_s(np.abs(slip[-50:]).max()) < 0.15


@pytest.mark.parametrize('name', OWN)
def test_an_unknown_load_step_leaves_no_slip(name):
    run = settings(0.7)
    slip = slip_after_load_step(run, make_controller(name, run.known), LOAD_STEP_N_M, 150)
    assert abs(rpm_from_rad_s(slip[-1])) <= 1.0


@pytest.mark.parametrize(('name', 'least_rpm'), [('mpc3', 20.0), ('mpc_preview', 50.0)])
def test_the_others_keep_an_error_of_each(name, least_rpm):
    assert abs(thesis_run(name, 'detailed', 0.85).metrics['slip_final_rpm']) > 100.0
    run = settings()
    slip = slip_after_load_step(run, make_controller(name, run.known), LOAD_STEP_N_M, 150)
    assert abs(rpm_from_rad_s(slip[-1])) > least_rpm


def test_with_a_new_clutch_they_engage_as_fast_as_mpc_preview():
    fastest = thesis_run('mpc_preview', 'detailed', 1.0).metrics['engagement_time_s']
    for name in ('mpc_offset_free', 'mpc_wear'):
        run = thesis_run(name, 'detailed', 1.0)
        assert run.metrics['engagement_time_s'] == pytest.approx(fastest, abs=1e-5)


def test_weighting_w_sr_lowers_it():
    damped, free = (
        thesis_run(name, 'detailed', 0.7).metrics['torsion_speed_std_rpm']
        for name in ('mpc_torsion', 'mpc_offset_free')
    )
    assert damped < 0.9 * free


def test_w_sr_falls_and_the_slip_error_grows_with_the_weight():
    table = torsion_weight()
    torsion, slip_error = (
        np.array([float(row[table.headers.index(name)]) for row in table.rows])
        for name in ('std w_sr rpm', 'slip RMSE rpm')
    )
    assert np.all(np.diff(torsion) < 0.0)
    assert np.all(np.diff(slip_error) > 0.0)


@pytest.mark.parametrize('wear_gain', [0.7, 1.3])
def test_the_wear_is_known_when_control_starts(wear_gain):
    trajectory = thesis_run('mpc_wear', 'detailed', wear_gain).trajectory
    status = dict(trajectory.status[SCENARIO.control_start_step])
    assert float(status['wear_gain_estimate']) == pytest.approx(wear_gain, abs=1e-3)


def test_the_estimate_of_wear_stays_right_with_noise_and_a_load_step(monkeypatch):
    monkeypatch.setattr(wear, 'FINER_WEAR_GAINS', (0.7, 1.0, 1.3))
    table = wear_estimate()
    figures = np.array([[float(cell) for cell in row] for row in table.rows])
    known_from_s, _, largest_error, slip_final_rpm = figures[:, 2:].T
    assert set(figures[:, 1]) == {0.0, NoiseLevels().speed_rad_s}
    assert np.all(known_from_s < 0.2)
    assert np.all(largest_error < 0.01)
    assert np.all(np.abs(slip_final_rpm) <= 1.0)


def test_with_feedback_from_the_start_wear_makes_no_difference_to_mpc_wear():
    new, *worn = (
        thesis_run('mpc_wear', 'feedforward', gain).trajectory.slip_speed[60:]
        for gain in (1.0, 0.7, 1.3)
    )
    for slip in worn:
        assert rpm_from_rad_s(np.abs(slip - new).max()) < 2.0


@pytest.mark.parametrize('architecture', ARCHITECTURES)
def test_they_work_in_every_architecture(architecture):
    trajectory = thesis_run('mpc_wear', architecture, 0.7).trajectory
    assert dict(trajectory.status[-1])['fallbacks'] == '0'
    assert abs(rpm_from_rad_s(trajectory.slip_speed[-1])) <= 1.0


@pytest.mark.parametrize('wear_gain', [0.4, 2.5])
def test_the_slip_ends_at_zero_far_beyond_that(wear_gain):
    slip = long_run(wear_gain).slip_speed
    assert rpm_from_rad_s(np.abs(slip[-50:]).max()) < 0.3


@pytest.mark.parametrize('wear_gain', [0.4, 1.6])
def test_the_status_reports_when_a_bound_holds_the_wear_gain(wear_gain):
    reached, estimates = np.transpose(
        [
            (status['wear_gain_at_bound'] == 'true', float(status['wear_gain_estimate']))
            for status in map(dict, long_run(wear_gain).status)
        ]
    )
    assert np.any(reached)
    np.testing.assert_array_equal(reached, np.isin(estimates, (LOWEST_GAIN, HIGHEST_GAIN)))


@pytest.mark.parametrize('error_n_m', [-40.0, 40.0])
def test_an_error_of_the_engine_torque_beyond_what_wear_explains_leaves_no_slip(error_n_m):
    weak = ['duration_s=4.0', 'engine.torque_n_m=[0, 60]', 'engine.time_s=[0, 0.4]']
    run = settings(scenario=load_scenario('thesis', weak))
    slip = run_headless(
        run, WrongEngineTorque(make_controller('mpc_wear', run.known), error_n_m)
    ).slip_speed
    assert rpm_from_rad_s(np.abs(slip[-50:]).max()) < 0.5


class ExactLoop(ClosedLoop):
    """The plant as the model has it: the actuator's torque within a period is no polygon."""

    def __init__(self, run, controller):
        super().__init__(run, controller)
        start, request = self.plant.driveline.outputs(), initial_request(run)
        self._exact = transmission_model(run.scenario.driveline)
        engine, shaft, wheel, _ = start.joint_speed
        twist = start.joint_position[3]
        self._state = self._exact.at_rest((engine, shaft, wheel), twist, request)

    def advance(self, reply):
        super().advance(reply)
        inputs = reply.signals['torque_request'], reply.engine_torque, reply.load_torque
        self._state = self._exact.a @ self._state + self._exact.b @ inputs
        assert isinstance(self.plant.driveline, Driveline)
        self.plant.driveline._state_and_inputs[:4] = self._state[:4]


@pytest.mark.parametrize('name', ['mpc_offset_free', 'mpc_wear'])
def test_with_no_error_at_all_the_commands_are_those_of_mpc_preview(name):
    run = settings()
    preview, own = (
        run_loop(ExactLoop(run, make_controller(controller, run.known)), SCENARIO.steps)
        for controller in ('mpc_preview', name)
    )
    np.testing.assert_allclose(own.torque_request, preview.torque_request, atol=1e-8)
    np.testing.assert_allclose(own.slip_speed, preview.slip_speed, atol=1e-8)


@pytest.mark.parametrize('wear_gain', [0.7, 1.3])
def test_limits_are_those_of_the_request_whatever_the_wear(wear_gain):
    limits = {'highest_torque_n_m': 400.0, 'torque_rate_n_m_s': 600.0}
    trajectory = run_headless(settings(wear_gain, mpc_wear=limits), 'mpc_wear')
    controlled = trajectory.torque_request[SCENARIO.control_start_step :]
    changes = np.abs(np.diff(controlled))
    assert changes.max() == pytest.approx(6.0, abs=1e-6)
    assert controlled.max() <= 400.0 + 1e-6
    assert dict(trajectory.status[-1])['fallbacks'] == '0'
    if wear_gain < 1.0:
        assert controlled.max() == pytest.approx(400.0, abs=1e-6)


@pytest.mark.parametrize('name', OWN)
def test_a_controller_that_has_run_repeats_its_run_to_the_last_bit(name):
    run = settings(0.85, load_scenario('thesis', ['duration_s=1.2']))
    controller = NoisySpeeds(make_controller(name, run.known), 0.05, seed=1)
    first = run_headless(run, controller).sha256()
    controller.reset()
    assert run_headless(run, controller).sha256() == first
