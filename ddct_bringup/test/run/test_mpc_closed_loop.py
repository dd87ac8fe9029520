# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""MPC1-3 in the closed loop agree with their pages."""

import itertools

import numpy as np
import pytest
import scipy.linalg
from samples import sampled

from ddct_bringup.reproduction.studies import readings as module
from ddct_bringup.reproduction.studies.readings import readings
from ddct_bringup.reproduction.studies.study import TABLE_5_1, cells
from ddct_bringup.reproduction.study_run import (
    THESIS_SCENARIO,
    StudyRun,
    thesis_run,
)
from ddct_bringup.run.headless import run_headless
from ddct_controllers.interface import Command, Controller, ControllerContext
from ddct_controllers.mpc.costs import TABLE_4_1
from ddct_controllers.mpc.variants import PREDICTIVE
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.models.driveline_model import driveline_matrices
from ddct_plant.models.printed import ACTUATOR
from ddct_plant.scenario.choices.settings import ARCHITECTURES
from ddct_plant.scenario.settings import KnownSettings, RunSettings

pytestmark = pytest.mark.slow

SETTINGS = RunSettings(KnownSettings(THESIS_SCENARIO))
EVERYWHERE = [*itertools.product(TABLE_4_1, ARCHITECTURES)]


@pytest.fixture(scope='module')
def readings_table():
    """Return the readings of MPC3 alone."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, 'TABLE_4_1', {'mpc3': TABLE_4_1['mpc3']})
        return readings()


class AsDrawn(Controller):
    """MPC1-3 of Figure 4.2, in rpm, straight from the transfer functions' states."""

    def __init__(self, prediction_steps, control_steps):
        plant, actuator = driveline_matrices(THESIS_SCENARIO.driveline), ACTUATOR.to_state_space()
        a = np.zeros((10, 10))
        a[:4, :4], a[:4, 4:8], a[4:8, 4:8] = plant.a, plant.b[:, 1:2] @ actuator.c, actuator.a
        a[4:8, 8], a[:4, 9] = actuator.b[:, 0], plant.b[:, 0]
        sampled = scipy.linalg.expm(0.01 * a)
        self.a, self.b = sampled[:8, :8], sampled[:8, 8:]
        self.c = rpm_from_rad_s(1.0) * np.array([1.0, -1.0, 0, 0, 0, 0, 0, 0])
        p = np.eye(8)
        for _ in range(20000):
            l_gain = p @ self.c / (self.c @ p @ self.c + 1.0)
            p = self.a @ (p - np.outer(l_gain, self.c @ p)) @ self.a.T + self.b @ self.b.T
        self.l_gain, self.steps = l_gain, prediction_steps
        steps = np.cumsum([self.c @ each @ self.b[:, 0] for each in self._powers()])
        moves = np.zeros((prediction_steps, control_steps))
        for j in range(control_steps):
            moves[j:, j] = steps[: prediction_steps - j]
        weighed = np.vstack([0.26 * moves, 0.39 * np.eye(control_steps)])
        self.first_move = 0.26 * np.linalg.pinv(weighed)[0, :prediction_steps]
        self.reset()

    def _powers(self):
        power = np.eye(8)
        for _ in range(self.steps):
            yield power
            power = self.a @ power

    def reset(self):
        self.x, self.own = np.zeros(8), 0.0

    def _advance(self, request, measurement):
        self.own = request - measurement.open_loop_torque
        self.x = self.a @ self.x + self.b @ [max(request, 0.0), measurement.engine_torque]

    def _correct(self, measurement):
        slip = rpm_from_rad_s(measurement.engine_speed - measurement.shaft_speed)
        self.x = self.x + self.l_gain * (slip - self.c @ self.x)

    def hold(self, measurement):
        self._correct(measurement)
        self._advance(measurement.open_loop_torque, measurement)

    def update(self, measurement):
        self._correct(measurement)
        before = measurement.open_loop_torque + self.own
        x, errors = self.x, []
        for _ in range(self.steps):
            x = self.a @ x + self.b @ [before, measurement.engine_torque]
            errors.append(rpm_from_rad_s(measurement.slip_reference[0]) - self.c @ x)
        self._advance(before + self.first_move @ errors, measurement)
        return Command(self.own)


def with_full_information(name):
    """Return a controller of Table 4.1 with the information of `mpc_preview`."""
    options = {'measured': 'speeds', 'load_known': True, 'delay_in_model': True, 'preview': True}
    return PREDICTIVE[name](ControllerContext(SETTINGS.known, options))


@pytest.mark.parametrize(('name', 'architecture'), sampled(EVERYWHERE, every=3))
def test_with_full_information_slip_ends_at_zero_without_a_fallback(name, architecture):
    run = run_headless(
        RunSettings(KnownSettings(THESIS_SCENARIO, architecture)), with_full_information(name)
    )
    assert abs(rpm_from_rad_s(run.slip_speed[-1])) < 1.0
    assert {dict(status).get('fallbacks', '0') for status in run.status} == {'0'}


