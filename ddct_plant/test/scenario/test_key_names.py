# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A wrong key of a scenario is refused with the few keys that may be meant."""

import pytest
from refusals import refused

from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.choices.settings import SETTINGS
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.key_names import MOST_MEANT, key_hint, scenario_options

KEYS = {**scenario_options(), **SETTINGS}
OF_THE_THESIS = {
    'K_usura': 'wear_gain',
    'J_m': 'driveline.engine_inertia',
    'J_v': 'driveline.vehicle_inertia',
    'k_sa': 'driveline.halfshaft_stiffness',
    'tau': 'gearbox.measured_ratios',
    'C_m': 'engine.torque_n_m',
    'm_v': 'vehicle.mass_kg',
    'v_a': 'load.wind_speed_m_s',
    'x_p': 'pedal_position',
    'alpha': 'load.slope_rad',
}


@pytest.mark.parametrize(('symbol', 'key'), OF_THE_THESIS.items())
def test_the_error_on_a_symbol_of_the_thesis_names_our_key(symbol, key):
    assert key_hint(symbol, KEYS) == f'did you mean {key}?'


@pytest.mark.parametrize(
    ('wrong', 'key'),
    [
        ('wear_gian', 'wear_gain'),
        ('gearbox.measured_ratio', 'gearbox.measured_ratios'),
        ('mass', 'vehicle.mass_kg'),
        ('clutch_phase', 'initial.clutch_phase'),
    ],
)
def test_the_error_on_a_name_nearly_right_or_without_its_section_names_the_key(wrong, key):
    assert key_hint(wrong, KEYS) == f'did you mean {key}?'


def test_of_many_keys_at_most_three_are_named_and_of_none_the_page_that_lists_them():
    assert sum('noise' in key for key in KEYS) > MOST_MEANT
    assert key_hint('noise', KEYS).count('noise') == MOST_MEANT == 3
    assert key_hint('nonsense', KEYS) == 'docs/use/cases.md lists the keys'


@pytest.mark.parametrize('name', ['K_usura', 'wear_gain'])
def test_a_setting_of_the_run_is_named_with_its_option(name):
    with pytest.raises(ParameterError) as caught:
        load_scenario('thesis', [f'{name}=0.7'])
    assert str(caught.value) == (
        f'scenario thesis: unknown key {name}: wear_gain stands beside the scenario: '
        'give it to the program, as --wear-gain'
    )


def test_in_a_section_its_own_keys_come_first_and_symbols_count_too():
    for wrong, meant in {
        'driveline.engine_inertai': 'driveline.engine_inertia',
        'driveline.c_prim': 'driveline.shaft_damping',
        'engin': 'engine',
    }.items():
        with refused(ParameterError, wrong, 'scenario thesis') as caught:
            load_scenario('thesis', [f'{wrong}=0.7'])
        assert f' {meant}?' in str(caught.value)


def test_the_error_on_a_name_unlike_any_key_lists_the_keys_of_the_section():
    with refused(ParameterError, key='closing.zebra'):
        load_scenario('launch', ['closing.zebra=0.7'])
