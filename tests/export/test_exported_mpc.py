# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Exported predictive controllers in the loop, in place of their Python originals."""

import dataclasses
from typing import Any

import numpy as np
import pytest
from other_actuators import BETWEEN, FAST, SLOW, keys_of
from support.exported_checks import (
    compare_exported,
    require_binding_limits,
    require_exported_authority,
    require_exported_options,
    require_levels_that_give_way,
)
from support.exported_loops import CONTROL_STARTS, compare_loops, pairs
from support.exported_mpc import exported, run_settings

from ddct_bringup.run.headless import run_headless
from ddct_controllers.mpc.controller import MpcController
from ddct_controllers.mpc.program.settings import MpcSettings
from ddct_controllers.registry import make_controller


@pytest.mark.parametrize('name', ['mpc2', 'mpc_preview', 'mpc_torsion'])
def test_the_c_gives_the_torques_of_the_original(tmp_path, name):
    settings = run_settings(architecture='feedforward', wear=0.7)
    compare_exported(name, settings, tmp_path / 'c')


@pytest.mark.parametrize('actuator', [SLOW, FAST, BETWEEN])
def test_the_model_of_another_actuator_is_exported(tmp_path, actuator):
    """Two requests wait, none or one acts for a part of the period."""
    changes = [f'{key}={value}' for key, value in keys_of(actuator).items()]
    compare_exported('mpc_preview', run_settings(*changes), tmp_path / 'c')


@pytest.mark.parametrize(
    'options',
    [
        ('measured=speeds',),
        ('load_known=true', 'delay_in_model=true', 'torque_weight=0.39', 'move_weight=0'),
    ],
)
def test_options_of_observer_and_cost_are_exported(tmp_path, options):
    require_exported_options('mpc3', tmp_path / 'c', *options)


@pytest.mark.parametrize('name', ['mpc3', 'mpc4'])
def test_binding_limits_of_torque_and_rate_give_the_same_torques(tmp_path, name):
    require_binding_limits(name, tmp_path / 'c')


@pytest.mark.parametrize(
    'changes',
    [
        ('engine_authority.lag_s=0.1', 'engine_authority.minimum_torque_n_m=100'),
        ('controllers.mpc4.control_steps=3', 'engine_authority.slew_n_m_s=100'),
    ],
)
def test_the_engines_authority_is_exported(tmp_path, changes):
    require_exported_authority(tmp_path / 'c', changes)


@pytest.mark.parametrize('changes', [{'control_steps': 1}, {'preview': True}, {'limits': True}])
def test_short_plans_preview_and_soft_limits_are_exported(tmp_path, changes):
    settings = run_settings()
    original: Any = make_controller('mpc3', settings.known)
    chosen = original.settings
    if changes.pop('limits', False):
        # Slip may not fall below 30 rad/s, which costs against the reference that goes to 0.
        outputs = (dataclasses.replace(chosen.outputs[0], lowest=30.0, highest=200.0),)
        changes = {'outputs': outputs, 'soft_limit_weight': 50.0}
    changed = rebuilt(original, dataclasses.replace(chosen, **changes))
    run = compare_loops(changed, exported(changed, 'mpc3', settings, tmp_path / 'c'), settings)
    other = run_headless(settings, make_controller('mpc3', settings.known))
    assert np.abs(run.torque_request - other.torque_request).max() > 1.0


def rebuilt(controller: MpcController, settings: MpcSettings) -> MpcController:
    """Return the controller with other settings and the same observer."""
    observer = controller.observer
    return MpcController(observer.model, observer, settings)


def test_levels_give_way_to_the_rate_as_in_the_original(tmp_path):
    require_levels_that_give_way('mpc4', tmp_path / 'c')


def test_the_lowest_slip_is_exported(tmp_path):
    require_exported_options('mpc3', tmp_path / 'c', 'lowest_slip_rpm=100')


def test_the_iteration_limit_is_the_static_bound(tmp_path):
    """With a limit of one change the bound holds, and the plan keeps the rate before the level."""
    section = 'controllers.mpc3'
    settings = run_settings(
        f'{section}.iteration_limit=1',
        f'{section}.torque_rate_n_m_s=100',
        f'{section}.highest_torque_n_m=200',
    )
    original = make_controller('mpc3', settings.known)
    in_c = exported(original, 'mpc3', settings, tmp_path / 'c')
    assert '#define DDCT_MPC_ITERATIONS 1\n' in (tmp_path / 'c' / 'ddct_mpc.h').read_text()
    run = run_headless(settings, in_c)
    assert 'iteration limit' in pairs(run, 'qp_status')
    assert set(pairs(run, 'qp_iterations')) <= {None, '0', '1'}
    request = run.torque_request[CONTROL_STARTS - 1 :]
    assert np.abs(np.diff(request)).max() <= 1.0 + 1e-9
    assert request[-1] <= 200.0 + 1e-9


def test_a_reset_controller_repeats_a_new_one_to_the_bit(tmp_path):
    settings = run_settings()
    in_c = exported(make_controller('mpc3', settings.known), 'mpc3', settings, tmp_path / 'c')
    first = run_headless(settings, in_c).torque_request
    in_c.reset()
    assert run_headless(settings, in_c).torque_request.tobytes() == first.tobytes()
