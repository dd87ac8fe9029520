# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A specification is read with its files; every mistake is reported with its line."""

import re
from pathlib import Path

import pytest
from refusals import refused

from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.spec import read_spec
from ddct_plant.base.errors import DdctError, ParameterError

GRID = 'grid: {wear_gain: [0.7, 1.0]}\n'
PI = 'controllers: [pi]\n'
MASS = '{distribution: uniform, low: 1000, high: 1500}'


def written(folder: Path, text: str) -> Path:
    file = folder / 'spec.yaml'
    file.write_text(text, encoding='utf-8')
    return file


def test_a_specification_has_defaults_for_all_but_what_varies(tmp_path: Path) -> None:
    spec = read_spec(written(tmp_path, PI + GRID))
    assert (spec.common, spec.root, spec.samples) == ({}, 0, 1)
    assert Campaign(spec).run(1).settings.case.wear_gain == 1.0
    assert Campaign(spec).run(1).settings.scenario.name == 'thesis'


@pytest.mark.parametrize(
    ('text', 'words'),
    [
        ('[1, 2]', 'spec.yaml: the specification is [1, 2]: give keys and values'),
        (GRID, 'spec.yaml: controllers: give a list of names or files'),
        ('controllers: []\n' + GRID, 'line 1: controllers: give a list'),
        ('controllers: [pi, pi]\n' + GRID, "controllers has 'pi' twice"),
        (PI, 'spec.yaml: nothing is varied: give grid, random or both'),
        (PI + 'grids: {}\n', 'line 2: unknown key grids: did you mean grid?'),
        (PI + 'grid: {}\n', 'line 2: grid is empty'),
        (PI + 'grid: [1]\n', 'line 2: grid is [1]: give keys'),
        (PI + 'grid: {1: [1]}\n', 'line 2: grid has the key 1: give names'),
        (
            PI + f'random: {{samples: 2, vary: {{2: {MASS}}}}}\n',
            'line 2: random.vary has the key 2: give names',
        ),
        (PI + 'grid: {wear_gain: []}\n', 'line 2: grid.wear_gain is []: give a list of values'),
        (PI + 'grid: {wear_gain: 1.0}\n', 'grid.wear_gain is 1.0: give a list'),
        (PI + 'grid: {wear_gain: [1, 9]}\n', 'grid.wear_gain is 9: it must be at most 3'),
        (PI + 'grid: {wear_gain: [1, 1]}\n', 'grid.wear_gain has 1 twice'),
        (
            PI + 'grid:\n  vehicle.mas_kg: [1]\n',
            'line 3: grid.vehicle.mas_kg: unknown key vehicle.mas_kg: did you mean vehicle.mass',
        ),
        (
            PI + 'grid: {K_usura: [0.7]}\n',
            'line 2: grid.K_usura: unknown key K_usura: did you mean wear_gain?',
        ),
        (PI + 'grid: {mode: [realtime]}\n', 'grid.mode: unknown key mode'),
        (PI + GRID + 'seed: -1\n', 'line 3: seed is -1: it must be at least 0'),
        (
            PI + f'random: {{samples: 3, of: 2, vary: {{vehicle.mass_kg: {MASS}}}}}\n',
            'line 2: random.of is 2: it must be at least 3',
        ),
        (PI + GRID + 'floors: true\n', 'line 3: unknown key floors'),
        (
            PI + GRID + 'clutch: stick_slip\n',
            'line 3: clutch is a key of the scenario: give a scenario with it, or list its values',
        ),
        (PI + 'grid: {clutch: [wet]}\n', "'wet': choose from linear, stick_slip"),
        (PI + GRID + 'scenario: 3\n', 'scenario is 3: give text'),
        (PI + 'grid: {scenario: [{csv: a.csv}]}\n', 'line 2: grid.scenario is {'),
        (PI + 'grid: {scenario: [{a: b}, launch]}\n', "grid.scenario is {'a': 'b'}: give text"),
        (PI + 'grid: {scenario: [7]}\n', 'grid.scenario is 7: give text'),
        (
            PI
            + 'random: {samples: 2, vary: {scenario: {distribution: choice, values: [7, 8]}}}\n',
            'random.vary.scenario.values is 7: give text',
        ),
        (
            PI
            + 'random: {samples: 2, vary: {scenario: {distribution: uniform, low: 0, high: 1}}}\n',
            'random.vary.scenario: scenario takes no number',
        ),
        (PI + GRID + 'schema_version: 2\n', 'schema_version is 2, this version reads up to 1'),
        (PI + 'random: {samples: 2}\n', 'random.vary is empty'),
        (PI + 'random: {samples: 2, vary: {}}\n', 'random.vary is empty'),
        (PI + f'random: {{vary: {{gear: {MASS}}}}}\n', 'random.samples is missing'),
        (PI + 'random: {samples: 0, vary: {}}\n', 'random.samples is 0: it must be at least 1'),
        (
            PI + 'random:\n  samples: 2\n  vary:\n    vehicle.mass_kg: {distribution: normal, '
            'mean: 1500, std: 90}\n',
            'line 5: random.vary.vehicle.mass_kg.low is missing',
        ),
        (
            PI + GRID + f'random: {{samples: 2, vary: {{wear_gain: {MASS}}}}}\n',
            'random.vary.wear_gain.low is 1000: it must be at most 3',
        ),
        (
            PI + 'grid: {vehicle.mass_kg: [1500]}\n'
            f'random: {{samples: 2, vary: {{vehicle.mass_kg: {MASS}}}}}\n',
            'vehicle.mass_kg varies beside vehicle.mass_kg: give one of them',
        ),
        (
            PI + 'grid: {engine: [{time_s: [0], torque_n_m: [1]}], engine.torque_n_m: [[2]]}\n',
            'engine.torque_n_m varies beside engine',
        ),
        (
            PI + 'architecture: base\ngrid: {architecture: [base, detailed]}\n',
            'architecture is given for all runs and varied: give it once',
        ),
        (PI + 'grid: {wear_gain: [1\n', 'line 3: not valid YAML'),
    ],
)
def test_a_specification_that_cannot_be_used_is_named(
    tmp_path: Path, text: str, words: str
) -> None:
    with pytest.raises(DdctError, match=re.escape(words)) as complaint:
        read_spec(written(tmp_path, text))
    assert complaint.value.place.startswith(f'{tmp_path}/spec.yaml')


