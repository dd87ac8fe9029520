# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Headless runs with a clutch that sticks: energy, phases, heat, the start and the early end."""

import argparse
from dataclasses import replace

import numpy as np
import pytest
from refusals import refused

from ddct_bringup import api
from ddct_bringup.api.arguments import run_settings
from ddct_bringup.programs.options.of_runs import add_run_options, settings_given
from ddct_bringup.run.headless import run_headless
from ddct_plant.base.errors import ParameterError
from ddct_plant.models.load import RoadLoad
from ddct_plant.models.static_torque import StaticTorque
from ddct_plant.scenario.file import load_scenario, scenario_to_yaml
from ddct_plant.scenario.initial_state import initial_state
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

UNDAMPED = ('driveline.shaft_damping=0.0', 'driveline.halfshaft_damping=0.0')
"""Changes that leave friction as the only dissipation."""
LAUNCH = ('initial.shaft_speed_rad_s=0', 'initial.engine_speed_rad_s=104.7')


def settings(*changes, wear_gain=1.0):
    scenario = load_scenario('thesis_sticking', changes)
    return RunSettings(KnownSettings(scenario), CaseSettings(wear_gain=wear_gain))


def run(*changes, controller='pi', wear_gain=1.0):
    return run_headless(settings(*changes, wear_gain=wear_gain), controller)


def stored_energy(trajectory, driveline):
    """Return kinetic and elastic energy in J at each t_k."""
    inertias = driveline.engine_inertia, driveline.shaft_inertia, driveline.vehicle_inertia
    kinetic = 0.5 * trajectory.joint_speed[:, :3] ** 2 @ inertias
    return kinetic + 0.5 * driveline.halfshaft_stiffness * trajectory.joint_position[:, 3] ** 2


@pytest.mark.parametrize(
    ('changes', 'controller', 'wear_gain'),
    [
        ((), 'ls8', 1.0),
        ((), 'pi', 0.7),
        (('load.slope_rad=0.05', 'friction.static_over_kinetic=1.2'), 'hinf2', 1.0),
        ((*LAUNCH, 'gear=1'), 'hinf2', 1.0),
    ],
)
def test_work_in_is_kinetic_and_elastic_energy_and_what_friction_takes(
    changes, controller, wear_gain
):
    """All from recorded signals; the wheel never turns back, so its friction takes c dtheta."""
    chosen = settings(*UNDAMPED, *changes, wear_gain=wear_gain)
    found = run_headless(chosen, controller)
    turned = np.diff(found.joint_position[:, :3], axis=0)
    assert turned[:, 2].min() >= 0.0
    work_in = found.engine_torque[:-1] * turned[:, 0] - found.load_torque[:-1] * turned[:, 2]
    at_wheel = found.holding_torque[:-1] * turned[:, 2]
    stored = np.diff(stored_energy(found, chosen.scenario.driveline))
    difference = work_in - at_wheel - found.friction_work[1:] - stored
    throughput = np.abs(work_in).sum() + found.friction_work.sum()
    assert np.abs(difference.sum()) < 1e-9 * throughput
    assert np.abs(difference).max() < 1e-9 * throughput


def test_slip_is_zero_while_locked_and_work_is_zero_within_a_locked_period():
    found = run(controller='ls8')
    locked = found.clutch_phase == 2.0
    assert locked.sum() > 100
    assert (found.slip_speed[locked] == 0.0).all()
    quiet = [k for k in np.flatnonzero(locked[1:] & locked[:-1]) if not found.phase_events[k + 1]]
    assert (found.friction_work[1:][quiet] == 0.0).all()
    assert (found.friction_work[1:][~locked[1:]] > 0.0).all()


