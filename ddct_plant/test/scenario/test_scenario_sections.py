# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Sections of stick-slip runs are read whole, or refused with file, line and key."""

import pytest
from refusals import refused

from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.file import load_scenario, scenario_digest, scenario_to_yaml

BASE = """\
duration_s: 1.0
control_start_s: 0.6
score_window_s: [0.6, 1.0]
engine: {time_s: [0.0], torque_n_m: [100.0]}
"""
CAR = 'base: c635_no_limits\n'
FILES = {'car': CAR, 'drive': BASE}
"""Text of a car and of a drive."""
SECTIONS = (
    (
        'drive',
        'initial: {engine_speed_rad_s: 100.0, shaft_speed_rad_s: 100.0, clutch_phase: locked}\n',
    ),
    (
        'car',
        'friction: {static_over_kinetic: 1.1, slip_rad_s: [0.0, 50.0], slip_share: [1.0, 0.9]}\n',
    ),
    ('drive', 'heat: {plate_c: 200.0, facing_c: 200.0}\n'),
    ('drive', 'brake: {time_s: [0.0, 1.0], torque_n_m: [800.0, 0.0]}\n'),
    ('car', 'engine_limits: {stall_rad_s: 60.0}\n'),
    ('drive', 'closing: {margin: 1.3}\n'),
)
DIGEST_OF_THESIS = 'e930082b5253a695'
"""Digest of `thesis` from before scenarios had sections."""


@pytest.fixture
def files(tmp_path):
    """Return a car and a drive with more text in each, as keywords of `load_scenario`."""

    def write(**more):
        found = {}
        for noun, text in FILES.items():
            path = tmp_path / f'{noun}.yaml'
            path.write_text(text + more.get(noun, ''), encoding='utf-8')
            found[noun] = str(path)
        return found

    return write


def test_sections_are_the_same_after_writing_and_reading_and_change_the_digest(files, tmp_path):
    more = {noun: ''.join(text for of, text in SECTIONS if of == noun) for noun in FILES}
    scenario = load_scenario(**files(**more))
    assert scenario.friction.slip_share == (1.0, 0.9)
    assert (scenario.heat.facing_c, scenario.heat.housing_c) == (200.0, 20.0)
    assert scenario.brake.at(0.5) == 400.0
    assert scenario.engine_limits.stall_rad_s == 60.0
    assert (scenario.closing.margin, scenario.closing.dwell_s) == (1.3, 0.1)
    assert scenario.initial.clutch_phase == 'locked'
    (tmp_path / 'again.yaml').write_text(scenario_to_yaml(scenario), encoding='utf-8')
    assert load_scenario(str(tmp_path / 'again.yaml')) == scenario
    bare = load_scenario(**files())
    digests = {scenario_digest(scenario), scenario_digest(bare)}
    for noun, section in SECTIONS[1:]:
        digests.add(scenario_digest(load_scenario(**files(**{noun: section}))))
    assert len(digests) == 7, 'each section counts'


def test_what_thesis_lacks_stays_out_of_its_file_and_digest():
    scenario = load_scenario('thesis')
    assert scenario_digest(scenario) == DIGEST_OF_THESIS
    assert scenario.engine_limits is None
    text = scenario_to_yaml(scenario)
    for name in ('friction', 'heat', 'brake', 'engine_limits', 'closing', 'clutch_phase'):
        assert f'{name}:' not in text


def test_rates_too_fast_for_a_clutch_that_sticks_are_refused_with_key_and_line(files):
    given = files(car='driveline:\n  shaft_inertia: 0.0002')
    linear = load_scenario(overrides=['clutch=linear'], **given)
    assert linear.driveline.shaft_inertia == 0.0002
    with refused(ParameterError, 'driveline.shaft_inertia', 'car.yaml: line 3'):
        load_scenario(**given)


