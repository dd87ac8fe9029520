# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Metrics of a gear shift: phases, wheel torque, flare, tie-up, works and events."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from made_run import made_run
from made_shift import (
    LOCKED,
    RATIOS,
    SLIPPING,
    STEP,
    engagement_of,
    events,
    joints,
    made_shift,
)

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.catalogue import METRICS
from ddct_bringup.metrics.engagement import Engagement
from ddct_bringup.metrics.metric import Metrics
from ddct_bringup.metrics.plant import JudgedPlant
from ddct_bringup.metrics.values import metrics_of
from ddct_plant.friction.driveline import FrictionDriveline
from ddct_plant.friction.engagements import both_engaged
from ddct_plant.models.clutch import Capacity
from ddct_plant.models.gearbox import Gearbox
from ddct_plant.models.initial_state import InitialSide, InitialState
from ddct_plant.models.parameters import DrivelineParameters, VehicleParameters
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.rules.shift import gears_of
from ddct_plant.shift.gear_pair import GearPair
from ddct_plant.shift.start import driving_start

OF_SHIFT = [each for each in METRICS.values() if each.of_shift]


def metrics(**signals: Any) -> Metrics:
    """Return the metrics of a shift made by hand."""
    return metrics_of(engagement_of(made_shift(**signals)))


def test_shift_time_is_torque_phase_and_inertia_phase_to_the_exact_lock():
    found = metrics(phase_events=events((0.8975, 'lock')))
    assert found['torque_phase_s'] == pytest.approx(0.2, abs=1e-12)
    assert found['inertia_phase_s'] == pytest.approx(0.3975, abs=1e-12)
    assert found['shift_time_s'] == pytest.approx(0.5975, abs=1e-12)
    assert found['engagement_time_s'] == found['inertia_phase_s']
    assert found['time_to_final_lock_s'] == found['shift_time_s']


def test_a_lock_in_the_torque_phase_does_not_end_the_shift():
    both = events((0.4, 'lock'), (0.45, 'release'), (0.9, 'lock'))
    found = metrics(phase_events=both)
    assert found['inertia_phase_s'] == pytest.approx(0.4, abs=1e-12)
    assert (found['on_coming_locks'], found['on_coming_releases']) == (2, 1)
    assert (found['off_going_locks'], found['off_going_releases']) == (0, 1)


def test_a_share_that_never_is_one_gives_neither_phase_but_a_flare():
    share = np.clip((STEP - 30) / 200.0, 0.0, 1.0)
    found = metrics(handover_share=share, phase_events=events())
    assert found['torque_phase_s'] is found['inertia_phase_s'] is found['shift_time_s'] is None
    assert found['engagement_time_s'] is None
    assert found['flare_rad_s'] == 0.0


def test_the_dip_is_that_of_the_wheel_torque_from_the_start_to_the_lock():
    torque = np.where(STEP < 30, 9000.0, np.where(STEP <= 90, 1500.0 - 10.0 * (STEP - 30), -500.0))
    found = metrics(joint_effort=joints(fourth=torque))
    assert found['torque_dip_n_m'] == pytest.approx(600.0)
    assert found['torque_dip_percent'] == pytest.approx(40.0)
    braked = metrics(joint_effort=joints(fourth=-torque))
    assert braked['torque_dip_percent'] is None


def test_flare_is_the_rise_above_the_speed_in_the_off_going_gear_until_the_lock():
    first, second = (10.0 * ratio for ratio in RATIOS)
    engine = first + np.where((STEP == 45) | (STEP == 120), 24.0, 0.0)
    slipping = np.where(STEP < 40, LOCKED, SLIPPING)
    shafts = joints(engine, second, 10.0)
    found = metrics(joint_speed=shafts, off_going_clutch_phase=slipping)
    assert found['flare_rad_s'] == pytest.approx(24.0)
    # The free shaft of a disengaged gear slows down, which is no flare.
    free = np.where(STEP < 40, first, 0.5 * first)
    again = metrics(
        joint_speed=shafts, off_going_clutch_phase=slipping, off_going_shaft_speed=free
    )
    assert again['flare_rad_s'] == pytest.approx(24.0)


def test_tie_up_work_is_what_the_plant_records_of_the_periods_from_the_start_of_the_shift_on():
    assert metrics(tie_up_work=np.where(STEP <= 30, 5.0, 0.0))['tie_up_work_j'] == 0.0
    assert metrics(tie_up_work=np.where(STEP > 30, 0.5, 0.0))['tie_up_work_j'] == 60.0


def test_works_and_the_peak_temperature_are_those_of_both_clutches():
    heated = 20.0 + np.where(STEP == 70, 300.0, 0.0)
    run = made_shift(
        friction_work=np.full(STEP.shape, 2.0),
        off_going_friction_work=np.full(STEP.shape, 0.5),
        clutch_temperature=np.full(STEP.shape, 100.0),
        off_going_clutch_temperature=heated,
    )
    found = metrics_of(engagement_of(run))
    assert found['friction_work_j'] == pytest.approx(120 * 2.5), 'from the start of the shift on'
    assert found['off_going_friction_work_j'] == pytest.approx(75.5)
    assert found['on_coming_peak_temperature_degc'] == 100.0
    assert found['off_going_peak_temperature_degc'] == 320.0
    assert found['peak_temperature_degc'] == 320.0


def test_metrics_of_a_shift_are_null_in_every_other_run():
    run = made_run(np.zeros(301), clutch_phase=np.zeros(301), phase_events=((),) * 301)
    found = metrics_of(Engagement(run, 60, (60, 170)))
    assert len(OF_SHIFT) == 14
    assert all(found[each.key] is None for each in OF_SHIFT)


