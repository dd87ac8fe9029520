# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The sensors of a run together: what depends on what, and on nothing else."""

import dataclasses
from typing import Any

import pytest

from ddct_plant.base.errors import ParameterError
from ddct_plant.models.driveline import DrivelineOutputs, JointValues
from ddct_plant.scenario.differences import changed_values
from ddct_plant.scenario.file import load_scenario, scenario_digest, scenario_to_yaml
from ddct_plant.scenario.plant import driveline_sensors, torque_estimate
from ddct_plant.scenario.settings import KnownSettings, RunSettings
from ddct_plant.sensors.parameters import SensorParameters, ShaftSpeedSensor
from ddct_plant.sensors.sensed import DrivelineSensors, TorqueEstimate

NOISY: Any = load_scenario(
    'thesis',
    {
        'sensors.engine_speed.noise_rad_s': 0.2,
        'sensors.engine_speed.dropout': 0.4,
        'sensors.shaft_speed.noise_rad_s': 0.2,
        'sensors.shaft_speed.dropout': 0.4,
        'sensors.wheel_speed.noise_rad_s': 0.2,
        'sensors.vehicle_speed.noise_m_s': 0.2,
        'sensors.vehicle_speed.dropout': 0.4,
        'sensors.engine_torque.noise_n_m': 0.2,
    },
).sensors
assert NOISY is not None


def outputs(step: int) -> DrivelineOutputs:
    speeds = JointValues(160.0 + 0.1 * step, 150.0, 16.0, 0.0)
    positions = JointValues(*(0.01 * step * speed for speed in speeds))
    none = JointValues(0.0, 0.0, 0.0, 0.0)
    slip = speeds.engine - speeds.primary_shaft
    return DrivelineOutputs(positions, speeds, none, slip, 5.0, 0.0)


def run(sensors: DrivelineSensors, steps: int = 200):
    return [sensors.measure(step, outputs(step)) for step in range(steps)]


def test_the_measured_slip_is_the_difference_of_the_measured_speeds_with_the_flag_of_either():
    flags = set()
    for sensed in run(DrivelineSensors(NOISY, 0)):
        assert sensed.slip_speed == sensed.engine_speed - sensed.shaft_speed
        engine, shaft, _ = sensed.signals['sensed_joint_held']
        assert sensed.signals['sensed_slip_held'] == max(engine, shaft)
        flags.add((engine, shaft))
    assert flags == {(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)}


def test_a_repeated_step_has_the_same_measurement_and_changes_no_later_one():
    once = run(DrivelineSensors(NOISY, 3))
    sensors = DrivelineSensors(NOISY, 3)
    for step, expected in enumerate(once):
        for _ in range(1 + step % 3):
            assert sensors.measure(step, outputs(step)) == expected


def test_steps_that_real_time_leaves_out_use_up_their_numbers():
    whole, gaps = TorqueEstimate(NOISY, 3), TorqueEstimate(NOISY, 3)
    for step in range(100):
        expected = whole.measure(step, 80.0)
        if step % 7 in (0, 3):
            assert gaps.measure(step, 80.0) == expected


def test_no_sensor_draws_from_the_numbers_of_another():
    all_of_them = run(DrivelineSensors(NOISY, 3))
    made: Any = SensorParameters
    shaft = made(shaft_speed=NOISY.shaft_speed)
    alone = run(DrivelineSensors(shaft, 3))
    other = run(DrivelineSensors(dataclasses.replace(NOISY, shaft_speed=ShaftSpeedSensor()), 3))
    for every, one, rest in zip(all_of_them, alone, other, strict=True):
        assert every.shaft_speed == one.shaft_speed
        assert every.engine_speed == rest.engine_speed
        assert every.vehicle_speed == rest.vehicle_speed


def test_the_numbers_of_a_seed_stay_what_they_are():
    # As numpy 2 draws them with PCG64: another version of it that changes them is found here.
    first = run(DrivelineSensors(NOISY, 0), 2)
    estimate = TorqueEstimate(NOISY, 0)
    speeds = first[1]
    numbers = [speeds.engine_speed, speeds.shaft_speed, speeds.wheel_speed, speeds.vehicle_speed]
    numbers.append(estimate.measure(1, 80.0).engine_torque)
    assert [round(number, 9) for number in numbers] == [
        159.77095561,
        149.96149763,
        16.048013619,
        4.733616083,
        80.126339255,
    ]


def test_the_scenario_of_the_thesis_has_no_sensors_and_makes_none():
    settings = RunSettings(KnownSettings(load_scenario('thesis')))
    assert not settings.known.sensed
    assert (driveline_sensors(settings), torque_estimate(settings)) == (None, None)


def test_a_file_and_its_hash_hold_what_is_given_of_the_sensors_and_no_more():
    thesis = load_scenario('thesis')
    exact = load_scenario('thesis', ['sensors={}'])
    noisy = load_scenario('thesis', ['sensors.wheel_speed.noise_rad_s=0.1'])
    assert 'sensors' not in scenario_to_yaml(thesis)
    assert scenario_to_yaml(exact).count('sensors: {}') == 1
    assert changed_values(noisy) == ('sensors.wheel_speed.noise_rad_s=0.1',)
    assert noisy.sensors is not None
    assert exact.sensors is not None
    assert exact.sensors.text == 'each of them is exact'
    assert noisy.sensors.text == 'wheel_speed: noise_rad_s 0.1 rad/s'
    assert len({scenario_digest(each) for each in (thesis, exact, noisy)}) == 3


def test_what_is_written_is_read_back(tmp_path):
    scenario = load_scenario(
        'thesis', ['sensors={engine_speed: {teeth: 60, dropout: 0.1}, engine_torque: {gain: 1.1}}']
    )
    file = tmp_path / 'sensed.yaml'
    file.write_text(scenario_to_yaml(scenario), encoding='utf-8')
    assert load_scenario(str(file)) == scenario


@pytest.mark.parametrize(
    ('lines', 'words'),
    [
        ('  engine_speed:\n    noise_rad_s: -0.1', 'sensors.engine_speed.noise_rad_s is -0.1'),
        ('  shaft_speed:\n    delay_s: 0.004', 'sensors.shaft_speed.delay_s is 0.004 s'),
        ('  pressure:\n    noise: 1', 'unknown key sensors.pressure: known: engine_speed'),
        ('  vehicle_speed:\n    teeth: 60', 'unknown key sensors.vehicle_speed.teeth'),
    ],
)
def test_a_bad_line_is_named_with_file_and_key(tmp_path, lines, words):
    file = tmp_path / 'sensed.yaml'
    file.write_text(f'base: c635_thesis\nsensors:\n{lines}\n', encoding='utf-8')
    with pytest.raises(ParameterError) as caught:
        load_scenario('thesis', car=str(file))
    line = 3 if 'unknown key sensors.pressure' in words else 4
    assert f'{file}: line {line}: {words}' in str(caught.value)
    assert '\n' not in str(caught.value)
