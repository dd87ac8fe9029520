# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Profiles from CSV files become points of the scenario, or are refused by file, line, column."""

import math

import pytest
from refusals import refused

from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.csv_profiles import MOST_ROWS
from ddct_plant.scenario.file import load_scenario, scenario_digest, scenario_to_yaml

HEAD = 'duration_s: 1.0\ncontrol_start_s: 0.6\nscore_window_s: [0.6, 1.0]\n'
SPEC = 'engine: {csv: data/pedal.csv, time: t, value: torque, unit: N m}\n'
PEDAL = '# of the bench\nt,other,torque\n0.0,x,100.0\n0.5,y,150.0\n'


@pytest.fixture
def folder(tmp_path):
    (tmp_path / 'data').mkdir()
    (tmp_path / 'data' / 'pedal.csv').write_text(PEDAL)
    return tmp_path


def load(folder, text=HEAD + SPEC, overrides=()):
    (folder / 'mine.yaml').write_text(text)
    drive = str(folder / 'mine.yaml')
    return load_scenario(overrides=overrides, car='c635_no_limits', drive=drive)


def again(folder, scenario):
    """Return a scenario that was written and read again."""
    (folder / 'written.yaml').write_text(scenario_to_yaml(scenario))
    return load_scenario(str(folder / 'written.yaml'))


def test_a_file_beside_the_scenario_gives_its_points_and_other_columns_do_not_matter(folder):
    engine = load(folder).engine
    assert engine.time_s == (0.0, 0.5)
    assert engine.torque_n_m == (100.0, 150.0)


def test_what_is_written_for_the_nodes_and_the_bag_holds_the_points_itself(folder):
    scenario = load(folder)
    (folder / 'data' / 'pedal.csv').unlink()
    assert again(folder, scenario) == scenario
    assert scenario_digest(again(folder, scenario)) == scenario_digest(scenario)


def test_another_value_in_the_file_is_another_digest(folder):
    before = scenario_digest(load(folder))
    (folder / 'data' / 'pedal.csv').write_text(PEDAL.replace('150.0', '150.1'))
    assert scenario_digest(load(folder)) != before


def test_a_file_that_set_names_is_relative_to_the_working_directory(folder, monkeypatch):
    monkeypatch.chdir(folder / 'data')
    changes = ['engine={csv: pedal.csv, time: t, value: torque, unit: N m}']
    assert load_scenario('thesis', changes).engine.torque_n_m == (100.0, 150.0)
    single = [f'engine.{pair}' for pair in ('csv=pedal.csv', 'time=t', 'value=torque', 'unit=N m')]
    assert load_scenario('thesis', single).engine.torque_n_m == (100.0, 150.0)


def test_set_names_a_file_of_the_working_directory_for_a_scenario_of_another_folder(
    folder, tmp_path_factory, monkeypatch
):
    elsewhere = tmp_path_factory.mktemp('elsewhere')
    (elsewhere / 'data').mkdir()
    (elsewhere / 'data' / 'pedal.csv').write_text(PEDAL.replace('150.0', '170.0'))
    monkeypatch.chdir(elsewhere)
    assert load(folder).engine.torque_n_m == (100.0, 150.0)
    changed = load(folder, overrides=['engine.csv=data/pedal.csv'])
    assert changed.engine.torque_n_m == (100.0, 170.0)
    (elsewhere / 'data' / 'pedal.csv').unlink()
    with refused(ParameterError, place='data/pedal.csv'):
        load(folder, overrides=['engine.csv=data/pedal.csv'])


def test_points_that_set_gives_replace_the_file(folder):
    changes = ['engine.time_s=[0.0]', 'engine.torque_n_m=[7.0]']
    assert load(folder, overrides=changes).engine.torque_n_m == (7.0,)


@pytest.mark.parametrize(
    ('section', 'unit', 'cells', 'key', 'expected'),
    [
        ('engine_speed_reference', 'rpm', ('3000', '1500'), 'speed_rad_s', math.pi * 100.0),
        ('brake', 'kN m', ('1.5', '0'), 'torque_n_m', 1500.0),
        ('slope', '%', ('10', '-5'), 'slope_rad', math.atan(0.1)),
        ('slope', 'deg', ('9', '-5'), 'slope_rad', math.pi / 20.0),
        ('slip_reference', 'rad/s', ('-30', '0'), 'slip_rad_s', -30.0),
    ],
)
def test_every_profile_takes_a_file_in_its_units(folder, section, unit, cells, key, expected):
    (folder / 'p.csv').write_text(f'ms;x\n20000;{cells[0]}\n20600,5;{cells[1]}\n')
    spec = f'{{csv: p.csv, time: ms, value: x, unit: {unit}, time_unit: ms, start_s: 20}}'
    found = getattr(
        load(folder, f'{HEAD}{SPEC}{section}: {spec.replace("%", repr("%"))}\n'), section
    )
    assert found.time_s == pytest.approx((0.0, 0.6005))
    assert getattr(found, key)[0] == pytest.approx(expected)


