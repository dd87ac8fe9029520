# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Scenarios are read whole or refused with the key that is wrong."""

import copy
import json

import pytest
from refusals import refused

from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.scenario.choices.scenarios import scenario_names
from ddct_plant.scenario.file import ScenarioFile, load_scenario, scenario_digest, scenario_to_yaml
from ddct_plant.scenario.settings import RunSettings

MINIMAL = """\
car: c635_thesis
drive:
  duration_s: 1.0
  control_start_s: 0.6
  score_window_s: [0.6, 1.0]
  engine: {time_s: [0.0], torque_n_m: [100.0]}
"""


DRIVE = MINIMAL.partition('\n')[2]
CAR = 'car: {base: c635_thesis, '


@pytest.fixture
def scenario_file(tmp_path):
    def write(text):
        path = tmp_path / 'mine.yaml'
        path.write_text(text)
        return str(path)

    return write


def test_every_packaged_scenario_loads():
    assert 'thesis' in scenario_names()
    for name in scenario_names():
        assert load_scenario(name).name == name


def test_a_scenario_is_the_same_to_the_last_bit_after_writing_and_reading(scenario_file):
    scenario = load_scenario('thesis', ['load.slope_rad=0.1'])
    again = load_scenario(scenario_file(scenario_to_yaml(scenario)))
    assert again == scenario
    assert scenario_digest(again) == scenario_digest(scenario)


def test_a_scenario_may_have_a_schema_version_and_a_written_one_does(scenario_file):
    without = load_scenario(scenario_file(MINIMAL))
    assert load_scenario(scenario_file(f'schema_version: 2\n{MINIMAL}')) == without
    assert scenario_to_yaml(without).startswith('schema_version: 2\n')


@pytest.mark.parametrize(
    ('version', 'advice'),
    [
        ('3', 'update the project'),
        ('0', 'a whole number'),
        ('1.0', 'a whole number'),
        ('true', 'a whole number'),
    ],
)
def test_an_unknown_schema_version_is_refused(scenario_file, version, advice):
    with refused(DdctError, key='schema_version', place='mine.yaml: line 1') as caught:
        load_scenario(scenario_file(f'schema_version: {version}\n{MINIMAL}'))
    assert advice in str(caught.value)


def test_a_file_without_a_name_is_named_after_itself(scenario_file):
    assert load_scenario(scenario_file(MINIMAL)).name == 'mine'


def test_an_override_changes_one_key_and_the_digest(scenario_file):
    path = scenario_file(MINIMAL)
    changed = load_scenario(path, ['load.slope_rad=0.05'])
    assert changed.load.slope_rad == 0.05
    assert scenario_digest(changed) != scenario_digest(load_scenario(path))


@pytest.mark.parametrize(
    ('text', 'key', 'place'),
    [
        (MINIMAL + 'lod: {}', 'lod', 'line 7'),
        (MINIMAL + '  load: {slope_deg: 1.0}', 'load.slope_deg', 'line 7'),
        (MINIMAL + '  load: {slope_rad: .nan}', 'load.slope_rad', 'line 7'),
        (MINIMAL + '  load: {slope_rad: steep}', 'load.slope_rad', 'line 7'),
        (MINIMAL + '  load: 3', 'load', 'line 7'),
        (MINIMAL + '  reference: {slope_rad_s2: -1.0}', 'reference.slope_rad_s2', 'line 7'),
        (MINIMAL + '  reference: {shape: step}', 'reference.shape', 'line 7'),
        (MINIMAL + '  reference: {shape: 1}', 'reference.shape', 'line 7'),
        (MINIMAL + '  reference: {reference_end_s: 0.905}', 'reference.reference_end_s', 'line 7'),
        (
            f'{CAR}driveline: {{vehicle_inertia: 0.0}}}}\n{DRIVE}',
            'driveline.vehicle_inertia',
            'line 1',
        ),
        (MINIMAL + 'controllers: [pi]', 'controllers', 'line 7'),
        (MINIMAL.replace('duration_s: 1.0', 'duration_s: 0.005'), 'duration_s', 'line 3'),
        (MINIMAL.replace('[0.6, 1.0]', '[1.0, 0.6]'), 'score_window_s', 'line 5'),
        (MINIMAL.replace('[0.6, 1.0]', '0.6'), 'score_window_s', 'line 5'),
        (MINIMAL.replace('[0.0]', '0.0'), 'engine.time_s', 'line 6'),
        (MINIMAL.replace('  duration_s: 1.0\n', ''), 'duration_s', 'mine.yaml'),
        ('- 1', '', ''),
        ('a: [', '', 'line 2'),
        (
            MINIMAL + '  duration_s: 2.0',
            '',
            'line 7',
        ),
        (MINIMAL + 'description: !!python/object/apply:os.getcwd []', '', 'line 7'),
        (MINIMAL + '  load: &a {x: *a}', '', 'line 7'),
    ],
)
def test_a_bad_scenario_is_refused_with_the_key(scenario_file, text, key, place):
    path = scenario_file(text)
    with refused(DdctError, key=key, place=place):
        load_scenario(path)


