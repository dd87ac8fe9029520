# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A value that no car has runs, but a line names it with what cars have."""

import pytest

from ddct_plant.scenario.choices.scenarios import scenario_names
from ddct_plant.scenario.file import load_scenario, scenario_to_yaml
from ddct_plant.scenario.rules.plausible import RANGES


@pytest.mark.parametrize('name', scenario_names())
def test_no_packaged_scenario_has_a_remark(name):
    assert load_scenario(name).adjusted == ()


def test_a_mass_in_tonnes_is_named_with_its_key_value_and_range():
    lines = load_scenario('thesis', ['vehicle.mass_kg=1.5']).adjusted
    assert (
        'vehicle.mass_kg is 1.5 kg, but cars and trucks have 300 to 50000 kg: is it in another '
        'unit?'
    ) in lines
    assert any(line.startswith('driveline.vehicle_inertia is 0.15') for line in lines)


@pytest.mark.parametrize('key', RANGES)
def test_both_ends_of_each_range_are_without_a_remark_and_beyond_them_is_one(key):
    least, most, unit = RANGES[key]
    assert least < most
    for value in (least, most):
        assert not remarks(key, value)
    for value in (0.99 * least if least > 0 else 1.01 * least, 1.01 * most):
        (line,) = remarks(key, value)
        assert f'{value:g} {unit}'.strip() in line


def remarks(key: str, value: float) -> list[str]:
    lines = load_scenario('thesis', {key: value}).adjusted
    return [line for line in lines if line.startswith(f'{key} is ')]


def test_what_is_written_and_read_again_has_the_remark_once(tmp_path):
    scenario = load_scenario('thesis', ['vehicle.mass_kg=1.5'])
    (tmp_path / 'light.yaml').write_text(scenario_to_yaml(scenario))
    assert load_scenario(str(tmp_path / 'light.yaml')).adjusted == scenario.adjusted