def test_events_alternate_lie_in_their_period_and_end_in_the_recorded_phase():
    found = run(*LAUNCH, 'gear=1', controller='hinf2')
    states = {'lock': 2.0, 'release': 1.0}
    phase = found.clutch_phase[0]
    for k in range(1, found.steps + 1):
        for time_s, kind, acceleration in found.phase_events[k]:
            assert np.isfinite(acceleration)
            assert found.time_s[k - 1] <= time_s <= found.time_s[k] + 1e-12
            assert states[kind] != phase
            phase = states[kind]
        assert found.clutch_phase[k] == phase
    assert sum(map(len, found.phase_events)) > 4


def test_what_is_transmitted_is_within_the_capacity():
    found = run('friction.static_over_kinetic=1.2', controller='ls8')
    kinetic_end, static_end = found.clutch_torque[:-1, -1], found.clutch_static_torque[:-1, -1]
    transmitted, slips = found.joint_effort[1:, 1], found.clutch_phase[1:] == 1.0
    assert transmitted[slips] == pytest.approx(
        (np.sign(found.slip_speed[1:]) * kinetic_end)[slips], rel=1e-12
    )
    assert (np.abs(transmitted) <= static_end * (1 + 1e-12)).all()
    assert (found.clutch_torque >= 0.0).all()
    assert found.clutch_static_torque == pytest.approx(1.2 * found.clutch_torque)


def test_the_friction_work_warms_the_facing():
    cold, hot = run(wear_gain=0.7), run('heat.facing_c=200.0', 'heat.plate_c=200.0', wear_gain=0.7)
    assert (cold.clutch_temperature[0], hot.clutch_temperature[0]) == (20.0, 200.0)
    assert cold.clutch_temperature[-1] > 60.0
    assert hot.clutch_temperature.max() > 250.0


def test_a_hot_facing_carries_less():
    hot = run('heat.facing_c=350.0', 'heat.plate_c=350.0')
    new = run()
    assert hot.clutch_torque[0, 0] == pytest.approx(0.6 * new.clutch_torque[0, 0])


def test_the_load_loses_its_rolling_resistance_to_the_holding_torque():
    scenario = settings().scenario
    vehicle, rolling = scenario.vehicle, scenario.load.rolling_coefficient
    resistance = vehicle.mass_kg * vehicle.gravity_m_s2 * rolling * vehicle.wheel_radius_m
    found, linear = run(), run_headless(RunSettings(KnownSettings(load_scenario('thesis'))), 'pi')
    assert found.holding_torque == pytest.approx(resistance)
    assert found.load_torque[0] + found.holding_torque[0] == pytest.approx(linear.load_torque[0])
    assert linear.holding_torque is None


def test_plates_of_one_speed_start_locked_and_carry_what_keeps_them_so():
    start = initial_state(settings())
    linear = initial_state(RunSettings(KnownSettings(load_scenario('thesis'))))
    assert start.sides[0].torque == pytest.approx(linear.sides[0].torque)
    assert start.twist == pytest.approx(linear.twist)
    assert start.load_torque + start.wheel_torque == pytest.approx(linear.load_torque)
    assert run().clutch_phase[0] == 2.0


@pytest.mark.parametrize(('engine', 'sign'), [(180.0, 1.0), (140.0, -1.0)])
def test_plates_of_two_speeds_start_slipping_and_carry_the_kinetic_capacity(engine, sign):
    changes = (f'initial.engine_speed_rad_s={engine}',)
    (side,) = initial_state(settings(*changes, wear_gain=0.7)).sides
    assert side.torque == pytest.approx(sign * 0.7 * side.torque_request)
    assert run(*changes).clutch_phase[0] == 1.0


@pytest.mark.parametrize('engine', [160.0, 180.0])
def test_a_clutch_in_the_phase_open_starts_without_torque(engine):
    changes = ('initial.clutch_phase=open', f'initial.engine_speed_rad_s={engine}')
    (side,) = initial_state(settings(*changes)).sides
    assert (side.torque_request, side.torque) == (0.0, 0.0)
    assert run(*changes).clutch_phase[0] == 0.0