@pytest.mark.parametrize(
    'name',
    [
        *('../../../../evil', '/tmp/evil', 'a/b', '..', '.hidden', '-rf', '', ' ', 'a b', 'a\\b'),
        *('x' * 65, 'x' * 300, 'a\nb', '\x1b[31m', 'ä', '\u0000'),
    ],
)
def test_a_name_that_could_be_part_of_a_path_is_refused(scenario_file, name):
    path = scenario_file(MINIMAL + f'name: {json.dumps(name)}')
    with refused(ParameterError, key='name', place='mine.yaml: line 7'):
        load_scenario(path)
    with refused(ParameterError, key='name'):
        load_scenario('thesis', [f'name={json.dumps(name)}'])


@pytest.mark.parametrize('name', ['thesis', 'up-hill_2.5', '_x', '9', 'x' * 64])
def test_a_plain_name_is_taken(scenario_file, name):
    assert load_scenario(scenario_file(MINIMAL + f'name: "{name}"')).name == name


def test_a_file_whose_name_is_no_plain_one_needs_a_name_inside(tmp_path):
    path = tmp_path / 'up the hill.yaml'
    path.write_text(MINIMAL)
    with refused(ParameterError, key='name'):
        load_scenario(str(path))
    path.write_text(MINIMAL + 'name: hill')
    assert load_scenario(str(path)).name == 'hill'


def test_no_object_is_built_from_a_file(scenario_file, tmp_path):
    made = tmp_path / 'made'
    evil = f'description: !!python/object/apply:os.mkdir ["{made}"]'
    with refused(DdctError, place='mine.yaml: line 7'):
        load_scenario(scenario_file(MINIMAL + evil))
    assert not made.exists()


def test_text_that_reads_like_a_number_comes_back_as_text(scenario_file):
    scenario = load_scenario(scenario_file(MINIMAL + 'name: "1e-3"\ndescription: "0o7"'))
    assert load_scenario(scenario_file(scenario_to_yaml(scenario))) == scenario


@pytest.mark.parametrize('override', ['slope', '=1', 'duration_s.x=1', 'load.slope_rad=[', 'a=1'])
def test_a_bad_override_is_refused(override):
    with pytest.raises(ParameterError):
        load_scenario('thesis', [override])


@pytest.mark.parametrize(
    ('name', 'key', 'place'),
    [('nope', 'nope', ''), ('', 'scenario', ''), ('/nowhere/mine.yaml', '', 'mine.yaml')],
)
def test_an_unknown_scenario_is_refused(name, key, place):
    with refused(DdctError, key, place):
        load_scenario(name)


@pytest.mark.parametrize(
    ('setting', 'value'),
    [
        ('architecture', 'none'),
        ('mode', 'fast'),
        ('wear_gain', 0.0),
        ('wear_gain', float('nan')),
        ('seed', -1),
    ],
)
def test_a_bad_run_setting_is_named(setting, value):
    with refused(ParameterError, setting):
        RunSettings.of(load_scenario('thesis'), {setting: value})


@pytest.mark.parametrize('text', ['1e-3', '1E-3', '.1e-2', '+10e-4', '1.0e-3', '0.001'])
def test_exponents_are_numbers_as_people_write_them(text):
    assert load_scenario('thesis', [f'load.slope_rad={text}']).load.slope_rad == 0.001


def test_text_that_only_looks_like_an_exponent_stays_text():
    with refused(ParameterError, key='load.slope_rad'):
        load_scenario('thesis', ['load.slope_rad=1e'])


def test_values_that_are_set_change_neither_the_file_nor_the_group_that_was_given():
    file = ScenarioFile.read('thesis')
    before = copy.deepcopy(file.content)
    group = {'time_s': [0.0, 1.0], 'torque_n_m': [100.0, 100.0]}
    scenario = file.scenario({'engine': group, 'engine.factor': 2.0, 'load.slope_rad': 0.01})
    assert scenario.engine.torque_n_m == (200.0, 200.0)
    assert file.content == before
    assert group == {'time_s': [0.0, 1.0], 'torque_n_m': [100.0, 100.0]}
