# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Predictive controllers of many runs give the torques of each one step by step."""

import numpy as np
import pytest
from many_controllers import (
    RUNS,
    STEPS,
    assert_step_by_step,
    known,
    recorded_engagements,
    single_torques,
    stacked_torques,
)
from samples import sampled

from ddct_bringup.batch.batchable import kind_of
from ddct_bringup.batch.controllers.predictive import PredictiveControllers
from ddct_bringup.batch.run_batch import run_batch
from ddct_bringup.run.headless import run_headless
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.mpc.qp.solvers import Daqp
from ddct_controllers.registry import make_controller
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

pytestmark = pytest.mark.slow
LIMITS = packaged_limits()
LIMITED = {'highest_torque_n_m': 220.0, 'torque_rate_n_m_s': 1500.0, 'lowest_slip_rpm': 30.0}
VARIANTS: tuple[tuple[str, dict], ...] = (
    ('mpc1', {}),
    ('mpc2', {}),
    ('mpc3', {}),
    ('mpc3', {'preview': True, 'actuator_in_model': 'known', 'delay_in_model': True}),
    ('mpc3', LIMITED),
    ('mpc_preview', {}),
    ('mpc_preview', {'load_known': False, 'preview': False}),
    ('mpc_offset_free', LIMITED),
    ('mpc_torsion', {}),
    ('mpc_wear', LIMITED),
    ('mpc_wear', {}),
)
IDS = [f'{name}-{len(options)}' for name, options in VARIANTS]


@pytest.fixture(scope='module')
def recorded():
    return recorded_engagements()


@pytest.mark.parametrize(('name', 'options'), sampled(VARIANTS, every=4), ids=IDS)
def test_torques_are_those_step_by_step_and_independent_of_other_runs(name, options, recorded):
    controller = make_controller(name, known(), options)
    together = stacked_torques([controller] * RUNS, recorded)
    for run in (0, 1, 2, 33, 100, 199):
        expected, status = single_torques(controller, recorded, run)
        assert status['fallbacks'] == '0'
        largest = np.abs(expected).max()
        assert together[:, run] == pytest.approx(expected, rel=0.0, abs=1e-9 * largest)
    for first, count in ((0, 1), (5, 1), (0, 2), (0, 3), (7, 33)):
        runs = slice(first, first + count)
        alone = stacked_torques([controller] * count, recorded, runs)
        assert alone.tolist() == together[:, runs].tolist()


@pytest.mark.parametrize(('name', 'options'), sampled(VARIANTS, every=3), ids=IDS)
def test_every_run_may_have_a_model_of_its_own(name, options, recorded):
    controllers = [make_controller(name, known(1200.0 + 50.0 * i), options) for i in range(6)]
    assert len({kind_of(each).key(each) for each in controllers}) == 1
    torques = stacked_torques(controllers, recorded, slice(0, 6))
    for run, controller in enumerate(controllers):
        expected, _ = single_torques(controller, recorded, run)
        largest = np.abs(expected).max()
        assert torques[:, run] == pytest.approx(expected, rel=0.0, abs=1e-9 * largest)
        alone = stacked_torques([controller], recorded, slice(run, run + 1))
        assert alone[:, 0].tolist() == torques[:, run].tolist()


def test_rows_at_their_bounds_are_left_to_the_solver(recorded, monkeypatch):
    controller = make_controller('mpc3', known(), LIMITED)
    solved, solve = [], Daqp.solve

    def counted(*program):
        solved.append(program)
        return solve(*program)

    monkeypatch.setattr(Daqp, 'solve', counted)
    stacked_torques([controller] * 100, recorded, slice(0, 100))
    assert 0.1 * 100 * STEPS < len(solved) < 0.99 * 100 * STEPS
    solved.clear()
    stacked_torques([make_controller('mpc3', known())] * 100, recorded, slice(0, 100))
    assert len(solved) < 0.02 * 100 * STEPS


