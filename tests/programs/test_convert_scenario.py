# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The converter makes a car, a drive and a scenario with the numbers of a file of before."""

import dataclasses
from pathlib import Path

import pytest

from convert_scenario.__main__ import main
from ddct_plant.scenario.content import scenario_content
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.scenario import Scenario

LAUNCH = """\
# The packaged `launch` of before.
description: Launch from rest on a level road in first gear
duration_s: 3.0
control_start_s: 0.3
score_window_s: [0.3, 1.8]
gear: 1
driveline:
  total_ratio: 16.06
initial:
  engine_speed_rad_s: 104.72
  shaft_speed_rad_s: 0.0
  clutch_phase: open
engine:
  time_s: [0.0, 0.6]
  torque_n_m: [0.0, 140.0]
engine_limits: {}
load:
  air_density_kg_m3: 1.2
  frontal_area_m2: 2.1
  drag_coefficient: 0.32
  rolling_coefficient: 0.0125
  slope_rad: 0.0
reference:
  slope_rad_s2: 105.0
closing: {}
controllers:
  pi:
    proportional_gain: 0.103
    integral_gain: 0.0223
"""
OTHER_CAR = """\
schema_version: 1
name: other
duration_s: 1.0
control_start_s: 0.5
score_window_s: [0.5, 1.0]
engine: {csv: pedal.csv, time: t, value: c, unit: N m}
vehicle: {wheel_radius_m: 0.3}
driveline: {vehicle_inertia: 90.0, engine_inertia: 0.2, total_ratio: 12.5}
load: {rolling_coefficient: 0.01, slope_rad: 0.02}
initial: {shaft_speed_rad_s: 160.0}
adjusted: [a line]
"""


def convert(folder: Path, text: str, *options: str) -> Scenario:
    """Return the scenario that a file of before becomes in another folder."""
    old, new = folder / 'old.yaml', folder / 'new' / 'again.yaml'
    old.write_text(text, encoding='utf-8')
    new.parent.mkdir(exist_ok=True)
    assert main([str(old), '--out', str(new), *options]) == 0
    return load_scenario(str(new))


def test_a_launch_of_before_is_that_of_today_with_its_ratio(tmp_path: Path) -> None:
    found = convert(tmp_path, LAUNCH, '--clutch', 'stick_slip')
    today = load_scenario('launch', ['engine.torque_n_m=[0.0, 140.0]'])
    assert found.driveline.gear.total_ratio == 16.06
    gains = {'pi': {'proportional_gain': 0.103, 'integral_gain': 0.0223}}
    changed = dataclasses.replace(today, name='old', gearbox=found.gearbox, controllers=gains)
    assert scenario_content(found) == scenario_content(changed)
    written = (tmp_path / 'new' / 'again_car.yaml').read_text(encoding='utf-8')
    assert written.startswith('base: c635\n') and 'driveline' not in written


def test_a_file_of_another_car_keeps_its_numbers(tmp_path: Path) -> None:
    (tmp_path / 'pedal.csv').write_text('t,c\n0,10\n1,20\n', encoding='utf-8')
    found = convert(tmp_path, OTHER_CAR)
    usual = load_scenario('thesis')
    assert (found.name, found.clutch, found.engine_limits) == ('other', 'linear', None)
    assert found.engine.torque_n_m == (10.0, 20.0)
    assert found.vehicle.wheel_radius_m == 0.3
    assert found.driveline.vehicle_inertia == pytest.approx(90.0, rel=1e-15)
    expected = {**usual.driveline.values(), 'engine_inertia': 0.2, 'total_ratio': 12.5}
    values = found.driveline.values()
    assert {**values, 'vehicle_inertia': 0.0} == {**expected, 'vehicle_inertia': 0.0}
    assert (found.load.rolling_coefficient, found.load.slope_rad) == (0.01, 0.02)
    assert found.load.frontal_area_m2 == usual.load.frontal_area_m2
    assert (found.initial.engine_speed_rad_s, found.initial.shaft_speed_rad_s) == (160.0, 160.0)
    assert found.adjusted == ()


@pytest.mark.parametrize(
    ('text', 'words'),
    [
        (f'{LAUNCH}lod: 3\n', ['old.yaml: line 30', 'lod']),
        (f'schema_version: 2\n{LAUNCH}', ['old.yaml: line 1', 'schema_version']),
        (LAUNCH.replace('[0.3, 1.8]', 'soon'), ['score_window_s']),
    ],
)
def test_what_is_no_scenario_of_before_is_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str, words: list[str]
) -> None:
    old = tmp_path / 'old.yaml'
    old.write_text(text, encoding='utf-8')
    assert main([str(old), '--out', str(tmp_path / 'new.yaml')]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert all(word in line for word in words), line


def test_a_file_that_is_there_stays(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / 'old.yaml').write_text(LAUNCH, encoding='utf-8')
    (tmp_path / 'new_car.yaml').write_text('mine', encoding='utf-8')
    assert main([str(tmp_path / 'old.yaml'), '--out', str(tmp_path / 'new.yaml')]) == 1
    assert 'new_car.yaml exists already' in capsys.readouterr().err
    assert (tmp_path / 'new_car.yaml').read_text(encoding='utf-8') == 'mine'
    assert not (tmp_path / 'new.yaml').exists()
