# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Pedal and engine speed reference of a scenario: read whole, or refused by name."""

import pytest

from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.control import EngineSpeedReference
from ddct_plant.scenario.file import load_scenario, scenario_to_yaml


def test_it_is_linear_between_its_points_and_constant_outside():
    reference = EngineSpeedReference((0.5, 1.5), (200.0, 220.0))
    assert reference.given
    assert [reference.at(time) for time in (0.0, 1.0, 9.0)] == [200.0, 210.0, 220.0]


def test_the_thesis_scenario_gives_none_and_half_a_pedal():
    scenario = load_scenario('thesis')
    assert not scenario.engine_speed_reference.given
    assert scenario.pedal_position == 0.5


def test_both_are_the_same_after_writing_and_reading(tmp_path):
    changes = [
        'engine_speed_reference.time_s=[0.6, 1.2]',
        'engine_speed_reference.speed_rad_s=[250, 240.5]',
        'pedal_position=1',
    ]
    scenario = load_scenario('thesis', changes)
    path = tmp_path / 'mine.yaml'
    path.write_text(scenario_to_yaml(scenario), encoding='utf-8')
    assert load_scenario(str(path)) == scenario
    assert scenario.engine_speed_reference.at(0.9) == pytest.approx(245.25)


@pytest.mark.parametrize(
    ('changes', 'complaint'),
    [
        (['pedal_position=1.1'], 'pedal_position is 1.1: it must be at most 1'),
        (['pedal_position=-0.1'], 'pedal_position is -0.1'),
        (['pedal_position=.nan'], 'pedal_position is nan'),
        (['pedal_position=half'], "pedal_position is 'half'"),
        (['engine_speed_reference=200'], 'engine_speed_reference: give keys and values'),
        (['engine_speed_reference.time=[1]'], 'did you mean engine_speed_reference.time_s'),
        (
            ['engine_speed_reference.time_s=[1.0]'],
            'engine_speed_reference.speed_rad_s has 0 values for the 1 of',
        ),
        (['engine_speed_reference.time_s=1.0'], 'engine_speed_reference.time_s is 1.0'),
        (
            [
                'engine_speed_reference.time_s=[1.0, 1.0]',
                'engine_speed_reference.speed_rad_s=[1.0, 2.0]',
            ],
            'engine_speed_reference.time_s goes from 1 to 1',
        ),
        (
            ['engine_speed_reference.time_s=[.inf]', 'engine_speed_reference.speed_rad_s=[1.0]'],
            'engine_speed_reference.time_s[0] is inf',
        ),
        (
            ['engine_speed_reference.time_s=[0.0]', 'engine_speed_reference.speed_rad_s=[-1.0]'],
            'engine_speed_reference.speed_rad_s[0] is -1',
        ),
    ],
)
def test_a_bad_value_is_named(changes, complaint):
    with pytest.raises(ParameterError) as caught:
        load_scenario('thesis', changes)
    assert complaint in str(caught.value)
