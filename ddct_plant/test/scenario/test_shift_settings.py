# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The section `shift` of a scenario makes a run a gear shift; bad keys and settings are named."""

import pytest
from refusals import refused
from shifts import SHIFTS

from ddct_plant.base.errors import ParameterError
from ddct_plant.files.yaml_text import dump_yaml, parse_yaml
from ddct_plant.scenario.content import scenario_content, scenario_from_mapping
from ddct_plant.scenario.file import load_scenario, scenario_digest, scenario_to_yaml
from ddct_plant.scenario.settings import KnownSettings, RunSettings
from ddct_plant.signals.topic import RunKind


def settings(*overrides, **values):
    scenario = load_scenario('upshift', overrides)
    return RunSettings.of(scenario, values)


def test_the_packaged_upshifts_are_shifts_and_a_launch_is_none():
    for name in SHIFTS:
        upshift = RunSettings(KnownSettings(load_scenario(name)))
        assert upshift.scenario.adjusted == ()
        assert upshift.kind() == RunKind(clutch='stick_slip', shift=True)
    assert not RunSettings(KnownSettings(load_scenario('launch'))).kind().shift


def test_keys_of_the_shift_are_set_like_others_and_survive_their_file():
    scenario = settings('shift.torque_cut_n_m=40', 'shift.handover_s=0.1').scenario
    assert scenario.shift is not None
    assert (scenario.shift.torque_cut_n_m, scenario.shift.handover_s) == (40.0, 0.1)
    again = scenario_from_mapping(parse_yaml(dump_yaml(scenario_content(scenario))))
    assert again == scenario
    assert scenario_digest(again) != scenario_digest(load_scenario('upshift'))
    assert 'shift' not in scenario_to_yaml(load_scenario('launch'))


@pytest.mark.parametrize(
    ('override', 'key'),
    [
        ('shift.torque_cut_n_m=-1', 'shift.torque_cut_n_m'),
        ('shift.torque_cut=40', 'shift.torque_cut'),
        ('shift.handover_s=0.123', 'shift.handover_s'),
        ('shift.off_going_gear=2', 'shift.off_going_gear'),
        ('shift.off_going_gear=3', 'shift.off_going_gear'),
        ('gear=3', 'shift.off_going_gear'),
        ('shift.preselection_s=0.5', 'shift.preselection_s'),
        ('shift.disengagement_s=0.5', 'shift.disengagement_s'),
        ('initial.engine_speed_rad_s=250', 'initial.engine_speed_rad_s'),
        ('shift=fast', 'shift'),
    ],
)
def test_a_bad_key_of_the_shift_is_named(override, key):
    with refused(ParameterError, key):
        settings(override)


@pytest.mark.parametrize(
    ('override', 'speed'),
    [
        ('initial={shaft_speed_rad_s: 100.0}', 171.921),
        ('gear=4', 277.838),
        ('initial.speed_km_h=30', 416.757),
    ],
)
def test_the_engine_speed_follows_the_car_and_the_gear_unless_it_is_given_too(override, speed):
    slowly = 'reference.reference_end_s=1.0'
    shift = settings(override, slowly)
    assert shift.scenario.initial.engine_speed_rad_s == speed
    with refused(ParameterError, 'initial.engine_speed_rad_s'):
        settings(override, slowly, 'initial.engine_speed_rad_s=250')


def test_a_shift_in_another_scenario_needs_its_gear():
    with refused(ParameterError, 'shift.off_going_gear'):
        load_scenario('launch', ['shift.torque_cut_n_m=40'])


@pytest.mark.parametrize(
    ('values', 'key'),
    [
        ({'architecture': 'base'}, 'architecture'),
        ({'off_going_wear_gain': 0.0}, 'off_going_wear_gain'),
    ],
)
def test_a_shift_needs_the_detailed_architecture_and_possible_wear(values, key):
    with refused(ParameterError, key):
        settings(**values)


def test_a_shift_needs_clutches_that_stick():
    with refused(ParameterError, 'closing'):
        settings('clutch=linear')


@pytest.mark.parametrize('values', [{'off_going_wear_gain': 0.8}, {'handover': 'timed'}])
def test_settings_of_a_shift_are_refused_in_another_run(values):
    (key,) = values
    with refused(ParameterError, key):
        RunSettings.of(load_scenario('launch'), values)
    assert settings(**values).values[key] == values[key]
