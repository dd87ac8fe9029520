# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""In runs with sensors control reads sensor values; plant and scores use true signals."""

from typing import Any

import numpy as np
import pytest

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.run.headless import run_headless
from ddct_bringup.scores.csv_text import signal_columns
from ddct_controllers.interface import Command, Controller, Measurement
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

SHORT = ['duration_s=1.0', 'score_window_s=[0.6, 1.0]']
NOISY = 'sensors={engine_speed: {noise_rad_s: 0.5}, engine_torque: {noise_n_m: 2}}'


class MeasurementLog(Controller):
    """Controller that requests no clutch torque and stores its measurements."""

    def __init__(self, *, commands_engine: bool) -> None:
        self.commands_engine = commands_engine
        self.measurements: list[Measurement] = []

    def reset(self) -> None:
        """Keep the stored measurements."""

    def hold(self, measurement: Measurement) -> None:
        self.update(measurement)

    def update(self, measurement: Measurement) -> Command:
        self.measurements.append(measurement)
        requested = measurement.engine_torque + 5.0
        return Command(0.0, engine_torque=requested if self.commands_engine else None)


def settings(*changes: str, **run: Any) -> RunSettings:
    return RunSettings.of(load_scenario('thesis', [*SHORT, *changes]), run)


def biased(quantity: str, unit: str) -> str:
    return f'sensors.{quantity}.bias_{unit}=7'


def logged_run(*changes: str, commands_engine: bool = False) -> tuple[MeasurementLog, Trajectory]:
    log = MeasurementLog(commands_engine=commands_engine)
    return log, run_headless(settings(*changes), log)


ALL_BIASED = (
    biased('engine_speed', 'rad_s'),
    'sensors.shaft_speed.bias_rad_s=3',
    biased('wheel_speed', 'rad_s'),
    biased('vehicle_speed', 'm_s'),
    biased('engine_torque', 'n_m'),
)


def test_controller_and_reference_receive_the_sensor_values():
    log, run = logged_run(*ALL_BIASED)
    for step, each in enumerate(log.measurements):
        speeds = [each.engine_speed, each.shaft_speed, each.wheel_speed]
        assert speeds == run.sensed_joint_speed[step].tolist()
        assert each.vehicle_speed == run.sensed_vehicle_speed[step] == run.vehicle_speed[step] + 7
        assert each.engine_torque == run.sensed_engine_torque[step] == run.engine_torque[step] + 7
        assert each.slip_speed == run.sensed_slip_speed[step]
    np.testing.assert_allclose(run.sensed_slip_speed, run.slip_speed + 4.0, atol=1e-9)
    until_start = run.slip_reference[
        :60, 0
    ]  # detailed: until control start it is the measured slip
    assert np.array_equal(until_start, run.sensed_slip_speed[:60])


def test_a_controller_that_commands_the_engine_receives_the_demand_itself():
    log, run = logged_run(*ALL_BIASED, commands_engine=True)
    demands = [each.engine_torque for each in log.measurements]
    assert demands == run.torque_demand.tolist()
    assert np.array_equal(run.sensed_engine_torque, run.engine_torque + 7.0)
    assert not np.array_equal(run.engine_torque, run.torque_demand)


@pytest.mark.parametrize('controller', ['pi', 'mpc4'])
def test_exact_sensors_leave_the_run_as_it_is_without(controller):
    without = run_headless(settings(), controller)
    exact = run_headless(settings('sensors={}'), controller)
    assert (
        without.sha256()
        == Trajectory.of_columns({name: exact.signals[name] for name in without.signals}).sha256()
    )
    assert np.array_equal(exact.sensed_joint_speed, without.joint_speed[:, :3])
    assert np.array_equal(exact.sensed_slip_speed, without.slip_speed)
    assert not exact.sensed_joint_held.any()


def test_the_plant_integrates_the_true_torque_and_the_scores_are_of_true_signals():
    # A loop that reads no sensor at all: base, and a controller that requests no torque.
    run = run_headless(
        settings('sensors.engine_torque.bias_n_m=50', architecture='base'),
        MeasurementLog(commands_engine=False),
    )
    without = run_headless(settings(architecture='base'), MeasurementLog(commands_engine=False))
    for name in ('joint_speed', 'slip_speed', 'vehicle_accel', 'engine_torque'):
        assert np.array_equal(run.signals[name], without.signals[name]), name


def test_a_seed_repeats_its_run_and_another_seed_is_another_run():
    runs = [run_headless(settings(NOISY, seed=seed), 'pi').sha256() for seed in (1, 1, 2)]
    assert runs[0] == runs[1] != runs[2]
    noise = [
        (run.sensed_joint_speed - run.joint_speed[:, :3])[:, 0]
        for run in (run_headless(settings(NOISY, seed=seed), 'pi') for seed in (1, 2))
    ]
    assert abs(np.corrcoef(*noise)[0, 1]) < 0.45  # 4.5 standard errors of 101 samples
    without = [run_headless(settings(seed=seed), 'pi').sha256() for seed in (1, 2)]
    assert without[0] == without[1]


def test_a_table_of_signals_has_each_measured_speed_beside_the_true_one():
    run = run_headless(settings(NOISY), 'pi')
    columns = signal_columns(run)
    for index, joint in enumerate(('engine', 'primary_shaft', 'wheel')):
        sensed = columns[f'sensed_{joint}_speed_rad_s']
        assert np.array_equal(sensed, run.sensed_joint_speed[:, index])
    assert {'sensed_slip_speed_rad_s', 'sensed_engine_torque_n_m', 'sensed_slip_held'} <= set(
        columns
    )
    assert 'sensed_driveshaft_speed_rad_s' not in columns
    assert not [
        name for name in signal_columns(run_headless(settings(), 'pi')) if 'sensed' in name
    ]
