# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A scenario is what its car, its drive and its changed keys make; errors name their file."""

from pathlib import Path

import pytest
from refusals import refused

from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.scenario.choices.scenarios import (
    Choice,
    packaged_names,
    packaged_text,
    scenario_names,
)
from ddct_plant.scenario.file import ScenarioFile, load_scenario

LAUNCH = load_scenario('launch')


@pytest.fixture
def write(tmp_path, monkeypatch):
    """Return a function that writes a file into the working directory, and returns its name."""
    monkeypatch.chdir(tmp_path)

    def written(name: str, text: str) -> str:
        path = Path(name)
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding='utf-8')
        return name

    return written


DRIVES = [each for each in packaged_names('drive') if each != 'thesis']
ENGINES_WITHOUT_LIMITS = ('c635_no_limits', 'c635_thesis')


@pytest.mark.parametrize('drive', DRIVES)
def test_every_car_whose_engine_has_limits_has_every_launch_and_shift(drive: str) -> None:
    cars = packaged_names('car')
    assert len(cars) == 4
    for car in set(cars).difference(ENGINES_WITHOUT_LIMITS):
        assert load_scenario(car=car, drive=drive).name == f'{drive}_{car}'


@pytest.mark.parametrize('drive', DRIVES)
def test_an_engine_without_limits_has_no_share_of_full_load(drive: str) -> None:
    if drive == 'tip_in':
        assert load_scenario(car='c635_no_limits', drive=drive).demand.torque_n_m[-1] == 320.0
        return
    for car in ENGINES_WITHOUT_LIMITS:
        with refused(ParameterError, 'engine.torque_share'):
            load_scenario(car=car, drive=drive)


def test_a_car_whose_clutch_is_linear_has_no_launch() -> None:
    in_n_m = ['engine.torque_n_m=[0, 140]']
    with pytest.raises(ParameterError, match='the clutch linear would ignore'):
        load_scenario(overrides=in_n_m, car='c635_thesis', drive='launch')


def test_a_car_and_a_drive_are_the_scenario_of_both() -> None:
    upshift = load_scenario(car='c635', drive='upshift')
    named = load_scenario('upshift', ['name=upshift_c635'])
    assert upshift == named


def test_a_drive_alone_has_the_car_c635_and_a_car_alone_drives_the_thesis() -> None:
    assert load_scenario(drive='upshift') == load_scenario(car='c635', drive='upshift')
    assert load_scenario(car='c635') == load_scenario('thesis', car='c635')
    assert load_scenario() == load_scenario('thesis')


def test_another_car_keeps_the_drive_and_the_changed_keys_of_a_scenario() -> None:
    hot = load_scenario('upshift_hot', car='city7')
    assert (hot.name, hot.vehicle.mass_kg) == ('upshift_hot_city7', 1150.0)
    assert (hot.friction.most_n_m, hot.friction.kiss_drift_n_m_k) == (250.0, 0.1)
    assert hot.heat.facing_c == 200.0
    gentle = load_scenario('upshift_hot', drive='launch_gentle')
    assert (gentle.name, gentle.friction.kiss_drift_n_m_k) == ('launch_gentle_c635', 0.1)


def test_a_file_has_its_values_above_those_of_its_bases(write) -> None:
    write('cars/a.yaml', 'base: c635\nfriction: {most_n_m: 300.0}\nheat: {plate_j_k: 900.0}\n')
    car = write('b.yaml', 'base: cars/a.yaml\ndescription: b\nfriction: {kiss_torque_n_m: 2.0}\n')
    made = load_scenario('launch', car=car)
    assert (made.friction.most_n_m, made.friction.kiss_torque_n_m) == (300.0, 2.0)
    assert made.heat.plate_j_k == 900.0
    assert made.engine_limits == LAUNCH.engine_limits
    files = ScenarioFile.read(Choice('launch', car=car)).files
    assert files == (Path('b.yaml'), Path('cars/a.yaml'))


def test_a_section_that_is_null_is_off_and_an_empty_one_has_its_defaults(write) -> None:
    off = write('off.yaml', 'base: city7\nengine_limits: null\nfriction: null\n')
    made = load_scenario(drive='launch', car=off, overrides=['engine.torque_n_m=[0, 140]'])
    assert (made.engine_limits, made.friction) == (None, LAUNCH.friction)
    on = write('on.yaml', 'base: off.yaml\nengine_limits: {}\n')
    assert load_scenario(drive='launch', car=on).engine_limits == LAUNCH.engine_limits
    defaults = write('defaults.yaml', 'base: city7\nengine_limits: {}\nheat: {}\n')
    made = load_scenario(drive='launch_hot', car=defaults)
    assert made.engine_limits == LAUNCH.engine_limits
    assert (made.heat.plate_j_k, made.heat.facing_c) == (1000.0, 200.0)
    drive = write('drive.yaml', 'base: launch\nclosing: null\n')
    assert load_scenario(drive=drive).closing is None


