# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Scenarios are read whole or refused with the key that is wrong."""

import copy
import json

import pytest

from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.scenario.file import (
    ScenarioFile,
    load_scenario,
    scenario_digest,
    scenario_names,
    scenario_to_yaml,
)
from ddct_plant.scenario.settings import RunSettings

MINIMAL = """\
duration_s: 1.0
control_start_s: 0.6
score_window_s: [0.6, 1.0]
engine: {time_s: [0.0], torque_n_m: [100.0]}
"""


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


def test_a_scenario_survives_its_yaml_to_the_last_bit(scenario_file):
    scenario = load_scenario('thesis', ['load.slope_rad=0.1'])
    again = load_scenario(scenario_file(scenario_to_yaml(scenario)))
    assert again == scenario
    assert scenario_digest(again) == scenario_digest(scenario)


def test_a_scenario_may_have_a_schema_version_and_a_written_one_does(scenario_file):
    without = load_scenario(scenario_file(MINIMAL))
    assert load_scenario(scenario_file(f'schema_version: 1\n{MINIMAL}')) == without
    assert scenario_to_yaml(without).startswith('schema_version: 1\n')


@pytest.mark.parametrize(
    ('version', 'complaint'),
    [
        ('2', 'schema_version is 2, this version reads up to 1: update the project'),
        ('0', 'schema_version is 0: give a whole number from 1 to 1'),
        ('1.0', 'schema_version is 1.0: give a whole number'),
        ('true', 'schema_version is True: give a whole number'),
    ],
)
def test_a_schema_version_that_is_not_known_is_refused(scenario_file, version, complaint):
    with pytest.raises(DdctError, match=f'mine.yaml: line 1: {complaint}'):
        load_scenario(scenario_file(f'schema_version: {version}\n{MINIMAL}'))


def test_a_file_without_a_name_is_named_after_itself(scenario_file):
    assert load_scenario(scenario_file(MINIMAL)).name == 'mine'


def test_an_override_changes_one_key_and_the_digest(scenario_file):
    path = scenario_file(MINIMAL)
    changed = load_scenario(path, ['load.slope_rad=0.05'])
    assert changed.load.slope_rad == 0.05
    assert scenario_digest(changed) != scenario_digest(load_scenario(path))


@pytest.mark.parametrize(
    ('text', 'complaint'),
    [
        (MINIMAL + 'lod: {}', 'unknown key lod: did you mean load?'),
        (MINIMAL + 'load: {slope_deg: 1.0}', 'did you mean load.slope_rad'),
        (MINIMAL + 'load: {slope_rad: .nan}', 'load.slope_rad is nan'),
        (MINIMAL + 'load: {slope_rad: steep}', "load.slope_rad is 'steep'"),
        (MINIMAL + 'load: 3', 'load: give keys and values'),
        (MINIMAL + 'reference: {slope_rad_s2: -1.0}', 'reference.slope_rad_s2 is -1'),
        (MINIMAL + 'reference: {shape: step}', "unknown reference.shape 'step': choose from ramp"),
        (MINIMAL + 'reference: {shape: 1}', 'reference.shape is 1: give text'),
        (MINIMAL + 'reference: {reference_end_s: 0.905}', 'reference.reference_end_s is 0.905'),
        (MINIMAL + 'driveline: {vehicle_inertia: 0.0}', 'driveline.vehicle_inertia is 0'),
        (MINIMAL + 'controllers: [pi]', 'controllers: give gains by controller name'),
        (MINIMAL.replace('1.0\ncontrol', '0.005\ncontrol'), 'duration_s is 0.005'),
        (MINIMAL.replace('[0.6, 1.0]', '[1.0, 0.6]'), 'score_window_s ends at 0.6'),
        (MINIMAL.replace('[0.6, 1.0]', '0.6'), 'score_window_s'),
        (MINIMAL.replace('[0.0]', '0.0'), 'engine.time_s'),
        (MINIMAL.replace('duration_s: 1.0\n', ''), 'key duration_s is missing'),
        ('- 1', 'must be a mapping'),
        ('a: [', 'not valid YAML'),
        (
            MINIMAL + 'duration_s: 2.0',
            "line 5: the key 'duration_s' is given twice, first in line 1",
        ),
        (MINIMAL + 'description: !!python/object/apply:os.getcwd []', 'the tag'),
        (MINIMAL + 'load: &a {x: *a}', 'the alias *a'),
        ('[' * 2000, 'nested more than'),
    ],
)
def test_a_bad_scenario_is_refused_with_the_key(scenario_file, text, complaint):
    path = scenario_file(text)
    with pytest.raises(DdctError) as caught:
        load_scenario(path)
    assert complaint in str(caught.value)
    assert '\n' not in str(caught.value)


