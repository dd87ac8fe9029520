# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Values that follow from others: of the vehicle, of a gear; those that contradict are refused."""

import pytest
import yaml

from ddct_plant.base.errors import ParameterError
from ddct_plant.models.gearbox import EngagedGear, Gearbox
from ddct_plant.scenario.file import ScenarioFile, load_scenario, scenario_digest, scenario_to_yaml

THESIS = load_scenario('thesis')
RADIUS = THESIS.vehicle.wheel_radius_m
MINIMAL = """\
duration_s: 3.0
control_start_s: 0.6
score_window_s: [0.6, 1.7]
engine: {time_s: [0.0], torque_n_m: [100.0]}
"""
FILE = 'driveline: {total_ratio: 16.06}'


def changed(*overrides):
    return load_scenario('thesis', overrides)


def from_file(tmp_path, car, *overrides, drive=''):
    """Return the scenario of a drive and of the car of the thesis, with more text in both."""
    (tmp_path / 'drive.yaml').write_text(MINIMAL + drive)
    base = '' if 'base:' in car else 'base: c635_thesis\n'
    (tmp_path / 'car.yaml').write_text(base + car)
    files = {noun: str(tmp_path / f'{noun}.yaml') for noun in ('car', 'drive')}
    return load_scenario(overrides=overrides, **files)


def the_line(scenario):
    (line,) = scenario.adjusted
    return line


def test_the_defaults_agree_without_a_remark():
    assert THESIS.adjusted == ()
    assert THESIS.gear == 2
    published = Gearbox(measured_gears=(), measured_ratios=()).gear(2)
    assert published.shaft_ratio(THESIS.driveline.gear) == pytest.approx(1.0, rel=3e-4)


def test_a_key_that_was_added_leaves_the_digest_of_the_thesis_and_a_moved_one_has_another():
    assert scenario_digest(THESIS) == 'e930082b5253a695'
    assert scenario_digest(changed('gear=1')) != scenario_digest(THESIS)


@pytest.mark.parametrize(
    'override',
    [
        'vehicle.mass_kg=1500',
        'gear=2',
        'control_start_s=0.6',
        'score_window_s=[0.8, 1.7]',
    ],
)
def test_what_is_given_as_it_was_moves_nothing(override):
    again = changed(override)
    assert again.adjusted == ()
    assert again.driveline == THESIS.driveline


@pytest.mark.parametrize(
    ('overrides', 'mass', 'radius', 'inertia'),
    [
        (('vehicle.mass_kg=1800',), 1800.0, RADIUS, 1800.0 * (RADIUS * RADIUS)),
        (('vehicle.wheel_radius_m=0.3',), 1500.0, 0.3, 135.0),
        (('driveline.vehicle_inertia=180',), 1500.0, 0.12**0.5, 180.0),
        (('vehicle.mass_kg=1800', 'vehicle.wheel_radius_m=0.3'), 1800.0, 0.3, 162.0),
        (('vehicle.mass_kg=1800', 'driveline.vehicle_inertia=180'), 1800.0, 0.1**0.5, 180.0),
        (('driveline.vehicle_inertia=180', 'vehicle.wheel_radius_m=0.3'), 2000.0, 0.3, 180.0),
        (('vehicle={mass_kg: 1800}',), 1800.0, RADIUS, 1800.0 * (RADIUS * RADIUS)),
        (('vehicle={gravity_m_s2: 9.8}',), 1500.0, RADIUS, 154.69105),
        (('driveline.vehicle_inertia=null',), 1500.0, RADIUS, 154.69105),
    ],
)
def test_one_or_two_of_mass_radius_and_inertia_give_the_others(overrides, mass, radius, inertia):
    for scenario in (changed(*overrides), load_scenario('thesis', numbers(overrides))):
        vehicle = scenario.vehicle
        assert (vehicle.mass_kg, vehicle.wheel_radius_m) == pytest.approx(
            (mass, radius), rel=1e-15
        )
        assert scenario.driveline.vehicle_inertia == pytest.approx(inertia, rel=1e-15)
        assert scenario.adjusted == ()


def numbers(overrides):
    """Return overrides as values by key, numbers as float."""
    pairs = [each.split('=') for each in overrides]
    return {key: yaml.safe_load(text) for key, text in pairs}


def test_runs_that_vary_numbers_alone_have_the_scenario_of_any_other_way():
    file = ScenarioFile.read('thesis')
    for mass in (1700.0, 1800.0):
        varied = {'vehicle.mass_kg': mass, 'load.slope_rad': 0.01}
        assert file.scenario(varied) == load_scenario('thesis', varied)


def test_a_gear_gives_its_ratio(tmp_path):
    first = changed('gear=1')
    assert first.driveline.gear == EngagedGear(3.9 * 4.118)
    assert first.adjusted == ()
    measured = changed('gear=1', 'gearbox.measured_gears=[1]', 'gearbox.measured_ratios=[16.1]')
    assert measured.driveline.gear == EngagedGear(16.1)
    assert from_file(tmp_path, '', 'gear=1', drive='gear: 3').driveline == first.driveline