@pytest.mark.parametrize(('name', 'architecture'), sampled(EVERYWHERE, every=3))
def test_as_drawn_an_error_stays_that_section_6_1_would_remove_by_an_integrator(
    name, architecture
):
    run = thesis_run(name, architecture, 1.0).trajectory
    assert 4.5 < rpm_from_rad_s(run.slip_speed[-1]) < 6.0
    statuses = [dict(status) for status in run.status]
    assert {status.get('fallbacks', '0') for status in statuses} == {'0'}
    assert statuses[-1]['qp_status'] == 'solved'


def test_as_drawn_mpc3_is_what_a_simulation_of_its_own_gives():
    """Only plant and start are the product's; toolbox filter and normal equations are new here."""
    peer = run_headless(SETTINGS, AsDrawn(prediction_steps=22, control_steps=4))
    ours = thesis_run('mpc3', 'detailed', 1.0).trajectory
    np.testing.assert_allclose(ours.torque_request, peer.torque_request, atol=1e-6)
    figures_of_peer = StudyRun(SETTINGS, 'as drawn', peer).metrics
    assert figures_of_peer['engagement_time_s'] == pytest.approx(0.580, abs=5e-4)
    assert figures_of_peer['torsion_speed_std_rpm'] == pytest.approx(1.788, abs=5e-4)
    assert figures_of_peer['acceleration_std_m_s2'] == pytest.approx(0.2885, abs=5e-5)
    assert figures_of_peer['slip_final_rpm'] == pytest.approx(5.70, abs=5e-3)


def test_mpc_preview_is_mpc3_with_full_information():
    informed = run_headless(SETTINGS, with_full_information('mpc3'))
    preview = thesis_run('mpc_preview', 'detailed', 1.0).trajectory
    assert informed.sha256() == preview.sha256()


@pytest.mark.parametrize(
    'changes',
    [
        {'measured': 'speeds'},
        {'load_known': True},
        {'delay_in_model': True},
        {'preview': True},
        {'output_weight': 0.5},
        {'final_weight': 1.0},
        {'move_weight': 0.1},
        {'move_weight': 0.0, 'torque_weight': 0.39},
    ],
)
def test_every_option_changes_the_run_and_none_breaks_it(changes):
    run = run_headless(SETTINGS, PREDICTIVE['mpc3'](ControllerContext(SETTINGS.known, changes)))
    usual = thesis_run('mpc3', 'detailed', 1.0).trajectory
    difference = run.torque_request - usual.torque_request
    assert np.abs(difference).max() > 0.05
    assert abs(rpm_from_rad_s(run.slip_speed[-1])) < 30.0
    assert dict(run.status[-1])['fallbacks'] == '0'


@pytest.mark.parametrize('wear_gain', [0.7, 1.3])
def test_wear_leaves_an_error_that_the_thesis_rates_bad(wear_gain):
    """Table 5.2: the model has no disturbance that could represent the wear."""
    slip_rpm = thesis_run('mpc3', 'detailed', wear_gain).slip_rpm[-1]
    assert abs(slip_rpm) > 10.0


def test_both_solvers_give_the_same_run():
    usual = thesis_run('mpc3', 'detailed', 1.0).trajectory
    osqp = PREDICTIVE['mpc3'](ControllerContext(SETTINGS.known, {'backend': 'osqp'}))
    run = run_headless(SETTINGS, osqp)
    difference = np.abs(usual.torque_request - run.torque_request).max()
    assert 0.0 < difference < 1e-2
    assert np.abs(usual.slip_speed - run.slip_speed).max() < 1e-3


def test_limits_of_the_request_hold_in_the_loop():
    options = {'highest_torque_n_m': 300.0, 'torque_rate_n_m_s': 1500.0}
    run = run_headless(SETTINGS, PREDICTIVE['mpc3'](ControllerContext(SETTINGS.known, options)))
    requests = run.torque_request[60:]
    assert requests.max() == pytest.approx(300.0, abs=1e-6)
    assert np.abs(np.diff(requests)).max() <= 15.0 + 1e-6


def test_the_first_reading_is_the_one_in_the_registry(readings_table):
    row = readings_table.rows[0]
    assert row[0] == 'mpc3'
    assert row[2:5] == cells(TABLE_5_1, thesis_run('mpc3', 'detailed', 1.0))


def test_unit_delay_and_signals_decide_and_none_of_the_readings_is_the_print(readings_table):
    """Sources: our runs; the first row's figures are those of the simulation above."""
    rows = {
        row[:2]: np.array(row[2:5], dtype=float) for row in readings_table.rows if '-' not in row
    }
    rows['MPC3', 'print'] = np.array(readings_table.rows[-1][2:5], dtype=float)
    ratio = {
        label: row / rows['MPC3', 'print'] for (name, label), row in rows.items() if name == 'mpc3'
    }
    drawn = ratio['as Figure 4.2 draws it']
    assert np.abs(ratio['as mpc_preview, Q per rad/s, reference held'] - 1.0).max() < 0.25
    assert drawn[1] > 1.9
    assert ratio['as mpc_preview'][1] > 2.0
    assert ratio['delay in its model'][1] < 0.95 * drawn[1]
    assert ratio['R on u'][1] < 0.85 * drawn[1]
    taken_over = ratio['C_fOL off from 0.6 s, its torque taken over']
    assert np.allclose(taken_over, drawn, atol=0.01)
    assert ratio['C_fOL off from 0.6 s, moves from 0'][1] > drawn[1]
    assert ratio['C_fOL on, unknown to it'][1] > 10.0
