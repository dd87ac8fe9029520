# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""One value of a pair moves the other, with a remark; halves that contradict are refused."""

import pytest

from ddct_plant.base.errors import ParameterError
from ddct_plant.models.gearbox import EngagedGear, Gearbox
from ddct_plant.scenario.file import load_scenario, scenario_digest, scenario_to_yaml

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
    """Return the scenario of a drive and of a car without limits, with more text in both."""
    (tmp_path / 'drive.yaml').write_text(MINIMAL + drive)
    (tmp_path / 'car.yaml').write_text(car or '{}')
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


def test_the_inertia_follows_the_mass():
    heavy = changed('vehicle.mass_kg=1800')
    assert heavy.driveline.vehicle_inertia == 1800.0 * (RADIUS * RADIUS)
    assert 'driveline.vehicle_inertia moved from 154.691 to 185.629' in the_line(heavy)


def test_the_inertia_follows_the_radius_and_the_mass_stays():
    small = changed('vehicle.wheel_radius_m=0.3')
    assert small.driveline.vehicle_inertia == pytest.approx(135.0)
    assert small.vehicle.mass_kg == 1500.0
    assert 'driveline.vehicle_inertia moved' in the_line(small)


@pytest.mark.parametrize('more', [(), ('vehicle.wheel_radius_m=0.3',)])
def test_the_mass_follows_the_inertia_and_the_radius_stays(more):
    heavy = changed('driveline.vehicle_inertia=180', *more)
    assert heavy.driveline.vehicle_inertia == 180.0
    assert heavy.vehicle.wheel_radius_m == (0.3 if more else RADIUS)
    assert heavy.vehicle.mass_kg == pytest.approx(180.0 / heavy.vehicle.wheel_radius_m**2)
    assert 'vehicle.mass_kg moved from 1500' in the_line(heavy)


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


def test_the_score_window_moves_with_control_start():
    later = changed('control_start_s=1')
    assert later.score_window_s == (1.0, 2.1)
    assert 'score_window_s moved from [0.6, 1.7] to [1.0, 2.1] s' in the_line(later)


@pytest.mark.parametrize(
    'overrides',
    [
        ('vehicle.mass_kg=1800', 'driveline.vehicle_inertia=185.6'),
        ('control_start_s=1', 'score_window_s=[1.1, 1.9]'),
    ],
)
def test_both_halves_are_taken_as_given_when_they_agree_to_a_thousandth(overrides):
    both = changed(*overrides)
    assert both.adjusted == ()
    assert both.driveline.vehicle_inertia in (185.6, THESIS.driveline.vehicle_inertia)
    assert both.score_window_s in ((1.1, 1.9), THESIS.score_window_s)


@pytest.mark.parametrize(
    ('overrides', 'complaint'),
    [
        (
            ('vehicle.mass_kg=1800', 'driveline.vehicle_inertia=154.69'),
            'give driveline.vehicle_inertia 185.629 or vehicle.mass_kg 1499.99',
        ),
        (('control_start_s=2.5',), 'move score_window_s to [2.5, 3.6], beyond duration_s, 3 s'),
        (('control_start_s=1', 'score_window_s=[0.2, 0.5]'), 'such as [1.0, 1.3]'),
        (('score_window_s=[0.2, 0.5]',), 'such as [0.6, 0.9]'),
        (('driveline.vehicle_inertia=9', 'vehicle.wheel_radius_m=1e-300'), 'no vehicle has that'),
        (('vehicle.wheel_radius_m=1e300',), 'vehicle.wheel_radius_m is 1e+300'),
        (('vehicle.mass_kg=1e308', 'vehicle.wheel_radius_m=1e5'), 'driveline.vehicle_inertia is'),
    ],
)
def test_what_contradicts_or_scores_nothing_is_refused_with_what_is_needed(overrides, complaint):
    with pytest.raises(ParameterError) as refusal:
        changed(*overrides)
    assert complaint in str(refusal.value)


def test_a_file_that_gives_one_half_is_treated_as_an_override_of_the_defaults(tmp_path):
    heavy = from_file(tmp_path, 'vehicle: {mass_kg: 1800.0}')
    assert heavy.driveline == changed('vehicle.mass_kg=1800').driveline
    assert heavy.adjusted == changed('vehicle.mass_kg=1800').adjusted
    with pytest.raises(ParameterError, match=r'vehicle_inertia 185\.629'):
        from_file(tmp_path, 'vehicle: {mass_kg: 1800}\ndriveline: {vehicle_inertia: 154.0}')


def test_an_override_goes_before_both_halves_of_a_file(tmp_path):
    given = 'vehicle: {mass_kg: 1800.0}\ndriveline: {vehicle_inertia: 185.629}'
    assert from_file(tmp_path, given).adjusted == ()
    again = from_file(tmp_path, given, 'vehicle.mass_kg=2000')
    assert again.driveline.vehicle_inertia == pytest.approx(2000.0 * RADIUS**2)
    by_radius = from_file(tmp_path, given, 'vehicle.wheel_radius_m=0.3')
    assert by_radius.driveline.vehicle_inertia == pytest.approx(162.0)
    assert by_radius.vehicle.mass_kg == 1800.0
    group = from_file(tmp_path, given, 'vehicle={mass_kg: 2000}')
    assert group.driveline == again.driveline


def test_a_window_that_begins_before_control_is_kept_and_named():
    early = changed('score_window_s=[0.2, 1.7]')
    assert early.score_window_s == (0.2, 1.7)
    assert 'stays at [0.2, 1.7] s although control starts later' in the_line(early)


@pytest.mark.parametrize(
    'overrides',
    [
        ('vehicle.mass_kg=1800', 'control_start_s=1'),
        ('vehicle.mass_kg=1800', 'driveline.vehicle_inertia=185.6'),
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