@pytest.mark.parametrize(
    ('old', 'new', 'key', 'place'),
    [
        ('0.5,y', '0.0,y', '', 'line 4, column t'),
        ('0.0,x', '0.1,x', '', 'line 3, column t'),
        ('150.0', 'nan', 'engine.csv', 'line 4, column torque'),
        ('150.0', '', 'engine.csv', 'line 4, column torque'),
        ('150.0', 'inf', '', 'line 4, column torque'),
        ('150.0', 'much', '', 'line 4, column torque'),
        ('150.0', '-1', 'engine.csv', 'line 4, column torque'),
        (',150.0', '', '', 'line 4'),
        ('t,other,torque', 't,other,torgue', 'torque', 'pedal.csv'),
        ('t,other,torque', 't,torque,torque', 'torque', 'pedal.csv'),
        ('0.0,x,100.0\n0.5,y,150.0\n', '', '', 'pedal.csv'),
        (PEDAL, '# nothing\n', '', 'pedal.csv'),
    ],
)
def test_a_bad_file_is_refused_by_its_name_line_and_column(folder, old, new, key, place):
    file = folder / 'data' / 'pedal.csv'
    file.write_text(PEDAL.replace(old, new))
    with refused(ParameterError, key=key, place=place):
        load(folder)


@pytest.mark.parametrize('cell', ['nan', '1e9'])
def test_a_bad_number_is_placed_in_the_file_that_names_the_csv_file_and_not_in_its_base(
    folder, cell
):
    (folder / 'data' / 'pedal.csv').write_text(PEDAL.replace('150.0', cell))
    with refused(ParameterError, key='engine.csv', place='line 4, column torque') as caught:
        load(folder, f'base: tip_in\n{SPEC}')
    assert f'{folder}/mine.yaml: line 2: engine.csv: ' in str(caught.value)


@pytest.mark.parametrize(
    ('spec', 'key', 'place'),
    [
        ('{csv: none.csv, time: t, value: torque, unit: N m}', '', 'none.csv'),
        (
            '{csv: data/pedal.csv, time: t, value: torque}',
            'engine.unit',
            'line 4',
        ),
        (
            SPEC[8:-2] + ', colour: red}',
            'engine.colour',
            'line 4',
        ),
        (SPEC[8:-2].replace('N m', 'rpm') + '}', '', ''),
        (SPEC[8:-2] + ', time_unit: h}', '', ''),
        (SPEC[8:-2] + ', time_s: [0.0]}', 'engine', 'line 4'),
        (SPEC[8:-2] + ', start_s: soon}', 'engine.start_s', 'line 4'),
        (SPEC[8:-2].replace(': t,', ': 3,') + '}', 'engine.time', 'line 4'),
    ],
)
def test_a_bad_description_of_a_file_is_refused_by_its_key(folder, spec, key, place):
    with refused(ParameterError, key=key, place=place):
        load(folder, f'{HEAD}engine: {spec}\n')


def test_a_file_that_is_set_without_its_description_is_refused_with_the_missing_keys():
    with refused(ParameterError, key='engine.time'):
        load_scenario('thesis', ['engine.csv=pedal.csv'])


def test_one_row_too_many_is_refused_and_the_most_are_the_same_after_writing_and_reading(folder):
    rows = [f'{k / 100!r},x,{100.0 + math.sin(k)!r}\n' for k in range(MOST_ROWS + 1)]
    file = folder / 'data' / 'pedal.csv'
    file.write_text('t,other,torque\n' + ''.join(rows[:-1]))
    scenario = load(folder)
    assert again(folder, scenario).engine == scenario.engine
    file.write_text('t,other,torque\n' + ''.join(rows))
    with refused(ParameterError, place='pedal.csv: line 2002, column t'):
        load(folder)


def test_a_slope_profile_and_a_constant_slope_do_not_go_together(folder):
    text = f'{HEAD}{SPEC}slope: {{time_s: [0.0], slope_rad: [0.1]}}\n'
    with refused(ParameterError, key='slope', place='mine.yaml: line 5'):
        load(folder, text, ['load.slope_rad=0.2'])


def test_a_factor_multiplies_the_values_of_a_profile(folder):
    plain = load_scenario('thesis').engine
    scaled = load_scenario('thesis', ['engine.factor=1.5']).engine
    assert scaled.time_s == plain.time_s
    assert scaled.torque_n_m == tuple(1.5 * torque for torque in plain.torque_n_m)
    of_file = load(folder, HEAD + SPEC.replace('N m}', 'N m, factor: 0.5}')).engine
    assert of_file.torque_n_m == (50.0, 75.0)
    uphill = ['slope.time_s=[0.0]', 'slope.slope_rad=[0.1]', 'slope.factor=-1']
    assert load_scenario('thesis', uphill).slope.slope_rad == (-0.1,)


@pytest.mark.parametrize(
    ('change', 'key'),
    [
        ('engine.factor=much', 'engine.factor'),
        ('engine.factor=-1', 'engine.torque_n_m[1]'),
        ('load.factor=2', 'load.factor'),
    ],
)
def test_a_factor_that_cannot_be_used_is_named(change, key):
    with refused(ParameterError, key=key):
        load_scenario('thesis', [change])