@pytest.mark.parametrize(
    'name',
    [
        *('../../../../evil', '/tmp/evil', 'a/b', '..', '.hidden', '-rf', '', ' ', 'a b', 'a\\b'),
        *('x' * 65, 'x' * 300, 'a\nb', '\x1b[31m', 'ä', '\u0000'),
    ],
)
def test_a_name_that_could_be_part_of_a_path_is_refused(scenario_file, name):
    path = scenario_file(MINIMAL + f'name: {json.dumps(name)}')
    with pytest.raises(ParameterError, match='name is .*use up to 64 letters'):
        load_scenario(path)
    with pytest.raises(ParameterError, match='name is .*use up to 64 letters'):
        load_scenario('thesis', [f'name={json.dumps(name)}'])


@pytest.mark.parametrize('name', ['thesis', 'up-hill_2.5', '_x', '9', 'x' * 64])
def test_a_plain_name_is_taken(scenario_file, name):
    assert load_scenario(scenario_file(MINIMAL + f'name: "{name}"')).name == name


def test_a_file_whose_name_is_no_plain_one_needs_a_name_inside(tmp_path):
    path = tmp_path / 'up the hill.yaml'
    path.write_text(MINIMAL)
    with pytest.raises(ParameterError, match="name is 'up the hill'"):
        load_scenario(str(path))
    path.write_text(MINIMAL + 'name: hill')
    assert load_scenario(str(path)).name == 'hill'


def test_no_object_is_built_from_a_file(scenario_file, tmp_path):
    made = tmp_path / 'made'
    evil = f'description: !!python/object/apply:os.mkdir ["{made}"]'
    with pytest.raises(DdctError, match='the tag'):
        load_scenario(scenario_file(MINIMAL + evil))
    assert not made.exists()


def test_text_that_reads_like_a_number_comes_back_as_text(scenario_file):
    scenario = load_scenario(scenario_file(MINIMAL + 'name: "1e-3"\ndescription: "0o7"'))
    assert load_scenario(scenario_file(scenario_to_yaml(scenario))) == scenario


@pytest.mark.parametrize('override', ['slope', '=1', 'duration_s.x=1', 'load.slope_rad=[', 'a=1'])
def test_a_bad_override_is_refused(override):
    with pytest.raises(ParameterError):
        load_scenario('thesis', [override])


@pytest.mark.parametrize('name', ['nope', '', '/nowhere/mine.yaml'])
def test_an_unknown_scenario_is_refused(name):
    with pytest.raises(DdctError, match='scenario'):
        load_scenario(name)


@pytest.mark.parametrize(
    ('setting', 'value'),
    [
        ('architecture', 'none'),
        ('clutch', 'sticky'),
        ('mode', 'fast'),
        ('wear_gain', 0.0),
        ('wear_gain', float('nan')),
        ('seed', -1),
    ],
)
def test_a_bad_run_setting_is_named(setting, value):
    with pytest.raises(ParameterError, match=setting):
        RunSettings(load_scenario('thesis'), **{setting: value})


@pytest.mark.parametrize('text', ['1e-3', '1E-3', '.1e-2', '+10e-4', '1.0e-3', '0.001'])
def test_exponents_are_numbers_as_people_write_them(text):
    assert load_scenario('thesis', [f'load.slope_rad={text}']).load.slope_rad == 0.001


def test_text_that_only_looks_like_an_exponent_stays_text():
    with pytest.raises(ParameterError, match='give a number'):
        load_scenario('thesis', ['load.slope_rad=1e'])


def test_values_that_are_set_change_neither_the_file_nor_the_group_that_was_given():
    file = ScenarioFile.read('thesis')
    before = copy.deepcopy(file.content)
    group = {'time_s': [0.0, 1.0], 'torque_n_m': [100.0, 100.0]}
    scenario = file.scenario({'engine': group, 'engine.factor': 2.0, 'load.slope_rad': 0.01})
    assert scenario.engine.torque_n_m == (200.0, 200.0)
    assert file.content == before
    assert group == {'time_s': [0.0, 1.0], 'torque_n_m': [100.0, 100.0]}