def test_a_missing_specification_is_reported(tmp_path: Path) -> None:
    with refused(DdctError, place='absent.yaml'):
        read_spec(tmp_path / 'absent.yaml')


@pytest.mark.parametrize(
    ('text', 'key'),
    [
        ('controllers: [pie]\n' + GRID, 'pie'),
        (PI + 'scenario: thesys\n' + GRID, 'thesys'),
        (
            'controllers: [pi, ls8]\n'
            f'random: {{samples: 9999999, vary: {{vehicle.mass_kg: {MASS}}}}}\n',
            'runs',
        ),
        (
            PI + 'random: {samples: 2, vary: {gear: '
            '{distribution: choice, values: [1, 7], weights: [0.999999, 0.000001]}}}\n',
            'random.vary.gear',
        ),
        (
            PI + 'car: city7\ndrive: upshift\nrandom: {samples: 2, vary: {shift.off_going_gear: '
            '{distribution: uniform, low: 1, high: 8, step: 1}}}\n',
            'random.vary.shift.off_going_gear',
        ),
    ],
    ids=['controller', 'scenario', 'runs', 'gear', 'off-going gear'],
)
def test_missing_or_excessive_parts_are_reported_before_anything_is_computed(
    tmp_path: Path, text: str, key: str
) -> None:
    spec = read_spec(written(tmp_path, text))
    with refused(DdctError, key):
        Campaign(spec)


def test_controllers_learn_the_varied_keys_that_are_listed_as_known(tmp_path: Path) -> None:
    text = PI + 'grid: {vehicle.mass_kg: [1700], load.slope_rad: [0.05], wear_gain: [0.8]}\n'
    unknown, known = (
        Campaign(read_spec(written(tmp_path, text + more))).run(0).settings
        for more in ('', 'known: [vehicle.mass_kg]\n')
    )
    assert unknown.known.scenario.vehicle.mass_kg == 1500.0
    assert known.known.scenario.vehicle.mass_kg == 1700.0
    assert known.known.scenario.load.slope_rad == 0.0
    assert known.scenario == unknown.scenario
    assert known.case.wear_gain == unknown.case.wear_gain == 0.8


@pytest.mark.parametrize(
    ('known', 'key'),
    [
        ('[vehicle.mass]', 'vehicle.mass'),
        ('[load.slope_rad]', 'load.slope_rad'),
        ('[wear_gain]', 'known'),
        ('vehicle.mass_kg', 'known'),
        ('[vehicle.mass_kg, vehicle.mass_kg]', 'known'),
    ],
)
def test_what_cannot_be_known_is_refused(tmp_path: Path, known: str, key: str) -> None:
    text = PI + f'grid: {{vehicle.mass_kg: [1700], wear_gain: [0.8]}}\nknown: {known}\n'
    with refused(ParameterError, key):
        read_spec(written(tmp_path, text))
