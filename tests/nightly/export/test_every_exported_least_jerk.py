# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`least_jerk` as C: the same bits as in Python, in every packaged scenario."""

import numpy as np
import pytest
from support.exported_least_jerk import answers, in_c, settings_of

from ddct_bringup.benchmark.cases import Cases
from ddct_bringup.run.headless import run_headless
from ddct_controllers.least_jerk.controller import NAME, SPEC
from ddct_controllers.registry import make_controller

SCENARIOS = Cases.packaged().whole.values_of('scenario')


@pytest.mark.parametrize('scenario', SCENARIOS)
def test_c_gives_the_bits_of_python_in_every_packaged_scenario(tmp_path, scenario):
    for wear_gain in (0.7, 1.3):
        settings = settings_of(scenario, wear_gain)
        expected = run_headless(settings, NAME)
        found = run_headless(settings, in_c(settings, tmp_path / str(wear_gain)))
        assert found.torque_request.tobytes() == expected.torque_request.tobytes()
        assert np.ptp(expected.closed_loop_torque) > 1.0, 'this run asks nothing of it'


def test_the_linear_clutch_too(tmp_path):
    settings = settings_of('thesis', clutch='linear')
    expected = run_headless(settings, NAME)
    found = run_headless(settings, in_c(settings, tmp_path))
    assert found.torque_request.tobytes() == expected.torque_request.tobytes()


@pytest.mark.parametrize('scenario', ['launch', 'thesis', 'upshift'])
def test_any_measurements_give_the_bits_of_python(tmp_path, scenario):
    settings = settings_of(scenario)
    original = make_controller(SPEC, settings)
    copy = make_controller(in_c(settings, tmp_path), settings)
    for seed in range(20):
        assert answers(copy, seed) == answers(original, seed)


@pytest.mark.parametrize(
    'authority',
    [{}, {'deviation_n_m': 40.0, 'slew_n_m_s': 900.0, 'lag_s': 0.03, 'maximum_torque_n_m': 200.0}],
    ids=['full', 'limited'],
)
def test_the_shaped_demand_has_the_bits_of_python(tmp_path, authority):
    settings = settings_of('tip_in', engine_authority=authority)
    original = make_controller(SPEC, settings)
    copy = make_controller(in_c(settings, tmp_path), settings)
    for seed in range(10):
        found = answers(copy, seed)
        assert found == answers(original, seed)
        assert all(engine is not None for _, engine in found)
