# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Each key of a scenario belongs to the car, to the drive or to the scenario file."""

import dataclasses
from typing import Any

import pytest
from refusals import refused

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import group_of, key_of
from ddct_plant.scenario.content import scenario_content
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.key_names import scenario_options
from ddct_plant.scenario.nouns import keys
from ddct_plant.scenario.nouns.keys import (
    CAR,
    DRIVE,
    SCENARIO,
    by_noun,
    is_shared,
    owner_of,
)
from ddct_plant.scenario.scenario import Scenario

KEYS = (*scenario_options(), *(key_of(field) for field in dataclasses.fields(Scenario)))


@pytest.mark.parametrize('key', KEYS)
def test_a_key_and_a_section_have_an_owner_or_are_shared(key: str) -> None:
    assert (owner_of(key) is None) == is_shared(key)
    assert owner_of(key) in (CAR, DRIVE, SCENARIO, None)


def test_the_table_has_no_key_that_a_scenario_lacks() -> None:
    sections = [key_of(field) for field in dataclasses.fields(Scenario) if group_of(field)]
    listed: Any = keys._OWNERS
    assert {*listed} <= {*KEYS, *sections}
    assert {section for section in sections if is_shared(section)} == {'vehicle', 'load', 'heat'}


def test_a_scenario_falls_apart_into_its_nouns_and_nothing_is_lost() -> None:
    content = scenario_content(load_scenario('launch_hot'))
    parts = by_noun(content)
    assert parts[CAR]['vehicle'] == {
        name: content['vehicle'][name] for name in ('mass_kg', 'wheel_radius_m')
    }
    assert parts[DRIVE]['vehicle'] == {'gravity_m_s2': 9.81}
    joined: dict[str, object] = {}
    for part in parts.values():
        for name, value in part.items():
            before = joined.get(name)
            joined[name] = {**before, **value} if isinstance(before, dict) else value
    assert {key: joined[key] for key in content} == content


@pytest.mark.parametrize(
    ('noun', 'text', 'key', 'said'),
    [
        ('car', 'load: {slope_rad: 0.1}', 'load.slope_rad', 'is a key of the drive'),
        ('car', 'duration_s: 1.0', 'duration_s', 'is a key of the drive'),
        ('car', 'controllers: {}', 'controllers', 'is a key of the scenario'),
        ('car', 'load: 3', 'load', 'give keys and values'),
        ('car', 'lood: {}', 'lood', 'did you mean load?'),
        ('car', 'load: {drag: 1}', 'load.drag', 'did you mean load.drag_coefficient?'),
        ('car', 'friction: {most: 1}', 'friction.most', 'did you mean friction.most_n_m?'),
        ('drive', 'friction: {most_n_m: 1.0}', 'friction', 'is a key of the car'),
        ('drive', 'vehicle: {mass_kg: 1.0}', 'vehicle.mass_kg', 'is a key of the car'),
        ('drive', 'name: x', 'name', 'is a key of the scenario'),
        ('drive', 'duratoin_s: 1', 'duratoin_s', 'did you mean duration_s?'),
    ],
)
def test_a_key_in_the_file_of_another_noun_is_refused_with_its_own(
    tmp_path, noun: str, text: str, key: str, said: str
) -> None:
    file = tmp_path / 'mine.yaml'
    base = {'car': 'c635', 'drive': 'launch'}[noun]
    file.write_text(f'base: {base}\n{text}\n')
    chosen = {'drive': 'launch', noun: str(file)}
    with refused(ParameterError, key=key, place=f'{noun} {file}: line 2') as caught:
        load_scenario(**chosen)
    assert said in str(caught.value)
