# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The packaged launches and the tip-in are possible runs of a car, with controllers that work."""

from functools import lru_cache

import numpy as np
import pytest

from ddct_bringup.run.headless import run_headless
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

CAPACITY_N_M = 350.0
"""Torque capacity published for the C635, N m."""
LAUNCHES = {
    'launch': (1.0, 2.0),
    'launch_hill': (1.0, 2.0),
    'launch_gentle': (3.0, 4.5),
    'launch_hot': (1.0, 2.0),
}
"""Earliest and latest time of the first lock of the clutch, s, by scenario."""
CONTROLLERS = ('ls8', 'hinf1')
REST = 1e-9
"""Largest wheel speed of a car at rest, rad/s."""


@lru_cache
def run(scenario, controller='ls8', *changes):
    settings = RunSettings(KnownSettings(load_scenario(scenario, changes)))
    return settings.scenario, run_headless(settings, controller)


def events(trajectory):
    return [event for step in trajectory.phase_events for event in step]


@pytest.mark.parametrize('controller', CONTROLLERS)
@pytest.mark.parametrize('name', LAUNCHES)
def test_a_launch_locks_in_time_within_capacity_and_heats_as_launches_do(name, controller):
    scenario, trajectory = run(name, controller)
    assert trajectory.steps == scenario.steps, 'the engine neither stalls nor over-revs'
    (first_s, kind, _), *_ = events(trajectory)
    earliest_s, latest_s = LAUNCHES[name]
    assert kind == 'lock'
    assert earliest_s < first_s < latest_s
    assert trajectory.joint_effort[:, 1].max() < CAPACITY_N_M
    assert 4e3 < trajectory.friction_work.sum() < 35e3, 'J, as published launches have it'
    assert trajectory.joint_speed[:, 2].min() > -REST, 'the car never rolls back'


@pytest.mark.parametrize('name', [*LAUNCHES, 'tip_in'])
def test_the_final_speeds_are_those_that_the_torques_give(name):
    """In the momentum at the wheels clutch torque and shaft torque cancel."""
    scenario, trajectory = run(name)
    p = scenario.driveline
    speeds = trajectory.joint_speed[:, :3]
    resisting = trajectory.joint_effort[:, 2] + p.gear.total_ratio * p.shaft_damping * speeds[:, 1]
    torque = p.gear.total_ratio * trajectory.engine_torque[:-1].sum() * PERIOD_S
    torque -= np.trapezoid(resisting, dx=PERIOD_S)
    inertias = (p.gear.total_ratio * p.engine_inertia, p.gear.total_ratio * p.shaft_inertia)
    momentum = (speeds[-1] - speeds[0]) @ (*inertias, p.vehicle_inertia)
    assert momentum == pytest.approx(torque, rel=0.01)


def test_a_brisk_launch_ends_at_thirty_and_creeping_at_ten_kilometres_an_hour():
    final_km_h = {}
    for name in LAUNCHES:
        scenario, trajectory = run(name)
        wheel = trajectory.joint_speed[-1, 2]
        final_km_h[name] = 3.6 * wheel * scenario.vehicle.wheel_radius_m
    assert final_km_h == pytest.approx(
        {'launch': 32.0, 'launch_hill': 21.0, 'launch_gentle': 10.0, 'launch_hot': 32.0}, abs=1.5
    )


def test_the_brake_holds_the_car_on_the_hill_until_torque_builds():
    scenario, trajectory = run('launch_hill')
    assert np.tan(scenario.load.slope_rad) == pytest.approx(0.12, abs=1e-4)
    wheel = trajectory.joint_speed[:, 2]
    assert np.abs(wheel[:40]).max() < REST, 'held to 0.4 s'
    assert wheel[70] > 0.0, 'under way when the brake is off'
    _, loose = run('launch_hill', 'ls8', 'brake.time_s=[0.0]', 'brake.torque_n_m=[0.0]')
    assert loose.joint_speed[:, 2].min() < -0.01, 'without the brake it rolls back'


def test_a_hot_clutch_carries_more_and_locks_sooner():
    _, cold = run('launch')
    _, hot = run('launch_hot')
    assert hot.clutch_temperature[0] == 200.0
    assert events(hot)[0].time_s < events(cold)[0].time_s - 0.1


@pytest.mark.parametrize('controller', CONTROLLERS)
def test_a_tip_in_breaks_the_locked_clutch_loose_and_it_locks_again(controller):
    _, trajectory = run('tip_in', controller)
    (first_s, first, _), *_, (_, last, _) = events(trajectory)
    assert trajectory.clutch_phase[:50].min() == 2.0, 'locked before the step at 0.5 s'
    assert (first, last) == ('release', 'lock')
    assert 0.5 < first_s < 0.6
    assert 300.0 < trajectory.joint_effort[:, 1].max() < CAPACITY_N_M