def test_an_empty_section_of_limits_takes_the_default_engine(files):
    given = files(car='engine_limits: {}')
    assert load_scenario(**given).engine_limits.idle_rad_s == 94.25
    assert load_scenario(overrides=['engine_limits=null'], **given).engine_limits is None


@pytest.mark.parametrize(
    ('noun', 'text', 'key', 'line'),
    [
        ('car', 'friction: {static_over_kinetic: 0.9}', 'friction.static_over_kinetic', 2),
        ('car', 'friction:\n  slip_rad_s: [0]\n', 'friction.slip_share', 2),
        ('car', 'friction: {most_n_m: 0}', 'friction.most_n_m', 2),
        (
            'car',
            'vehicle: {mass_kg: 1e20, wheel_radius_m: 1}\n'
            'driveline:\n  engine_inertia: 1e308\n  shaft_inertia: 1e308\n  vehicle_inertia: 1e20',
            'driveline.shaft_inertia',
            5,
        ),
        ('car', 'driveline: {total_ratio: 16.06}', 'driveline.total_ratio', 2),
        ('drive', 'gear: 9\n', 'gear', 5),
        ('car', 'heat:\n  facing_j_k: -163.0', 'heat.facing_j_k', 3),
        ('drive', 'closing: {margin: 0.9}', 'closing.margin', 5),
        ('drive', 'closing:\n  dwell_s: 0.015', 'closing.dwell_s', 6),
        (
            'drive',
            'brake:\n  torque_n_m: [1.0, 0.0]\n  time_s: [1.0, 1.0]',
            'brake.time_s',
            7,
        ),
        (
            'drive',
            'brake:\n  time_s: [0.0, 1.0]\n  torque_n_m:\n  - 5.0\n  - -5.0',
            'brake.torque_n_m[1]',
            9,
        ),
        (
            'car',
            'engine_limits:\n  full_load_n_m: [9.0, 9.0]\n  friction_n_m: [9.0, 9.0]\n'
            '  speed_rad_s: [0.0, 600.0]',
            'engine_limits.speed_rad_s',
            5,
        ),
        (
            'drive',
            'initial:\n  engine_speed_rad_s: 100.0\n  clutch_phase: locked',
            'initial.clutch_phase',
            7,
        ),
        (
            'drive',
            'initial:\n  clutch_phase: slipping',
            'initial.clutch_phase',
            6,
        ),
        ('drive', 'initial: {clutch_phase: wet}', 'initial.clutch_phase', 5),
        ('drive', 'load:\n  slope_deg: 1.0', 'load.slope_deg', 6),
        ('drive', 'load:\n  slope_rad: .nan', 'load.slope_rad', 6),
        (
            'car',
            'engine_authority:\n  minimum_torque_n_m: 2000.0',
            'engine_authority.minimum_torque_n_m',
            3,
        ),
        ('drive', 'reference: 3', 'reference', 5),
    ],
)
def test_a_bad_value_is_refused_with_its_line(files, noun, text, key, line):
    given = files(**{noun: text})
    with refused(ParameterError, key=key, place=f'{noun} {given[noun]}: line {line}'):
        load_scenario(**given)


@pytest.mark.parametrize(
    'override', ['engine.torque_n_m=[-1.0]', 'engine={time_s: [0.0], torque_n_m: [-1.0]}']
)
def test_a_bad_value_that_was_set_has_no_line_of_the_file(files, override):
    given = files()
    place = f'drive {given["drive"]} with car {given["car"]}'
    with refused(ParameterError, key='engine.torque_n_m[0]', place=place):
        load_scenario(overrides=[override], **given)


def test_a_missing_key_of_a_section_has_the_line_of_the_section(tmp_path):
    path = tmp_path / 'mine.yaml'
    path.write_text(BASE.replace('{time_s: [0.0], torque_n_m: [100.0]}', '{time_s: [0.0]}'))
    with refused(ParameterError, key='engine.torque_n_m', place=f'drive {path}: line 4'):
        load_scenario(drive=str(path))
