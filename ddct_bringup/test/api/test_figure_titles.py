# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The title of a figure of the Python interface names its runs and their conditions."""

import pytest

from ddct_bringup import api


@pytest.fixture(scope='module')
def new():
    return api.run('pi')


def title(*runs):
    return api.figure(runs, ['w_d']).get_suptitle()


def test_one_run_is_named_with_its_scenario_architecture_clutch_and_wear(new):
    assert title(new) == 'pi\nthesis; detailed, wear 1, lockstep, seed 0'


def test_varied_conditions_are_named_beside_the_controllers(new):
    worn = api.run('ls8', wear_gain=0.7, architecture='base')
    first, second = title(new, worn).split('\n')
    assert first == 'pi, ls8 over architecture, wear gain'
    assert second == 'thesis; lockstep, seed 0'


def test_other_scenarios_and_changed_values_are_named(new):
    heavy = api.run('pi', set={'vehicle.mass_kg': 1700.0})
    first, *others = title(new, heavy).split('\n')
    assert first == 'pi over scenario'
    assert ' '.join(others).startswith('thesis; thesis, ')
    assert 'vehicle.mass_kg=1700.0' in ' '.join(others)
