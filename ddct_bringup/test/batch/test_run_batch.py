# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A batch gives the results of each run step by step, independent of the other runs in it."""

import dataclasses
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from ddct_bringup.batch.batchable import why_not_batchable
from ddct_bringup.batch.run_batch import run_batch
from ddct_bringup.batch.simulate import simulate_batch
from ddct_bringup.batch.stacks import by_run, product
from ddct_bringup.campaign.rows import scored_headless
from ddct_bringup.run.headless import run_headless
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.from_python import chosen_from
from ddct_controllers.linear import LinearController, PiController
from ddct_controllers.registry import make_controller, own_controller_names
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import StateSpace
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.scenario.choices.settings import ARCHITECTURES
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

SHORT = {'duration_s': 1.2, 'control_start_s': 0.2, 'score_window_s': [0.2, 1.1]}
LIMITS = packaged_limits()


def test_the_order_of_the_numbers_of_a_model_in_memory_changes_no_bit():
    random = np.random.default_rng(4)
    a = 0.3 * random.normal(size=(4, 4))
    b, c, d = random.normal(size=(4, 1)), random.normal(size=(1, 4)), np.ones((1, 1))
    by_column = [np.asfortranarray(np.block([[a, b], [c, d]]))]
    errors = random.normal(size=200)

    def torques(matrices, places):
        states = np.zeros((len(places), 5))
        found = []
        for error in errors:
            states[:, -1] = error
            following = product(by_run(matrices, np.array(places)), states)
            states[:, :-1] = following[:, :-1]
            found.append(following[0, -1])
        return found

    beside = [*by_column, np.block([[0.5 * a, b], [c, d]])]
    assert torques(by_column, [0]) == torques(beside, [0, 1])


def scenario(random, **changes):
    """Return a scenario with a different value of every number that a campaign may vary."""

    def times(size):
        return float(random.uniform(1.0 - size, 1.0 + size))

    driveline = {
        f'driveline.{name}': value * times(0.2)
        for name, value in DrivelineParameters().values().items()
        if name not in ('vehicle_inertia', 'total_ratio')  # the mass and the gearbox give these
    }
    slope = {'time_s': [0.0, 0.9], 'slope_rad': random.uniform(-0.1, 0.1, 2).tolist()}
    own = {
        **SHORT,
        **driveline,
        'gearbox.measured_ratios': [9.3416 * times(0.2)],
        'driveline.engine_damping': 0.02 * times(0.5),
        'vehicle.mass_kg': 1500.0 * times(0.3),
        'load.wind_speed_m_s': float(random.uniform(-15.0, 15.0)),
        'engine': {'time_s': [0.0, 0.1, 0.5], 'torque_n_m': random.uniform(20, 300, 3).tolist()},
        'initial.engine_speed_rad_s': 160.0 * times(0.2),
        'reference.slope_rad_s2': 200.0 * times(0.5),
        'reference.reference_end_s': round(float(random.uniform(0.5, 1.3)), 2),
        'actuator.delay_s': int(random.integers(0, 35)) / 1000,
        **({'actuator.bandwidth_factor': times(0.5)} if random.random() < 0.3 else {}),
        **({'slope': slope} if random.random() < 0.5 else {}),
        **changes,
    }
    if own.get('reference.shape') == 'profile':
        own['slip_reference'] = {'time_s': [0.2, 1.0], 'slip_rad_s': [30.0 * times(1.0), 0.0]}
    return load_scenario('thesis', own)


def runs_of_every_kind():
    """Return a run of every linear controller, and of every architecture and shape."""
    random = np.random.default_rng(15)
    plain = RunSettings(KnownSettings(load_scenario('thesis')))
    runs = []
    for name in own_controller_names():
        controller = make_controller(name, plain.known)
        if controller.linear_model() is not None:
            settings = RunSettings(
                KnownSettings(scenario(random)),
                CaseSettings(wear_gain=float(random.uniform(0.5, 2.5))),
            )
            runs.append((settings, controller))
    for architecture in ARCHITECTURES:
        shapes = ('ramp', 'tanh', 'polynomial', 'profile')
        for index, shape in enumerate(shapes[:1] if 'tanh' in architecture else shapes):
            equilibrium = ('thesis', 'full')[index % 2]
            described = scenario(random, **{'reference.shape': shape, 'equilibrium': equilibrium})
            settings = RunSettings(
                KnownSettings(described, architecture),
                CaseSettings(wear_gain=float(random.uniform(0.4, 2.8))),
            )
            runs += [(settings, make_controller(name, settings.known)) for name in ('pi', 'ls3')]
    return runs


@pytest.fixture(scope='module')
def runs():
    found = runs_of_every_kind()
    # Here, as a run step by step gives its controller another name.
    assert len({controller.registered_name for _, controller in found}) >= 14
    return found


@pytest.fixture(scope='module')
def batch(runs):
    return run_batch(runs, LIMITS)


@pytest.fixture(scope='module')
def serial(runs):
    return [step_by_step(*run) for run in runs]


def step_by_step(settings, controller):
    return scored_headless(settings, chosen_from(controller, 'same'), LIMITS)


def assert_close(values, expected):
    assert values.keys() == expected.keys()
    for name, value in expected.items():
        if value is None:
            assert values[name] is None, name
        else:
            assert values[name] == pytest.approx(value, rel=1e-9, abs=0.0), name


def test_every_run_can_be_in_a_batch(runs):
    assert {why_not_batchable(*run) for run in runs} == {''}