def test_a_car_without_a_base_is_whole(write) -> None:
    text = packaged_text('car', 'city7')
    usual = load_scenario(car='city7', drive='launch', overrides=['name=launch_whole'])
    assert load_scenario(car=write('whole.yaml', text), drive='launch') == usual


@pytest.mark.parametrize(
    ('removed', 'lacking'),
    [
        ('  shaft_damping: 0.008\n', 'driveline.shaft_damping'),
        ('  measured_gears: []\n', 'gearbox.measured_gears'),
        ('clutch: stick_slip ', 'clutch'),
        ('  wheel_radius_m: 0.29 ', 'two of vehicle.mass_kg, vehicle.wheel_radius_m, driveline.'),
    ],
)
def test_a_car_without_a_base_that_is_not_whole_is_refused(write, removed, lacking) -> None:
    text = packaged_text('car', 'city7')
    assert removed in text
    car = write('part.yaml', text.replace(removed, '#' if removed[-1] == ' ' else ''))
    with refused(ParameterError, 'base', 'car part.yaml') as caught:
        load_scenario(car=car, drive='launch')
    assert f'lacks {lacking}' in str(caught.value)


def test_a_car_without_a_base_may_have_sections_off_or_at_their_defaults(write) -> None:
    text = packaged_text('car', 'city7').partition('engine_limits:')[0]
    rest = 'engine_limits: null\nclutch: stick_slip\nfriction: {}\nactuator: {}\n'
    made = load_scenario(
        car=write('own.yaml', text + rest),
        drive='launch',
        overrides=['engine.torque_n_m=[0, 140]'],
    )
    assert (made.engine_limits, made.friction) == (None, LAUNCH.friction)
    with refused(ParameterError, 'base') as caught:
        load_scenario(car=write('empty.yaml', '{}'), drive='launch')
    assert 'lacks load, driveline, gearbox, engine_limits, clutch, friction, actuator, two of' in (
        str(caught.value)
    )


def test_points_and_a_file_with_a_profile_replace_each_other_and_a_factor_those_of_a_base(
    write,
) -> None:
    write('data/pedal.csv', 't,c\n0,10\n1,20\n')
    csv = '{csv: pedal.csv, time: t, value: c, unit: N m}'
    write('data/logged.yaml', f'base: launch\nengine: {csv}\n')
    assert load_scenario(drive='data/logged.yaml').engine.torque_n_m == (10.0, 20.0)
    half = write('half.yaml', 'base: data/logged.yaml\nengine: {factor: 0.5}\n')
    assert load_scenario(drive=half).engine.torque_n_m == (5.0, 10.0)
    points = write('points.yaml', 'base: half.yaml\nengine: {time_s: [0.0], torque_n_m: [7.0]}\n')
    assert load_scenario(drive=points).engine.torque_n_m == (7.0,)
    files = ScenarioFile.read(Choice(drive=half)).files
    assert files == (Path('half.yaml'), Path('data/logged.yaml'), Path('data/pedal.csv'))


@pytest.mark.parametrize(
    ('own', 'time_s', 'torque_share', 'torque_n_m'),
    [
        ('torque_share: [0.0, 0.7]', (0.0, 0.6), (0.0, 0.7), ()),
        ('torque_n_m: [0.0, 90.0]', (0.0, 0.6), (), (0.0, 90.0)),
        ('time_s: [0.0, 0.8]', (0.0, 0.8), (0.0, 0.56), ()),
    ],
)
def test_times_or_values_of_a_profile_alone_keep_the_others_of_the_base(
    write, own, time_s, torque_share, torque_n_m
) -> None:
    drive = write('drive.yaml', f'base: launch\nengine: {{{own}}}\n')
    engine = load_scenario(drive=drive).engine
    assert (engine.time_s, engine.torque_share) == (time_s, torque_share)
    assert engine.torque_n_m == torque_n_m


def test_a_scenario_has_a_car_and_a_drive_within_it_or_names_those_beside_it(write) -> None:
    write('mine/car.yaml', 'base: city7\nvehicle: {wheel_radius_m: 0.3}\n')
    text = 'car: car.yaml\ndrive:\n  base: launch\n  load: {slope_rad: 0.05}\nset:\n'
    file = write(
        'mine/hill.yaml', f'{text}  load.slope_rad: 0.1\n  friction: {{most_n_m: 99.0}}\n'
    )
    made = load_scenario(file)
    assert (made.name, made.vehicle.wheel_radius_m) == ('hill', 0.3)
    assert (made.load.slope_rad, made.load.rolling_coefficient) == (0.1, 0.011)
    assert made.friction.most_n_m == 99.0
    assert made.description == LAUNCH.description
    assert load_scenario(file, ['load.slope_rad=0.2']).load.slope_rad == 0.2
    assert load_scenario(file, car='c635').name == 'hill_c635'


