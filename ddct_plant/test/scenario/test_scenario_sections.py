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
SECTIONS = """\
initial: {engine_speed_rad_s: 100.0, shaft_speed_rad_s: 100.0, clutch_phase: locked}
friction: {static_over_kinetic: 1.1, slip_rad_s: [0.0, 50.0], slip_share: [1.0, 0.9]}
heat: {plate_c: 200.0, facing_c: 200.0}
brake: {time_s: [0.0, 1.0], torque_n_m: [800.0, 0.0]}
engine_limits: {stall_rad_s: 60.0}
closing: {margin: 1.3}
"""
DIGEST_OF_THESIS = '91dd4f58e1510697'
"""Digest of `thesis` from before scenarios had sections; the kept predictions contain it."""


@pytest.fixture
def scenario_file(tmp_path):
    def write(text):
        path = tmp_path / 'mine.yaml'
        path.write_text(text, encoding='utf-8')
        return str(path)

    return write


def test_sections_are_the_same_after_writing_and_reading_and_change_the_digest(scenario_file):
    scenario = load_scenario(scenario_file(BASE + SECTIONS))
    assert scenario.friction.slip_share == (1.0, 0.9)
    assert (scenario.heat.facing_c, scenario.heat.housing_c) == (200.0, 20.0)
    assert scenario.brake.at(0.5) == 400.0
    assert scenario.engine_limits.stall_rad_s == 60.0
    assert (scenario.closing.margin, scenario.closing.dwell_s) == (1.3, 0.1)
    assert scenario.initial.clutch_phase == 'locked'
    again = load_scenario(scenario_file(scenario_to_yaml(scenario)))
    assert again == scenario
    bare = load_scenario(scenario_file(BASE))
    digests = {scenario_digest(scenario), scenario_digest(bare)}
    for section in SECTIONS.splitlines()[1:]:
        digests.add(scenario_digest(load_scenario(scenario_file(f'{BASE}{section}\n'))))
    assert len(digests) == 7, 'each section counts'


def test_what_thesis_lacks_stays_out_of_its_file_and_digest():
    scenario = load_scenario('thesis')
    assert scenario_digest(scenario) == DIGEST_OF_THESIS
    assert scenario.engine_limits is None
    text = scenario_to_yaml(scenario)
    for name in ('friction', 'heat', 'brake', 'engine_limits', 'closing', 'clutch_phase'):
        assert f'{name}:' not in text


def test_rates_too_fast_for_a_clutch_that_sticks_are_refused_with_key_and_line(scenario_file):
    path = scenario_file(BASE + 'driveline:\n  shaft_inertia: 0.0002')
    assert load_scenario(path).driveline.shaft_inertia == 0.0002
    with refused(ParameterError, 'driveline.shaft_inertia', 'mine.yaml: line 6'):
        load_scenario(path, clutch='stick_slip')


def test_an_empty_section_of_limits_takes_the_default_engine(scenario_file):
    path = scenario_file(BASE + 'engine_limits: {}')
    assert load_scenario(path).engine_limits.idle_rad_s == 94.25
    assert load_scenario(path, ['engine_limits=null']).engine_limits is None


@pytest.mark.parametrize(
    ('text', 'key', 'place'),
    [
        ('friction: {static_over_kinetic: 0.9}', 'friction.static_over_kinetic', 'line 5'),
        ('friction:\n  slip_rad_s: [0]\n', 'friction.slip_share', 'line 5'),
        ('friction: {most_n_m: 0}', 'friction.most_n_m', 'line 5'),
        (
            'driveline:\n  engine_inertia: 1e308\n  shaft_inertia: 1e308\n  vehicle_inertia: 1e20',
            'driveline.shaft_inertia',
            'line 7',
        ),
        ('driveline: {total_ratio: 1e-200}', 'driveline.total_ratio', 'line 5'),
        ('heat:\n  plate_c: 20.0\n  facing_j_k: -163.0', 'heat.facing_j_k', 'line 7'),
        ('closing: {margin: 0.9}', 'closing.margin', 'line 5'),
        ('closing:\n  dwell_s: 0.015', 'closing.dwell_s', 'line 6'),
        (
            'brake:\n  torque_n_m: [1.0, 0.0]\n  time_s: [1.0, 1.0]',
            'brake.time_s',
            'line 7',
        ),
        (
            'brake:\n  time_s: [0.0, 1.0]\n  torque_n_m:\n  - 5.0\n  - -5.0',
            'brake.torque_n_m[1]',
            'line 9',
        ),
        (
            'engine_limits:\n  full_load_n_m: [9.0, 9.0]\n  friction_n_m: [9.0, 9.0]\n'
            '  speed_rad_s: [0.0, 600.0]',
            'engine_limits.speed_rad_s',
            'line 8',
        ),
        (
            'initial:\n  engine_speed_rad_s: 100.0\n  clutch_phase: locked',
            'initial.clutch_phase',
            'line 7',
        ),
        (
            'initial:\n  clutch_phase: slipping',
            'initial.clutch_phase',
            'line 6',
        ),
        ('initial: {clutch_phase: wet}', 'initial.clutch_phase', 'line 5'),
        ('load:\n  slope_deg: 1.0', 'load.slope_deg', 'line 6'),
        ('load:\n  slope_rad: .nan', 'load.slope_rad', 'line 6'),
        (
            'engine_authority:\n  minimum_torque_n_m: 2000.0',
            'engine_authority.minimum_torque_n_m',
            'line 6',
        ),
        ('reference: 3', 'reference', 'line 5'),
    ],
)
def test_a_bad_value_is_refused_with_its_line(scenario_file, text, key, place):
    path = scenario_file(BASE + text)
    with refused(ParameterError, key=key, place=place):
        load_scenario(path)


@pytest.mark.parametrize(
    'override', ['engine.torque_n_m=[-1.0]', 'engine={time_s: [0.0], torque_n_m: [-1.0]}']
)
def test_a_bad_value_that_was_set_has_no_line_of_the_file(scenario_file, override):
    path = scenario_file(BASE)
    with refused(ParameterError, key='engine.torque_n_m[0]', place=f'scenario {path}'):
        load_scenario(path, [override])


def test_a_missing_key_of_a_section_has_the_line_of_the_section(scenario_file):
    path = scenario_file(BASE.replace('{time_s: [0.0], torque_n_m: [100.0]}', '{time_s: [0.0]}'))
    with refused(ParameterError, key='engine.torque_n_m', place='mine.yaml: line 4'):
        load_scenario(path)
