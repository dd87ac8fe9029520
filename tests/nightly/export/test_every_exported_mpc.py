# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every exported predictive controller, with every option, in the loop beside its original."""

import dataclasses

import pytest
from support.exported_checks import (
    compare_exported,
    require_binding_limits,
    require_exported_authority,
    require_exported_options,
    require_levels_that_give_way,
)
from support.exported_loops import EXPORTABLE, compare_loops
from support.exported_mpc import exported, run_settings

from ddct_controllers.registry import make_controller
from ddct_plant.scenario.choices.settings import ARCHITECTURES
from ddct_plant.scenario.settings import CaseSettings


@pytest.mark.parametrize('name', EXPORTABLE)
def test_the_c_gives_the_torques_of_the_original(tmp_path, name):
    settings = run_settings()
    original = make_controller(name, settings.known)
    in_c = exported(original, name, settings, tmp_path / 'c')
    for wear in (0.7, 1.0, 1.3):
        for controller in (original, in_c):
            controller.reset()
        compare_loops(
            original, in_c, dataclasses.replace(settings, case=CaseSettings(wear_gain=wear))
        )


@pytest.mark.parametrize('architecture', ARCHITECTURES)
def test_it_does_so_in_every_architecture(tmp_path, architecture):
    compare_exported('mpc3', run_settings(architecture=architecture), tmp_path / 'c')


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
    require_exported_options('mpc3', tmp_path / 'c', *options)


@pytest.mark.parametrize('name', EXPORTABLE)
def test_binding_limits_of_torque_and_rate_give_the_same_torques(tmp_path, name):
    require_binding_limits(name, tmp_path / 'c')


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
    require_exported_authority(tmp_path / 'c', changes)


@pytest.mark.parametrize('name', ['mpc2', 'mpc3', 'mpc4'])
def test_levels_give_way_to_the_rate_as_in_the_original(tmp_path, name):
    require_levels_that_give_way(name, tmp_path / 'c')


@pytest.mark.parametrize('slip', [0, 100])
@pytest.mark.parametrize('name', ['mpc3', 'mpc4'])
def test_the_lowest_slip_is_exported(tmp_path, name, slip):
    require_exported_options(name, tmp_path / 'c', f'lowest_slip_rpm={slip}')