def test_a_total_ratio_is_no_key_and_the_refusal_names_those_that_give_it(tmp_path):
    for given in (
        lambda: changed('driveline.total_ratio=16.06'),
        lambda: from_file(tmp_path, FILE),
    ):
        with pytest.raises(ParameterError, match=r'give gear, .* gearbox\.measured_ratios'):
            given()


def test_the_score_window_stays_where_control_start_moves():
    later = changed('control_start_s=1')
    assert later.score_window_s == (0.6, 1.7)
    assert 'score_window_s [0.6, 1.7] begins before control_start_s, 1 s' in the_line(later)


def test_three_values_are_taken_as_given_when_they_agree_to_a_thousandth():
    three = ('vehicle.mass_kg=1800', 'driveline.vehicle_inertia=185.6')
    both = changed(*three, f'vehicle.wheel_radius_m={RADIUS:.4f}')
    assert both.adjusted == ()
    assert both.driveline.vehicle_inertia == 185.6
    assert both.vehicle.wheel_radius_m == 0.3211


@pytest.mark.parametrize(
    ('overrides', 'complaint'),
    [
        (
            (
                'vehicle.mass_kg=1800',
                'vehicle.wheel_radius_m=0.3',
                'driveline.vehicle_inertia=154.69',
            ),
            'vehicle.mass_kg is 1800, vehicle.wheel_radius_m is 0.3 and driveline.vehicle_inertia '
            'is 154.69, but m_v r_w^2 is 162 kg m^2',
        ),
        (('control_start_s=2.5',), 'score_window_s ends at 1.7 s, before control_start_s, 2.5 s'),
        (('score_window_s=[0.2, 0.5]',), 'score_window_s ends at 0.5 s, before control_start_s'),
        (('driveline.vehicle_inertia=9', 'vehicle.wheel_radius_m=1e-300'), 'm_v r_w^2 is 0 kg'),
        (('vehicle.wheel_radius_m=1e300',), 'vehicle.wheel_radius_m is 1e+300'),
        (('vehicle.mass_kg=1e308', 'vehicle.wheel_radius_m=1e5'), 'm_v r_w^2 is inf'),
        (('vehicle.mass_kg=0',), 'vehicle.mass_kg is 0'),
    ],
)
def test_what_contradicts_or_scores_nothing_is_refused_with_what_is_needed(overrides, complaint):
    with pytest.raises(ParameterError) as refusal:
        changed(*overrides)
    assert complaint in str(refusal.value)


def test_a_car_that_gives_one_value_is_treated_as_an_override_of_its_base(tmp_path):
    heavy = from_file(tmp_path, 'vehicle: {mass_kg: 1800.0}')
    assert heavy.driveline == changed('vehicle.mass_kg=1800').driveline
    assert heavy.vehicle == changed('vehicle.mass_kg=1800').vehicle
    contradicting = 'base: c635\nvehicle: {mass_kg: 1800, wheel_radius_m: 0.3}\n'
    with pytest.raises(ParameterError, match='give two of them'):
        from_file(tmp_path, f'{contradicting}driveline: {{vehicle_inertia: 154.0}}')


def test_an_override_of_a_car_keeps_what_its_values_gave(tmp_path):
    given = 'vehicle: {mass_kg: 1800.0}\ndriveline: {vehicle_inertia: 180.0}'
    radius = from_file(tmp_path, given).vehicle.wheel_radius_m
    assert radius == pytest.approx(0.1**0.5)
    again = from_file(tmp_path, given, 'vehicle.mass_kg=2000')
    assert again.driveline.vehicle_inertia == 2000.0 * (radius * radius)
    by_radius = from_file(tmp_path, given, 'vehicle.wheel_radius_m=0.3')
    assert by_radius.driveline.vehicle_inertia == pytest.approx(162.0)
    assert by_radius.vehicle.mass_kg == 1800.0
    group = from_file(tmp_path, given, 'vehicle={mass_kg: 2000}')
    assert group.driveline == again.driveline


def test_a_window_that_begins_before_control_is_kept_and_named():
    early = changed('score_window_s=[0.2, 1.7]')
    assert early.score_window_s == (0.2, 1.7)
    assert 'begins before control_start_s, 0.6 s' in the_line(early)


@pytest.mark.parametrize(
    'overrides',
    [
        ('vehicle.mass_kg=1800', 'control_start_s=1'),
        ('vehicle.mass_kg=1800', 'driveline.vehicle_inertia=185.6'),
        ('driveline.vehicle_inertia=180.3',),
        ('initial={speed_km_h: 30}',),
        ('gear=1', 'score_window_s=[0.2, 1.7]'),
    ],
)
def test_a_changed_scenario_is_the_same_after_writing_and_reading(tmp_path, overrides):
    moved = changed(*overrides)
    path = tmp_path / 'again.yaml'
    path.write_text(scenario_to_yaml(moved))
    again = load_scenario(str(path))
    assert again == moved
    assert scenario_digest(again) == scenario_digest(moved)
