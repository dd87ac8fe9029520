# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Predictive controllers of many runs give the torques of each one step by step."""

import numpy as np
import pytest

from ddct_bringup.batch.batchable import kind_of, why_not_batchable
from ddct_bringup.batch.controllers import Measured
from ddct_bringup.batch.run_batch import run_batch
from ddct_bringup.batch.simulate import simulate_batch
from ddct_bringup.campaign.rows import scored_headless
from ddct_bringup.run.headless import run_headless
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.from_python import chosen_from
from ddct_controllers.interface import Measurement
from ddct_controllers.mpc.qp.solvers import Daqp
from ddct_controllers.registry import make_controller
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

LIMITS = packaged_limits()
LIMITED = {'highest_torque_n_m': 220.0, 'torque_rate_n_m_s': 1500.0, 'lowest_slip_rpm': 0.0}
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
    ('mpc_wear', {}),
    ('mpc_wear', LIMITED),
    ('pedal_mpc', {}),
)
IDS = [f'{name}-{len(options)}' for name, options in VARIANTS]
RUNS, STEPS, START = 1000, 40, 10


def known(mass=1500.0):
    return KnownSettings(load_scenario('launch', {'vehicle.mass_kg': mass}))


@pytest.fixture(scope='module')
def recorded():
    """Return noisy signals of engagements that are followed badly: 1000 runs, 60 steps."""
    random = np.random.default_rng(53)
    step, ahead = np.arange(STEPS)[:, np.newaxis], np.arange(23)

    def noise(size):
        return random.normal(scale=size, size=(STEPS, RUNS))

    start = random.uniform(5.0, 60.0, RUNS)
    since = np.maximum(step[..., np.newaxis] + ahead - START, 0)
    references = np.maximum(start[:, np.newaxis] - 1.1 * since, 0.0)
    rates = np.where((references > 0.0) & (since > 0), -110.0, 0.0)
    slip = references[..., 0] + noise(0.3) + random.normal(scale=3.0, size=RUNS)
    shaft = random.uniform(20.0, 190.0, RUNS) + 0.3 * step
    torque, load = random.uniform(20.0, 300.0, RUNS) + noise(1.0), 60.0 + noise(5.0)
    on = np.repeat(step >= START, RUNS, axis=1)
    on[30:34, ::3] = False
    speeds = shaft + slip, shaft, shaft / 16.06 + noise(0.01), shaft / 50.0
    signals = (*speeds, torque, references, rates, load, 0.9 * torque - 20.0, on)
    return [Measured(at, *(each[at] for each in signals)) for at in range(STEPS)]


def part(measured, preview_steps, runs=slice(None)):
    """Return the signals of some runs with these preview steps."""
    points = slice(0, preview_steps + 1)
    values = [each[runs] for each in measured[1:]]
    values[5], values[6] = values[5][:, points], values[6][:, points]
    return Measured(measured.step, *values)


def stacked_torques(controllers, recorded, runs=slice(None)):
    stack = kind_of(controllers[0]).of(controllers, [known()] * len(controllers))
    steps = controllers[0].preview_steps
    return np.array([stack.update(part(each, steps, runs)) for each in recorded])


def single_torques(controller, recorded, run):
    """Return the torques step by step and the last status."""
    controller.reset()
    torques, status = [], ()
    for each in recorded:
        *values, on = (value[run].tolist() for value in part(each, controller.preview_steps)[1:])
        measurement = Measurement(each.step, *values)
        if on:
            command = controller.update(measurement)
            status = command.status
        else:
            controller.hold(measurement)
        torques.append(command.clutch_torque if on else 0.0)
    return np.array(torques), dict(status)


@pytest.mark.parametrize(('name', 'options'), VARIANTS, ids=IDS)
def test_torques_are_those_step_by_step_and_independent_of_other_runs(name, options, recorded):
    controller = make_controller(name, known(), options)
    together = stacked_torques([controller] * RUNS, recorded)
    for run in (0, 1, 2, 33, 500, 999):
        expected, status = single_torques(controller, recorded, run)
        assert status['fallbacks'] == '0'
        largest = np.abs(expected).max()
        assert together[:, run] == pytest.approx(expected, rel=0.0, abs=1e-9 * largest)
    for first, count in ((0, 1), (5, 1), (0, 2), (0, 3), (7, 33)):
        runs = slice(first, first + count)
        alone = stacked_torques([controller] * count, recorded, runs)
        assert alone.tolist() == together[:, runs].tolist()


@pytest.mark.parametrize(('name', 'options'), VARIANTS, ids=IDS)
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


WHOLE = [
    *((name, options, 'thesis', {}, 'detailed') for name, options in VARIANTS),
    ('mpc3', {}, 'thesis', {}, 'base'),
    ('mpc_preview', {}, 'thesis', {'reference.shape': 'tanh'}, 'feedforward'),
    ('mpc_wear', {}, 'thesis', {'equilibrium': 'full', 'actuator.delay_s': 0.023}, 'detailed'),
]


@pytest.mark.parametrize(('name', 'options', 'scenario', 'changes', 'architecture'), WHOLE)
def test_whole_runs_are_those_step_by_step(name, options, scenario, changes, architecture):
    """Every value is within 1e-9 of the peak of its signal, and every state the same."""
    runs = runs_of(name, options, scenario, changes, architecture)
    assert {why_not_batchable(*run) for run in runs} == {''}
    settings, controllers = zip(*runs, strict=True)
    stack = kind_of(controllers[0]).of(controllers, [each.known for each in settings])
    trajectory = simulate_batch(settings, stack, controllers[0].preview_steps).trajectory
    for index, ours in enumerate(run_batch(runs, LIMITS)):
        controller = controllers[index]
        expected = scored_headless(settings[index], chosen_from(controller, 'same'), LIMITS)
        assert ours is not None
        assert (ours.state, ours.why, ours.fallbacks) == (expected.state, expected.why, 0)
        assert expected.fallbacks == 0
        controller.reset()
        single = run_headless(settings[index], controller)
        for signal, values in trajectory.signals.items():
            theirs = getattr(single, signal)
            theirs = theirs[:, :1] if signal == 'slip_reference' else theirs
            largest = 1e-9 * np.abs(theirs).max()
            assert values[index] == pytest.approx(theirs, rel=0.0, abs=largest), signal
