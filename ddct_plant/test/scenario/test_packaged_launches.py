# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every value of a packaged file has its source; launches and tip-in are for a sticking clutch."""

import pytest
from refusals import refused

from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.choices.scenarios import packaged_names, packaged_text, scenario_names
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.initial_state import initial_state
from ddct_plant.scenario.settings import KnownSettings, RunSettings

NAMES = ('launch', 'launch_gentle', 'launch_hill', 'launch_hot', 'tip_in')


def test_they_are_packaged_and_consistent():
    assert set(NAMES) < set(scenario_names())
    for name in NAMES:
        assert load_scenario(name).adjusted == ()


@pytest.mark.parametrize(
    ('noun', 'name'),
    [(noun, name) for noun in ('car', 'drive', 'scenario') for name in packaged_names(noun)],
)
def test_each_value_or_the_section_it_is_in_has_a_comment(noun, name):
    explained: dict[int, bool] = {}
    for line in packaged_text(noun, name).splitlines():
        if line.startswith(('#', 'description:', 'base:', 'car:', 'drive:')):
            continue
        depth = len(line) - len(line.lstrip())
        explained = {at: text for at, text in explained.items() if at < depth}
        explained[depth] = '#' in line
        is_section = line.split('#')[0].rstrip().endswith(':')
        assert is_section or any(explained.values()), line


@pytest.mark.parametrize('name', NAMES)
def test_the_linear_clutch_refuses_what_it_would_ignore(name):
    with refused(ParameterError, 'initial.clutch_phase') as caught:
        load_scenario(name, ['clutch=linear'])
    message = str(caught.value)
    assert message.startswith(f'drive {name}: line ')
    assert ': the clutch linear would ignore initial.clutch_phase' in message
    assert message.endswith(': give the car clutch: stick_slip, or leave that out')


@pytest.mark.parametrize('section', ['friction', 'heat', 'brake', 'closing'])
def test_each_section_of_the_clutch_that_sticks_is_named(section):
    change = {
        'friction': 'friction.static_over_kinetic=1.2',
        'heat': 'heat.facing_c=90',
        'brake': 'brake={time_s: [0.0], torque_n_m: [9.0]}',
        'closing': 'closing={}',
    }[section]
    with refused(ParameterError, key=section):
        load_scenario('thesis', [change])
    assert load_scenario('thesis_sticking', [change]).of_stick_slip == (section,)


@pytest.mark.parametrize('name', [name for name in NAMES if name != 'tip_in'])
def test_a_launch_starts_at_rest_with_an_open_clutch_and_a_balanced_shaft(name):
    settings = RunSettings(KnownSettings(load_scenario(name)))
    start = initial_state(settings)
    assert start.engine_speed == pytest.approx(104.72)
    assert (start.sides[0].shaft_speed, start.wheel_speed) == (0.0, 0.0)
    assert (start.sides[0].torque_request, start.sides[0].torque, start.twist) == (0.0, 0.0, 0.0)
    assert start.wheel_torque == pytest.approx(-start.load_torque), 'the brake holds the slope'


def test_launches_and_shifts_close_the_clutch_after_lock_up_and_nothing_else_does():
    scenarios = map(load_scenario, scenario_names())
    closing = {each.name for each in scenarios if each.closing and not each.shift}
    assert closing == {name for name in NAMES if name != 'tip_in'}
    assert load_scenario('launch', ['closing=null']).closing is None


def test_the_tip_in_starts_locked():
    start = initial_state(RunSettings(KnownSettings(load_scenario('tip_in'))))
    assert start.engine_speed == start.sides[0].shaft_speed
    assert start.sides[0].torque_request > 0.0
