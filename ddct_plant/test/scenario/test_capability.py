# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A drive that asks more than engine or clutch can give is refused, with key and numbers."""

import pytest
from refusals import refused

from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.choices.scenarios import scenario_names
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.rules.capability import require_able
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

HELD = 'brake={time_s: [0.0], torque_n_m: [5000.0]}'
RELEASED = 'brake={time_s: [0.0, 0.5, 0.6], torque_n_m: [5000.0, 5000.0, 0.0]}'


@pytest.mark.parametrize('name', scenario_names())
def test_engine_and_clutch_can_give_what_the_packaged_scenarios_ask_for(name):
    require_able(load_scenario(name))


@pytest.mark.parametrize(
    ('changes', 'key', 'numbers'),
    [
        (['engine.torque_n_m=[0, 300]'], 'engine.torque_n_m', ['300 N m', '250 N m']),
        (['friction.most_n_m=90'], 'engine.torque_share', ['140 N m', '100 N m', '90 N m']),
        (
            ['engine={time_s: [0.0], torque_share: [1.0]}', 'friction.most_n_m=150'],
            'engine.torque_share',
            ['250 N m', '150 N m'],
        ),
        ([HELD], 'brake.torque_n_m', ['315 N m', '250 N m']),
        (
            ['load.slope_rad=0.5', 'vehicle.mass_kg=20000', 'friction.most_n_m=2000'],
            'load.slope_rad',
            ['250 N m'],
        ),
        (['reference.slope_rad_s2=5000'], 'reference.slope_rad_s2', ['937 N m', '350 N m']),
        (
            ['reference={shape: polynomial, reference_end_s: 0.31}'],
            'reference.reference_end_s',
            ['350 N m'],
        ),
    ],
)
def test_what_is_too_much_is_refused_with_its_numbers(changes, key, numbers):
    with pytest.raises(ParameterError) as caught:
        RunSettings(KnownSettings(load_scenario('launch', changes)))
    assert caught.value.key == key
    for number in numbers:
        assert number in str(caught.value)
    assert '\n' not in str(caught.value)


@pytest.mark.parametrize(
    'changes',
    [
        ['engine.torque_n_m=[0, 250]'],
        ['engine={time_s: [0.0], torque_share: [1.0]}'],
        ['engine.torque_n_m=[0, 300]', 'engine_limits=null'],
        ['engine={time_s: [0.0, 3.0, 9.0], torque_n_m: [140.0, 140.0, 600.0]}'],
        [RELEASED],
        ['friction.most_n_m=110'],
    ],
)
def test_what_is_just_enough_is_taken(changes):
    RunSettings(KnownSettings(load_scenario('launch', changes)))


def test_a_clutch_that_does_not_stick_has_no_greatest_torque():
    heavy = ['engine.torque_n_m=[0, 900]']
    RunSettings(KnownSettings(load_scenario('thesis', heavy)))
    with refused(ParameterError, 'engine.torque_n_m'):
        RunSettings(KnownSettings(load_scenario('thesis_sticking', heavy)))


def test_what_varies_for_the_plant_alone_may_ask_for_more():
    known, true = load_scenario('launch'), load_scenario('launch', ['engine.torque_n_m=[0, 300]'])
    RunSettings(KnownSettings(known), CaseSettings(scenario=true))
    with refused(ParameterError, 'engine.torque_n_m'):
        RunSettings(KnownSettings(true), CaseSettings(scenario=known))


def test_the_on_coming_clutch_of_a_shift_has_to_carry_the_demand():
    with refused(ParameterError, 'engine.torque_share'):
        RunSettings(KnownSettings(load_scenario('upshift', ['friction.most_n_m=85'])))
