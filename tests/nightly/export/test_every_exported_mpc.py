# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every exported predictive controller, with every option, in the loop beside its original."""

import dataclasses

import numpy as np
import pytest
from support.exported_loops import CONTROL_STARTS, EXPORTABLE, compare_loops, pairs
from support.exported_mpc import exported, run_settings

from ddct_bringup.run.headless import run_headless
from ddct_controllers.registry import make_controller
from ddct_plant.scenario.settings import ARCHITECTURES


@pytest.mark.parametrize('name', EXPORTABLE)
def test_the_c_gives_the_torques_of_the_original(tmp_path, name):
    settings = run_settings()
    original = make_controller(name, settings)
    in_c = exported(original, name, settings, tmp_path / 'c')
    for wear in (0.7, 1.0, 1.3):
        for controller in (original, in_c):
            controller.reset()
        compare_loops(original, in_c, dataclasses.replace(settings, wear_gain=wear))


@pytest.mark.parametrize('architecture', ARCHITECTURES)
def test_it_does_so_in_every_architecture(tmp_path, architecture):
    settings = run_settings(architecture=architecture)
    original = make_controller('mpc3', settings)
    compare_loops(original, exported(original, 'mpc3', settings, tmp_path / 'c'), settings)


@pytest.mark.parametrize(
    'options',
    [
        ('measured=speeds',),
        ('load_known=true', 'delay_in_model=true'),
        ('output_weight=0.1', 'final_weight=1', 'move_weight=0.1'),
        ('torque_weight=0.39', 'move_weight=0'),
    ],
)
def test_options_of_observer_and_cost_are_exported(tmp_path, options):
    settings = run_settings(*(f'controllers.mpc3.{option}' for option in options))
    original = make_controller('mpc3', settings)
    run = compare_loops(original, exported(original, 'mpc3', settings, tmp_path / 'c'), settings)
    other = run_headless(run_settings(), 'mpc3')
    assert np.abs(run.torque_request - other.torque_request).max() > 0.5


@pytest.mark.parametrize('name', EXPORTABLE)
def test_binding_limits_of_torque_and_rate_give_the_same_torques(tmp_path, name):
    free = run_headless(run_settings(), name).torque_request[CONTROL_STARTS:]
    highest = float(np.quantile(free, 0.8))
    rate = 0.5 * 100.0 * float(np.abs(np.diff(free)).max())
    section = f'controllers.{name}'
    settings = run_settings(
        f'{section}.highest_torque_n_m={highest}', f'{section}.torque_rate_n_m_s={rate}'
    )
    original = make_controller(name, settings)
    in_c = exported(original, name, settings, tmp_path / 'c')
    request = compare_loops(original, in_c, settings).torque_request[CONTROL_STARTS:]
    at_highest = np.isclose(request, highest, atol=1e-6)
    at_rate = np.isclose(np.abs(np.diff(request)), rate / 100.0, atol=1e-6)
    assert at_highest.any()
    assert at_rate.any()


@pytest.mark.parametrize(
    'changes',
    [
        ('engine_authority.deviation_n_m=20', 'engine_authority.slew_n_m_s=300'),
        ('engine_authority.lag_s=0.1', 'engine_authority.minimum_torque_n_m=100'),
        ('controllers.mpc4.control_steps=3', 'engine_authority.slew_n_m_s=100'),
        ('engine_authority.slew_n_m_s=50', 'controllers.mpc4.torque_rate_n_m_s=40'),
    ],
)
def test_the_engines_authority_is_exported(tmp_path, changes):
    settings = run_settings(*changes)
    original = make_controller('mpc4', settings)
    run = compare_loops(original, exported(original, 'mpc4', settings, tmp_path / 'c'), settings)
    free = run_headless(run_settings(), 'mpc4')
    assert np.abs(run.engine_torque - free.engine_torque).max() > 1.0


@pytest.mark.parametrize('name', ['mpc2', 'mpc3', 'mpc4'])
def test_levels_give_way_to_the_rate_as_in_the_original(tmp_path, name):
    """The open loop starts above the highest torque, farther than the rate returns at once."""
    section = f'controllers.{name}'
    settings = run_settings(
        f'{section}.highest_torque_n_m=240',
        f'{section}.torque_rate_n_m_s=100',
        f'{section}.control_steps=3',
    )
    original = make_controller(name, settings)
    run = compare_loops(original, exported(original, name, settings, tmp_path / 'c'), settings)
    request = run.torque_request[CONTROL_STARTS - 1 :]
    assert request[0] > 270.0
    assert request[-1] <= 240.0 + 1e-6
    assert np.abs(np.diff(request)).max() <= 1.0 + 1e-6
    assert set(pairs(run, 'qp_status')) == {None, 'solved'}


@pytest.mark.parametrize('slip', [0, 100])
@pytest.mark.parametrize('name', ['mpc3', 'mpc4'])
def test_the_lowest_slip_is_exported(tmp_path, name, slip):
    settings = run_settings(f'controllers.{name}.lowest_slip_rpm={slip}')
    original = make_controller(name, settings)
    run = compare_loops(original, exported(original, name, settings, tmp_path / 'c'), settings)
    other = run_headless(run_settings(), name)
    assert np.abs(run.torque_request - other.torque_request).max() > 0.5
