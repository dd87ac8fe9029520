# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The values of a scenario that differ from the packaged one of its name are listed."""

import dataclasses
from pathlib import Path

from ddct_plant.scenario.choices.scenarios import scenario_names
from ddct_plant.scenario.differences import changed_values, scenario_title
from ddct_plant.scenario.file import load_scenario, scenario_to_yaml


def test_packaged_scenarios_have_changed_nothing() -> None:
    assert [name for name in scenario_names() if changed_values(load_scenario(name))] == []


def test_every_changed_value_is_listed_also_what_follows_from_it() -> None:
    scenario = load_scenario('thesis', ['load.slope_rad=0.05', 'vehicle.mass_kg=1800'])
    changed = changed_values(scenario)
    assert 'load.slope_rad=0.05' in changed
    assert {each.partition('=')[0] for each in changed} == {
        'load.slope_rad',
        'vehicle.mass_kg',
        'driveline.vehicle_inertia',
    }


def test_options_of_controllers_and_left_out_sections_count() -> None:
    gain = load_scenario('thesis', ['controllers.pi.proportional_gain=0.2'])
    assert changed_values(gain) == ('controllers.pi.proportional_gain=0.2',)
    launch = dataclasses.replace(load_scenario('launch'), closing=None)
    assert 'closing.dwell_s left out' in changed_values(launch)
    linear = load_scenario('thesis_sticking', ['clutch=linear'])
    assert changed_values(linear) == ('clutch=linear',)
    assert 'closing.dwell_s=0.1' in changed_values(
        load_scenario('thesis_sticking', ['closing={}'])
    )


def test_a_changed_file_of_a_packaged_name_is_found_out(tmp_path: Path) -> None:
    file = tmp_path / 'thesis.yaml'
    scenario = load_scenario('thesis')
    file.write_text(scenario_to_yaml(dataclasses.replace(scenario, duration_s=2.0)))
    assert changed_values(load_scenario(str(file))) == ('duration_s=2.0',)
    assert changed_values(dataclasses.replace(scenario, name='mine', duration_s=2.0)) == ()


def test_a_title_counts_what_it_does_not_show() -> None:
    assert scenario_title('thesis', ()) == 'thesis'
    assert scenario_title('thesis', ['a=1']) == 'thesis, 1 value changed: a=1'
    many = [f'k{index}=0' for index in range(9)]
    title = scenario_title('thesis', many)
    assert title.startswith('thesis, 9 values changed: k0=0, ') and title.endswith(' and 3 more')


def test_the_other_keys_of_a_changed_section_are_not_changed_by_their_defaults():
    scenario = load_scenario('thesis', ['actuator.delay_s=0.05'])
    assert changed_values(scenario) == ('actuator.delay_s=0.05',)