def test_a_number_that_the_controller_refuses_gives_none(recorded):
    controller = make_controller('mpc3', known())
    usual = stacked_torques([controller] * 3, recorded, slice(0, 3))
    recorded = [each._replace(engine_speed=each.engine_speed.copy()) for each in recorded]
    recorded[20].engine_speed[1] = 2e9
    torques = stacked_torques([controller] * 3, recorded, slice(0, 3))
    assert np.isnan(torques[20:30, 1]).all()
    assert torques[:, [0, 2]].tolist() == usual[:, [0, 2]].tolist()


def runs_of(name, options, scenario, changes, architecture='detailed'):
    """Return three runs with different wear, mass and controllers' cars."""
    runs = []
    for index in range(3):
        described = {**changes, 'vehicle.mass_kg': 1400.0 + 100.0 * index}
        settings = RunSettings(
            KnownSettings(load_scenario(scenario, described), architecture),
            CaseSettings(wear_gain=0.8 + 0.2 * index),
        )
        runs.append((settings, make_controller(name, settings.known, options)))
    return runs


WHOLE: list[tuple[str, dict, str, dict, str]] = [
    *((name, options, 'thesis', {}, 'detailed') for name, options in VARIANTS),
    ('mpc3', {}, 'thesis', {}, 'base'),
    ('mpc_preview', {}, 'thesis', {'reference.shape': 'tanh'}, 'feedforward'),
    ('mpc_wear', {}, 'thesis', {'equilibrium': 'full', 'actuator.delay_s': 0.023}, 'detailed'),
    ('mpc3', {}, 'launch', {}, 'detailed'),
    ('mpc_preview', LIMITED, 'launch', {}, 'detailed'),
    ('mpc_offset_free', {}, 'launch_hill', {}, 'detailed'),
    ('mpc_wear', {}, 'launch_hot', {'sensors.engine_speed.noise_rad_s': 0.1}, 'detailed'),
    ('mpc_wear', {}, 'upshift_2_3', {}, 'detailed'),
    ('mpc3', {}, 'upshift_light', {}, 'detailed'),
]


@pytest.mark.parametrize(
    ('name', 'options', 'scenario', 'changes', 'architecture'), sampled(WHOLE, every=3)
)
def test_whole_runs_are_those_step_by_step(name, options, scenario, changes, architecture):
    assert_step_by_step(runs_of(name, options, scenario, changes, architecture))


@pytest.mark.parametrize('scenario', sampled(['thesis', 'launch'], every=2))
def test_a_run_whose_program_has_no_solution_has_no_result(scenario, monkeypatch):
    runs = runs_of('mpc3', LIMITED, scenario, {})
    usual = run_batch(runs, LIMITS)
    assert None not in usual
    solved = PredictiveControllers._solved

    def unsolved(self, run, *program):
        return np.nan if run == 1 else solved(self, run, *program)

    monkeypatch.setattr(PredictiveControllers, '_solved', unsolved)
    assert run_batch(runs, LIMITS) == [usual[0], None, usual[2]]


def test_a_run_that_swings_between_its_limits_has_no_result_as_rounding_grows():
    """Moves that cost nearly nothing over a short horizon make a limit cycle."""
    options = {'prediction_steps': 13, 'move_weight': 0.06}
    options |= {'highest_torque_n_m': 200.0, 'torque_rate_n_m_s': 3200.0}
    settings = KnownSettings(load_scenario('launch_gentle'))
    swinging = make_controller('mpc3', settings, options)
    worn, moved = (RunSettings(settings, CaseSettings(wear_gain=w)) for w in (0.66, 0.66 + 7e-14))
    slips = []
    for each in (worn, moved):
        swinging.reset()
        slips.append(run_headless(each, swinging).slip_speed)
    assert np.abs(slips[0] - slips[1]).max() > 1e-3, 'the run is not chaotic'
    calm = make_controller('mpc3', settings)
    none, counts = run_batch([(worn, swinging), (worn, calm)], LIMITS)
    assert none is None
    assert [counts] == run_batch([(worn, calm)], LIMITS)
