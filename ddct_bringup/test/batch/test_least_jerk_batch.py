# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`least_jerk` of many runs gives the torques of each one step by step."""

import numpy as np
import pytest
from many_controllers import assert_step_by_step, known, single_torques, stacked_torques
from samples import sampled

from ddct_bringup.batch.batchable import kind_of
from ddct_bringup.batch.controllers.interface import Measured
from ddct_controllers.registry import make_controller
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

pytestmark = pytest.mark.slow
RUNS, STEPS = 60, 260


@pytest.fixture(scope='module')
def walks():
    """Return signals that wander without relation, so that plates lock, part and pass zero."""
    random = np.random.default_rng(5)

    def walk(size, start):
        return start + np.cumsum(random.normal(scale=size, size=(STEPS, RUNS)), axis=0)

    slip = walk(1.0, random.uniform(-2.0, 30.0, RUNS)) * np.where(np.arange(RUNS) % 2, 1.0, 0.1)
    shaft, torque = walk(0.5, random.uniform(0.0, 100.0, RUNS)), walk(5.0, 100.0)
    references = np.maximum(walk(0.5, random.uniform(0.0, 30.0, RUNS)), 0.0)[..., np.newaxis]
    on = np.ones((STEPS, RUNS), dtype=bool)
    on[:15] = on[120:130, ::3] = False
    signals = (
        *(shaft + slip, shaft, shaft / 16.0, shaft / 50.0, torque),
        *(references, walk(5.0, -50.0)[..., np.newaxis], walk(2.0, 60.0), walk(5.0, 80.0), on),
    )
    return [Measured(at, *(each[at] for each in signals)) for at in range(STEPS)]


@pytest.mark.parametrize('scenario', sampled(['thesis', 'launch', 'upshift_2_3'], every=3))
def test_torques_are_those_step_by_step_and_independent_of_other_runs(scenario, walks):
    controllers = [
        make_controller('least_jerk', known(1300.0 + 100.0 * (run % 4), scenario))
        for run in range(RUNS)
    ]
    assert len({kind_of(each).key(each) for each in controllers}) == 1
    together = stacked_torques(controllers, walks)
    phases = set()
    for run in range(0, RUNS, 5):
        expected, status = single_torques(controllers[run], walks, run)
        phases.add(status['phase'])
        largest = np.abs(expected).max()
        assert together[:, run] == pytest.approx(expected, rel=0.0, abs=1e-9 * largest)
    assert phases >= {'slipping', 'closed'}
    for first, count in ((0, 1), (0, 2), (0, 3), (7, 33)):
        runs = slice(first, first + count)
        alone = stacked_torques(controllers[runs], walks, runs)
        assert alone.tolist() == together[:, runs].tolist()


@pytest.mark.parametrize(
    ('delay_s', 'bandwidth'), sampled([(0.013, 0.7), (0.0, 1.0), (0.03, 1.0)], every=3)
)
def test_actuators_may_have_any_delay_and_bandwidth(delay_s, bandwidth, walks):
    changes = {'actuator.delay_s': delay_s, 'actuator.bandwidth_factor': bandwidth}
    settings = KnownSettings(load_scenario('launch', changes))
    controller = make_controller('least_jerk', settings)
    together = stacked_torques([controller] * RUNS, walks)
    for run in range(0, RUNS, 13):
        expected, _ = single_torques(controller, walks, run)
        largest = np.abs(expected).max()
        assert together[:, run] == pytest.approx(expected, rel=0.0, abs=1e-9 * largest)


def test_a_number_that_the_controller_refuses_gives_none(walks):
    controller = make_controller('least_jerk', known())
    short = walks[:60]
    usual = stacked_torques([controller] * 3, short, slice(0, 3))
    changed = [each._replace(load_torque=each.load_torque.copy()) for each in short]
    changed[30].load_torque[1] = -2e9
    torques = stacked_torques([controller] * 3, changed, slice(0, 3))
    assert np.isnan(torques[30:, 1]).all()
    assert torques[:, [0, 2]].tolist() == usual[:, [0, 2]].tolist()


@pytest.mark.parametrize(
    ('scenario', 'changes'),
    sampled(
        [
            ('thesis', {}),
            ('thesis', {'equilibrium': 'full'}),
            ('launch', {}),
            ('launch_hill', {'actuator.delay_s': 0.023}),
            ('launch_hot', {'sensors.engine_speed.noise_rad_s': 0.1}),
            ('upshift_2_3', {}),
        ],
        every=3,
    ),
)
def test_whole_runs_are_those_step_by_step(scenario, changes):
    runs = []
    for index in range(3):
        described = {**changes, 'vehicle.mass_kg': 1400.0 + 100.0 * index}
        settings = RunSettings(
            KnownSettings(load_scenario(scenario, described)),
            CaseSettings(wear_gain=0.8 + 0.2 * index),
        )
        runs.append((settings, make_controller('least_jerk', settings.known)))
    assert_step_by_step(runs)