def test_figures_and_metrics_are_those_of_the_run_step_by_step(batch, serial):
    for ours, expected in zip(batch, serial, strict=True):
        assert_close(ours.metrics, expected.metrics)


def test_states_and_limits_are_those_of_the_run_step_by_step(batch, serial):
    for ours, expected in zip(batch, serial, strict=True):
        assert (ours.valid, ours.reason) == (expected.valid, expected.reason)
        assert (ours.state, ours.why) == (expected.state, expected.why)
        for limit, other in zip(ours.limits, expected.limits, strict=True):
            assert limit == replace(other, value=limit.value)
            assert limit.value == ours.metrics[limit.name]


def test_the_runs_are_of_many_kinds(serial):
    states = Counter(result.state for result in serial)
    assert states.keys() == {'engaged', 'not_engaged'}
    crossed = Counter(result.metrics['engagement_time_s'] is None for result in serial)
    assert min(crossed[True], crossed[False]) >= 5


def test_a_result_does_not_depend_on_the_rest_of_the_batch(runs, batch):
    assert run_batch(runs[::-1], LIMITS)[::-1] == batch
    for index in range(0, len(runs), 9):
        assert run_batch([runs[index]], LIMITS) == [batch[index]]


def test_whole_trajectories_are_those_of_the_run_step_by_step():
    random = np.random.default_rng(1)
    settings = [
        RunSettings(KnownSettings(scenario(random)), CaseSettings(wear_gain=0.8 + 0.2 * i))
        for i in range(3)
    ]
    runs = [(each, make_controller('ls8', each.known)) for each in settings]
    stack = simulate_batch(settings, [controller for _, controller in runs]).trajectory
    for index, (each, controller) in enumerate(runs):
        controller.reset()
        expected = run_headless(each, controller)
        assert stack.torque_demand[index].tolist() == expected.torque_demand.tolist()
        for name, values in stack.signals.items():
            ours, theirs = values[index], getattr(expected, name)
            assert ours.shape == theirs.shape
            assert ours == pytest.approx(theirs, rel=1e-9, abs=1e-10 * np.abs(theirs).max()), name


def test_a_controller_may_be_used_in_many_runs_and_before_the_batch():
    settings = RunSettings(KnownSettings(load_scenario('thesis', SHORT)))
    controller = make_controller('ls3', settings.known)
    fresh = run_batch([(settings, controller)], LIMITS)
    run_headless(settings, controller)
    assert run_batch([(settings, controller)] * 3, LIMITS) == 3 * fresh


def test_every_run_is_scored_over_its_own_window():
    windows = ([0.2, 0.7], [0.3, 1.1], [0.2, 1.1])
    runs = []
    for window in windows:
        settings = RunSettings(
            KnownSettings(load_scenario('thesis', {**SHORT, 'score_window_s': window}))
        )
        runs.append((settings, make_controller('ls8', settings.known)))
    together = run_batch(runs, LIMITS)
    for ours, run in zip(together, runs, strict=True):
        expected = step_by_step(*run)
        assert_close(ours.metrics, expected.metrics)
    assert len({each.metrics['torsion_speed_std_rpm'] for each in together}) == len(windows)


def test_a_run_that_grows_beyond_all_numbers_has_no_result():
    settings = RunSettings(KnownSettings(load_scenario('thesis', SHORT)))
    one = np.ones((1, 1))
    wild = LinearController(StateSpace(1e4 * one, 1e3 * one, 1e3 * one, 0.0 * one, PERIOD_S))
    calm = PiController(0.1, 0.1)
    none, counts = run_batch([(settings, wild), (settings, calm)], LIMITS)
    assert none is None
    assert [counts] == run_batch([(settings, calm)], LIMITS)


def test_a_run_in_which_rounding_grows_has_no_result():
    changes = {'vehicle.mass_kg': 1534.985199772065, 'actuator.delay_s': 0.003, 'gear': 5}
    changes |= {'load.slope_rad': -0.027073904265832754}
    changes |= {'driveline.halfshaft_stiffness': 10541.593582404965}
    scenario = load_scenario('thesis', changes)
    settings = RunSettings(
        KnownSettings(scenario, architecture='base'), CaseSettings(wear_gain=1.6112888721496896)
    )
    swinging, moved = (PiController(gain, 0.1) for gain in (20.0, 20.0 * (1.0 + 1e-15)))
    runs = [run_headless(settings, each).slip_speed for each in (swinging, moved)]
    assert np.abs(runs[0] - runs[1]).max() > 1.0, 'the run is not chaotic'
    calm = PiController(0.1, 0.1)
    none, counts = run_batch([(settings, swinging), (settings, calm)], LIMITS)
    assert none is None
    assert [counts] == run_batch([(settings, calm)], LIMITS)


def test_a_run_that_cannot_be_built_leaves_the_others_alone():
    settings = RunSettings(KnownSettings(load_scenario('thesis', SHORT)))
    weightless = dataclasses.replace(settings.scenario.given_driveline, shaft_inertia=1e-310)
    odd = RunSettings(
        KnownSettings(dataclasses.replace(settings.scenario, given_driveline=weightless))
    )
    controller = PiController(0.1, 0.1)
    runs = [(settings, controller), (odd, controller), (settings, controller)]
    first, none, last = run_batch(runs, LIMITS)
    assert none is None
    assert [first] == [last] == run_batch(runs[:1], LIMITS)