def test_every_metric_of_a_shift_is_printed_from_the_number_of_a_campaign_s_column_too():
    assert [float(f'{2.0:{each.form}}') for each in OF_SHIFT] == [2.0] * len(OF_SHIFT)


def test_a_run_that_ends_before_the_shift_starts_has_works_and_temperatures_alone():
    cut = {name: values[:20] for name, values in made_shift().signals.items()}
    found = metrics_of(engagement_of(Trajectory(cut)))
    defined = {each.key for each in OF_SHIFT if found[each.key] is not None}
    assert defined == {
        'off_going_friction_work_j',
        'on_coming_peak_temperature_degc',
        'off_going_peak_temperature_degc',
    }


def test_the_least_friction_work_of_a_shift_has_both_shafts_and_the_slip_when_feedback_starts():
    scenario = load_scenario('upshift')
    car, gears = scenario.driveline, gears_of(scenario)
    shafts = car.shaft_inertia * (1.0 + gears.ratio**2)
    rest = shafts + car.vehicle_inertia / car.gear.total_ratio**2
    joint = car.engine_inertia * rest / (car.engine_inertia + rest)
    work = np.where(STEP > 30, 1.0, 0.0)
    engagement = replace(
        engagement_of(made_shift(friction_work=work)), plant=JudgedPlant.of(scenario)
    )
    found = metrics_of(engagement)
    expected = 100.0 / (joint * 70.0**2 / 2.0)
    assert found['friction_work_over_least'] == pytest.approx(expected, rel=1e-12)


def capacity(start: float, end: float | None = None) -> Capacity:
    """Return a capacity in N m that is linear over a period."""
    kinetic = np.linspace(start, start if end is None else end, 11).tolist()
    return Capacity(kinetic, kinetic, 20.0)


def row_of(driveline: FrictionDriveline, share: float) -> dict[str, Any]:
    """Return the signals of a tick that the metrics read."""
    return {
        **driveline.outputs().signals,
        'handover_share': share,
        'slip_reference': (0.0,),
        'torque_request': 0.0,
        'torque_demand': 0.0,
        'engine_torque': 0.0,
        'clutch_temperature': 20.0,
        'off_going_clutch_temperature': 20.0,
        'status': (),
    }


def test_an_ideal_torque_phase_dips_by_33_8_percent_without_flare_or_tie_up():
    """1 - T_1/T_0 with T = J_v a + C_load; the off-going clutch sticks throughout."""
    car = replace(DrivelineParameters(), shaft_damping=0.0)
    gears = GearPair(car, Gearbox().gear(1))
    start = driving_start(gears, 10.0, (100.0, 60.0, 0.0))
    driveline = FrictionDriveline(both_engaged(gears), VehicleParameters(), start)
    rows = [row_of(driveline, 0.0)]
    while rows[-1]['off_going_transmitted_torque'] > 0.05:
        step = len(rows) - 1
        on_coming, off_going = capacity(0.1 * step, 0.1 * (step + 1)), capacity(200.0)
        driveline.step(
            100.0,
            60.0,
            0.0,
            *on_coming[:2],
            *off_going[:2],
        )
        rows.append(row_of(driveline, 0.5))
    rows[-1]['handover_share'] = 1.0
    run = Trajectory.of_columns({name: [row[name] for row in rows] for name in rows[0]})
    found = metrics_of(Engagement(run, 0, (0, run.steps)))
    assert found['torque_dip_percent'] == pytest.approx(33.8, abs=0.1)
    assert found['torque_phase_s'] == pytest.approx(0.01 * run.steps, abs=1e-12)
    assert found['flare_rad_s'] == 0.0
    assert found['tie_up_work_j'] < 0.1  # of the last period, in which C_1 passes through zero
    assert found['off_going_friction_work_j'] == 0.0


def test_the_friction_work_of_an_inertia_phase_is_that_of_engine_and_kinetic_energy():
    """W = C_m dw t/2 + J_m dw^2/2 at constant car speed: 5.12 kJ for 150 N m in 0.3 s."""
    car = replace(DrivelineParameters(), vehicle_inertia=1e9)
    engine, torque, time_s = 100.0 * math.pi, 150.0, 0.3
    first, second = Gearbox().gear(1).total_ratio, car.gear.total_ratio
    wheel = engine / first
    slip = engine - second * wheel
    transmitted = torque + car.engine_inertia * slip / time_s
    damping = car.shaft_damping * (first**2 + second**2) * wheel
    twist = (second * transmitted - damping) / car.halfshaft_stiffness
    sides = InitialSide(second * wheel, open=True), InitialSide(engine)
    start = InitialState(engine, wheel, twist, 0.0, 0.0, sides)
    driveline = FrictionDriveline(
        both_engaged(GearPair(car, Gearbox().gear(1))), VehicleParameters(), start
    )
    rows = [row_of(driveline, 1.0)]
    for _ in range(35):
        on_coming, off_going = capacity(transmitted), capacity(0.0)
        driveline.step(
            torque,
            0.0,
            0.0,
            *on_coming[:2],
            *off_going[:2],
        )
        rows.append(row_of(driveline, 1.0))
    run = Trajectory.of_columns({name: [row[name] for row in rows] for name in rows[0]})
    found = metrics_of(Engagement(run, 0, (0, run.steps)))
    expected = torque * slip * time_s / 2.0 + car.engine_inertia * slip**2 / 2.0
    assert found['friction_work_j'] == pytest.approx(expected, rel=5e-3)
    assert (found['torque_phase_s'], found['off_going_friction_work_j']) == (0.0, 0.0)
    assert found['shift_time_s'] == found['inertia_phase_s'] == pytest.approx(time_s, rel=1e-3)