def test_a_bad_value_is_refused_with_the_file_in_which_it_stands(write) -> None:
    write('base.yaml', 'base: c635\nfriction:\n  most_n_m: -1.0\n')
    car = write('car.yaml', '\nbase: base.yaml\n')
    with refused(ParameterError, 'friction.most_n_m', 'car base.yaml: line 3'):
        load_scenario('launch', car=car)
    with refused(ParameterError, 'friction.most_n_m', 'scenario launch'):
        load_scenario('launch', ['friction.most_n_m=-2.0'], car=car)
    file = write('mine.yaml', 'car: c635\ndrive: launch\nset:\n  load.slope_rad: steep\n')
    with refused(ParameterError, 'load.slope_rad', 'scenario mine.yaml: line 4'):
        load_scenario(file)
    drive = write('drive.yaml', 'duration_s: 1.0\ncontrol_start_s: 0.5\nscore_window_s: [0, 1]\n')
    with refused(ParameterError, 'engine', f'drive {drive}'):
        load_scenario(drive=drive)


@pytest.mark.parametrize(
    ('chosen', 'key', 'said'),
    [
        ({'car': 'city8'}, 'city8', 'did you mean city7?'),
        ({'car': 'x'}, 'x', 'choose from c635, c635_no_limits, c635_thesis, city7'),
        ({'drive': 'upshfit'}, 'upshfit', 'did you mean upshift?'),
        ({'scenario': 'luanch'}, 'luanch', 'did you mean launch?'),
        ({'car': ''}, 'car', 'give a name or a YAML file'),
        ({'drive': 'nowhere/x.yaml'}, '', 'cannot be read'),
    ],
)
def test_an_unknown_name_is_refused_with_a_similar_one(chosen, key: str, said: str) -> None:
    with refused(DdctError, key=key) as caught:
        load_scenario(**chosen)
    assert said in str(caught.value)


@pytest.mark.parametrize(
    ('text', 'key', 'line'),
    [
        ('car: c635\n', 'drive', ''),
        ('drive: launch\n', 'car', ''),
        ('car: 3\ndrive: launch\n', 'car', ': line 1'),
        ('car: c63\ndrive: launch\n', 'c63', ': line 1'),
        ('car: {base: c63}\ndrive: launch\n', 'c63', ': line 1'),
        ('car: c635\ndrive: launch\nset: 3\n', 'set', ': line 3'),
        ('car: c635\ndrive: launch\nset: {lod: 1}\n', 'lod', ': line 3'),
        ('car: c635\ndrive: launch\nsett: {}\n', 'sett', ': line 3'),
        ('schema_version: 3\ncar: c635\ndrive: launch\n', 'schema_version', ': line 1'),
    ],
)
def test_a_bad_scenario_file_is_refused_by_key_and_line(write, text, key, line) -> None:
    file = write('mine.yaml', text)
    with refused(DdctError, key=key) as caught:
        load_scenario(file)
    assert str(caught.value).startswith(f'scenario mine.yaml{line}: ')


def test_a_base_that_leads_to_itself_is_refused(write) -> None:
    write('a.yaml', 'base: ./b.yaml\n')
    car = write('b.yaml', 'base: a.yaml\n')
    with refused(ParameterError, key='base') as caught:
        load_scenario('launch', car=car)
    assert 'b.yaml -> a.yaml -> b.yaml' in str(caught.value)


def test_keys_of_a_scenario_of_before_are_refused_with_the_nouns_that_they_moved_to(write) -> None:
    file = write(
        'old.yaml',
        'schema_version: 1\nduration_s: 1.0\nload: {slope_rad: 0.1, drag_coefficient: 0.3}\n'
        'friction: {most_n_m: 300.0}\nengine: {time_s: [0.0], torque_n_m: [9.0]}\n',
    )
    with refused(ParameterError, key='duration_s', place='scenario old.yaml: line 2') as caught:
        load_scenario(file)
    said = str(caught.value)
    assert 'load.drag_coefficient, friction to the car' in said
    assert 'duration_s, load.slope_rad, engine to the drive' in said
    assert 'convert_scenario' in said


def test_the_packaged_scenarios_are_made_of_packaged_parts() -> None:
    assert [name for name in scenario_names() if ScenarioFile.read(name).files] == []


def test_an_unknown_section_of_an_override_is_placed_where_it_is_given() -> None:
    with refused(ParameterError, 'sensors.engin_speed', 'scenario thesis'):
        load_scenario('thesis', ['sensors.engin_speed.noise_rad_s=3'])