@pytest.mark.parametrize('slope', [0.0, 0.12, -0.12])
def test_a_car_at_rest_is_held_by_its_brake(slope):
    brake = ('brake.time_s=[0.0]', 'brake.torque_n_m=[2000.0]')
    found = run(*LAUNCH, *brake, f'load.slope_rad={slope}', 'engine.torque_n_m=[0.0, 0.0]')
    assert (found.vehicle_speed == 0.0).all()
    assert (found.vehicle_accel == 0.0).all()
    assert (found.joint_speed[0, 1:] == 0.0).all()
    assert found.joint_effort[0, 2] == pytest.approx(found.joint_effort[0, 3])


STRONG = 'engine_limits.full_load_n_m=[0, 110, 170, 225, 250, 217, 165, 308]'
"""An engine that gives the demand of `thesis` at some speed."""
OVER_REV = (
    STRONG,
    'engine_limits.over_rev_rad_s=325.0',
    'engine_limits.cut_rad_s=324.0',
    'engine_limits.resume_rad_s=323.0',
    'initial.engine_speed_rad_s=318.0',
)
STALL = (
    'engine_limits.stall_rad_s=140.0',
    'engine_limits.idle_rad_s=150.0',
    'engine_limits.idle_most_n_m=0.0',
    'engine.torque_n_m=[0.0, 0.0]',
    'load.slope_rad=0.5',
)


@pytest.mark.parametrize(
    ('changes', 'reached'),
    [(OVER_REV, 325.0), (STALL, 140.0)],
    ids=['over_revved', 'stalled'],
)
@pytest.mark.parametrize('name', ['thesis', 'thesis_sticking'])
def test_the_run_ends_with_the_first_state_at_or_beyond_a_limit(changes, reached, name):
    scenario = load_scenario(name, changes)
    found = run_headless(RunSettings(KnownSettings(scenario), CaseSettings(wear_gain=0.7)), 'pi')
    speeds = found.joint_speed[:, 0] - reached
    assert 0 < found.steps < scenario.steps
    assert (np.sign(speeds[:-1]) == np.sign(speeds[0])).all()
    assert np.sign(speeds[-1]) != np.sign(speeds[0])


@pytest.mark.parametrize('name', ['thesis', 'thesis_sticking'])
def test_the_static_controller_goes_by_what_a_limited_engine_delivers(name):
    weak = f'engine_limits.full_load_n_m={[100.0] * 7 + [308.0]}'
    scenario = load_scenario(name, [weak, 'duration_s=1.0'])
    found = run_headless(RunSettings(KnownSettings(scenario)), 'pi')
    assert found.engine_torque.max() == 100.0 < found.torque_demand.max()
    road = RoadLoad(scenario.load, scenario.vehicle)
    static = StaticTorque(scenario.driveline, scenario.equilibrium)
    expected = [
        static.torque(torque, road.torque(speed), *joints[:2])
        for torque, speed, joints in zip(
            found.engine_torque, found.vehicle_speed, found.joint_speed, strict=True
        )
    ]
    told = found.open_loop_torque
    assert told == pytest.approx(expected)


def test_a_driveline_too_fast_for_a_clutch_that_sticks_is_refused_before_the_run(tmp_path):
    """Programs and the Python interface name key and line."""
    path = tmp_path / 'fast.yaml'
    made = replace(
        load_scenario('thesis', ['driveline.shaft_inertia=0.0002']), clutch='stick_slip'
    )
    text = scenario_to_yaml(made)
    path.write_text(text, encoding='utf-8')
    line = text.splitlines().index('    shaft_inertia: 0.0002') + 1
    place = f'fast.yaml: line {line}'
    parser = argparse.ArgumentParser()
    add_run_options(parser)
    options = parser.parse_args(['--scenario', str(path)])
    with refused(ParameterError, 'driveline.shaft_inertia', place):
        run_settings([], **settings_given(options))
    with refused(ParameterError, 'driveline.shaft_inertia', place):
        api.run('pi', scenario=path)
