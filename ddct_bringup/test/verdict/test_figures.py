# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every figure, and every metric with a limit, for a run with known values."""

from dataclasses import replace

import numpy as np
import pytest
from made_run import CONTROL_START, RAD_S_PER_RPM, made_run, times

from ddct_bringup.metrics.catalogue import METRICS
from ddct_bringup.metrics.engagement import Engagement
from ddct_bringup.metrics.plant import JudgedPlant
from ddct_bringup.metrics.signals.vibration import weighted_acceleration
from ddct_bringup.metrics.values import metrics_of, null_reasons
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.models.clutch import FrictionParameters
from ddct_plant.models.driveline import PhaseEvent
from ddct_plant.models.parameters import DrivelineParameters, VehicleParameters

T = times()
WINDOW = (60, 200)
PLANT = JudgedPlant.of_parameters(DrivelineParameters(), VehicleParameters(), FrictionParameters())


def engagement(run, planned_steps=0, plant=PLANT):
    return Engagement(run, CONTROL_START, WINDOW, planned_steps, plant)


def values(run):
    return metrics_of(engagement(run))


def reason(run, name, **given):
    """Return why a figure of a run is null."""
    judged = engagement(run, **given)
    found = metrics_of(judged)
    assert found[name] is None
    return null_reasons(judged, found)[name]


def shaft(signal, index=3):
    result = np.zeros((len(signal), 4))
    result[:, index] = signal
    return result


def sticking(events, phase, slip=None, **signals):
    """Return a run with a stick-slip clutch, with its events by step as (time, kind) and more."""
    slip = np.zeros(301) if slip is None else slip
    steps = tuple(
        tuple(PhaseEvent(*event) for event in events.get(step, ())) for step in range(301)
    )
    return made_run(slip, clutch_phase=phase, phase_events=steps, **signals)


def phases(*changes):
    """Return the phase at each step of (first step, phase) pairs."""
    result = np.zeros(301)
    for first, phase in changes:
        result[first:] = phase
    return result


def test_a_linear_clutch_has_no_lock_and_no_releases():
    run = made_run(600.0 - 600.0 * (T - 0.6))
    for name in ('time_to_final_lock_s', 'releases'):
        assert reason(run, name) == 'a linear clutch cannot lock'
    assert reason(run, 'peak_temperature_degc') == 'the clutch is linear'
    assert values(run)['engagement_time_s'] == pytest.approx(1.0)


def test_the_final_lock_is_the_last_one_after_which_no_release_follows():
    events = {
        20: [(0.195, 'lock')],
        30: [(0.3, 'release')],
        151: [(1.5034, 'lock'), (1.509, 'release')],
        160: [(1.595, 'lock')],
    }
    found = values(sticking(events, phases((0, 1), (20, 2), (30, 1), (160, 2))))
    assert found['time_to_final_lock_s'] == pytest.approx(0.995)
    assert found['releases'] == 1


def test_plates_that_never_part_have_the_final_lock_at_control_start():
    found = values(sticking({20: [(0.195, 'lock')]}, phases((0, 1), (20, 2))))
    assert (found['time_to_final_lock_s'], found['releases']) == (0.0, 0)


def test_releases_of_plates_that_were_locked_at_control_start_count():
    events = {20: [(0.195, 'lock')], 100: [(0.993, 'release')], 120: [(1.2, 'lock')]}
    found = values(sticking(events, phases((0, 1), (20, 2), (100, 1), (120, 2))))
    assert found['time_to_final_lock_s'] == pytest.approx(0.6)
    assert found['releases'] == 1


def test_plates_that_slip_at_the_end_have_releases_but_no_final_lock():
    run = sticking(
        {100: [(1.0, 'lock')], 290: [(2.9, 'release')]}, phases((0, 1), (100, 2), (290, 1))
    )
    assert reason(run, 'time_to_final_lock_s') == 'the plates are not locked at the end'
    assert values(run)['releases'] == 1
    assert values(sticking({}, phases((0, 1))))['releases'] == 0


def late(demand, torque):
    """Return a run with a demand and an engine torque in N m."""
    demand, torque = (np.broadcast_to(each, T.shape) + 0.0 for each in (demand, torque))
    return made_run(np.zeros(301), torque_demand=demand, engine_torque=torque)


def test_torque_that_comes_late_is_the_missing_part_of_the_largest_demand():
    half = np.where((T >= 1.0 - 1e-9) & (T < 1.5 - 1e-9), 100.0, 200.0)
    assert values(late(200.0, half))['torque_late_s'] == pytest.approx(0.25)
    before = np.where(T < 0.6 - 1e-9, 0.0, 200.0)
    assert values(late(200.0, before))['torque_late_s'] == pytest.approx(0.0)
    assert values(late(200.0, 300.0))['torque_late_s'] == 0.0  # what is given above pays for none
    paid_back = np.where(T < 1.0 - 1e-9, 0.0, 300.0)
    assert values(late(200.0, paid_back))['torque_late_s'] == pytest.approx(0.4)


def test_without_a_demand_or_with_one_of_both_signs_no_torque_is_late():
    assert reason(late(0.0, 10.0), 'torque_late_s') == 'there is no demand'
    both = np.where(T < 1.0, 100.0, -1.0)
    assert reason(late(both, 0.0), 'torque_late_s') == 'the demand is negative at some time'
    assert reason(late(-5.0, 0.0), 'torque_late_s') == 'the demand is negative at some time'


def test_a_run_that_ends_early_has_no_peak_jerk():
    run = made_run(np.zeros(250), vehicle_accel=T[:250])
    assert values(run)['peak_jerk_m_s3'] == pytest.approx(1.0, rel=0.01)
    assert reason(run, 'peak_jerk_m_s3', planned_steps=300) == 'the run ends before its plan'


def test_a_jolt_after_the_score_window_has_the_peak_jerk_of_one_within_it():
    def jolt(at_s):
        return values(
            made_run(np.zeros(301), vehicle_accel=5.0 * np.exp(-(((T - at_s) / 0.1) ** 2)))
        )

    for name in ('peak_jerk_m_s3', 'weighted_acceleration_m_s2'):
        assert jolt(2.5)[name] == pytest.approx(jolt(1.2)[name], rel=0.05)
        assert jolt(0.2)[name] < 0.5 * jolt(1.2)[name]  # one before control start does not count


def test_a_run_that_ends_before_control_start_has_no_figures():
    run = made_run(np.zeros(50))
    for name in ('torque_late_s', 'peak_jerk_m_s3', 'friction_work_j'):
        assert reason(run, name) == 'the run ends before control start'


def test_friction_work_is_that_which_the_run_reports_or_that_of_torque_and_slip():
    torque = shaft(np.full(301, 100.0), 1)
    slip = np.full(301, 2.0 / RAD_S_PER_RPM)
    assert values(made_run(slip, joint_effort=torque))['friction_work_j'] == pytest.approx(480.0)
    work = np.full(301, 0.5)
    reported = made_run(slip, joint_effort=torque, friction_work=work)
    assert values(reported)['friction_work_j'] == pytest.approx(120.0)


def test_peak_temperature_is_the_highest():
    found = values(made_run(np.zeros(301), clutch_temperature=np.linspace(20.0, 180.0, 301)))
    assert found['peak_temperature_degc'] == 180.0


def test_judder_is_the_rms_of_w_sr_while_slipping_within_its_band():
    slip = np.where(T <= 2.0, 300.0, -1.0)
    in_band = 4.0 * RAD_S_PER_RPM * np.sin(2 * np.pi * 8.0 * T)
    outside = 9.0 * RAD_S_PER_RPM * np.sin(2 * np.pi * 0.3 * T)
    after = np.where(T > 2.01, 1000.0, 0.0)
    speed = shaft(in_band + outside + after)
    found = values(made_run(slip, joint_speed=speed))['judder_rpm']
    assert found == pytest.approx(4.0 / np.sqrt(2.0), rel=0.05)


def test_judder_of_a_linear_clutch_that_never_comes_together_is_that_of_the_whole_run():
    speed = shaft(4.0 * RAD_S_PER_RPM * np.sin(2 * np.pi * 8.0 * T))
    found = values(made_run(np.full(301, 300.0), joint_speed=speed))
    assert found['engagement_time_s'] is None
    assert found['judder_rpm'] == pytest.approx(4.0 / np.sqrt(2.0), rel=0.05)


@pytest.mark.parametrize('samples', [15, 50, 51, 100, 101])
@pytest.mark.parametrize('clutch', ['linear', 'stick_slip'])
def test_judder_needs_half_a_second_of_slipping_one_period_of_2_hz(clutch, samples):
    from scipy.signal import butter, sosfiltfilt

    speed = 9.0 * np.sin(50.0 * T)
    if clutch == 'linear':
        slip = np.where((60 + samples) / 100.0 - 1e-9 > T, 300.0, -1e-9)
        found = values(made_run(slip, joint_speed=shaft(speed)))['judder_rpm']
    else:
        phase = phases((0, 2), (60, 1), (60 + samples, 2))
        found = values(sticking({}, phase, joint_speed=shaft(speed)))['judder_rpm']
    band = butter(2, (2.0, 20.0), 'bandpass', fs=100.0, output='sos')
    if samples < 51:
        assert found is None
        return
    filtered = sosfiltfilt(band, speed[60 : 60 + samples] / RAD_S_PER_RPM)
    assert found == pytest.approx(np.sqrt(np.mean(filtered**2)), rel=1e-9)


def test_judder_goes_on_over_short_locks_from_control_start_to_the_last_slip():
    """Locks and releases every 0.1 s are judder; samples before control start do not count."""
    every = [(step, 1 + step // 10 % 2) for step in range(60, 200, 10)]
    speed = shaft(np.where(T < 0.6, 99.0, 1.0) * np.sin(50.0 * T))
    some = values(sticking({}, phases((0, 1), *every), joint_speed=speed))['judder_rpm']
    slips_on = values(sticking({}, phases((0, 1), (190, 2)), joint_speed=speed))['judder_rpm']
    assert some == slips_on
    assert some == pytest.approx(1.0 / np.sqrt(2.0) / RAD_S_PER_RPM, rel=0.1)


def test_slip_acceleration_at_lock_up_is_that_of_the_first_lock_after_control_start():
    events = {
        20: [(0.195, 'lock', -1.0)],
        30: [(0.3, 'release', 2.0)],
        151: [(1.503, 'reverse', -3.0), (1.505, 'lock', 62.5), (1.507, 'release', 0.0)],
        160: [(1.595, 'lock', -5.0)],
    }
    phase = phases((0, 1), (20, 2), (30, 1), (160, 2))
    slip = np.where(T < 0.195, 9.0, np.where(phase == 2, 0.0, 200.0 * np.abs(1.51 - T)))
    found = values(sticking(events, phase, slip))
    assert found['lockup_slip_acceleration_rad_s2'] == 62.5
    assert found['engagement_time_s'] == pytest.approx(0.903)


def test_plates_locked_at_control_start_have_no_first_lock():
    events = {100: [(0.993, 'release', 1.0)], 120: [(1.2, 'lock', -62.5)]}
    phase = phases((0, 2), (100, 1), (120, 2))
    found = values(sticking(events, phase, np.where(phase == 2, 0.0, 5.0)))
    for name in ('lockup_slip_acceleration_rad_s2', 'engagement_time_s'):
        assert found[name] is None, name


def test_mean_acceleration_and_mean_negative_jerk_are_those_of_iso_15622():
    acceleration = np.interp(T, [0.6, 1.0, 2.0, 2.6], [0.0, 3.0, 3.0, 0.0])
    acceleration[:60] = 99.0
    found = values(made_run(np.zeros(301), vehicle_accel=acceleration))
    assert found['mean_acceleration_m_s2'] == pytest.approx((0.6 + 3.0 + 0.9) / 2.0)
    assert found['mean_negative_jerk_m_s3'] == pytest.approx(-3.0)
    rising = values(made_run(np.zeros(301), vehicle_accel=T))
    assert rising['mean_negative_jerk_m_s3'] == 0.0
    short = values(made_run(np.zeros(260), vehicle_accel=acceleration[:260]))
    assert short['mean_acceleration_m_s2'] is None
    assert short['mean_negative_jerk_m_s3'] is not None
    assert values(made_run(np.zeros(160)))['mean_negative_jerk_m_s3'] is None


def test_friction_work_is_relative_to_the_loss_of_two_free_inertias():
    # A heavy car: C_f = C_m + J_m w_d/t takes the slip w_d linearly to zero within t.
    slip_rpm, time_s, demand = 400.0, 1.0, 300.0
    slip = slip_rpm * np.clip(1.6 - T, 0.0, 1.0)
    slip_rad_s = slip_rpm * RAD_S_PER_RPM
    torque = np.where(slip > 0.0, demand + PLANT.engine_inertia * slip_rad_s / time_s, 0.0)
    run = made_run(slip, joint_effort=shaft(torque, 1))
    heavy = replace(PLANT, rest_inertia=1e9)
    found = metrics_of(engagement(run, plant=heavy))['friction_work_over_least']
    assert found == pytest.approx(1.0 + demand * time_s / (PLANT.engine_inertia * slip_rad_s))
    limit = packaged_limits().of('thesis', PLANT)['friction_work_over_least'][0]
    assert limit == pytest.approx(found, rel=0.02)


def test_friction_work_before_control_start_does_not_count():
    slip, work = np.full(301, 400.0), np.where(T <= 0.6, 1e6, 2.0)
    found = values(made_run(slip, friction_work=work))['friction_work_over_least']
    least = PLANT.joint_inertia * (400.0 * RAD_S_PER_RPM) ** 2 / 2.0
    assert found == pytest.approx(480.0 / least)


def test_with_hardly_any_slip_at_control_start_there_is_no_minimum_of_the_work():
    for slip_rpm, exists in ((49.9, False), (50.1, True), (-50.1, True)):
        run = made_run(np.full(301, slip_rpm), friction_work=np.ones(301))
        assert (values(run)['friction_work_over_least'] is not None) == exists
        name = 'friction_work_over_least'
        assert reason(run, name, plant=None) == 'the plant is not known'
    small = made_run(np.full(301, 49.9), friction_work=np.ones(301))
    assert reason(small, name) == 'the slip is below 50 rpm where feedback starts'


def test_the_limit_of_judder_is_the_shuffle_that_alone_is_felt():
    # A_x = r_w/J_v (c_sa + k_sa/(j w)) w_sr with the wheel's load constant, weighted by W_d.
    car, vehicle, t = DrivelineParameters(), VehicleParameters(), times(40.0)
    angular = 2 * np.pi * 2.93
    stiffness = abs(car.halfshaft_damping + car.halfshaft_stiffness / (1j * angular))
    per_speed = stiffness * vehicle.wheel_radius_m / car.vehicle_inertia
    felt = weighted_acceleration(per_speed * np.sin(angular * t))[2000:]
    at_limit_rpm = 0.315 * np.sqrt(0.5) / np.sqrt(np.mean(felt**2)) / RAD_S_PER_RPM
    assert packaged_limits().of('thesis', PLANT)['judder_rpm'][0] == pytest.approx(
        at_limit_rpm, rel=0.1
    )


def test_weighted_acceleration_of_a_sine_is_its_rms_times_the_weight():
    t = times(40.0)
    run = made_run(np.zeros(len(t)), vehicle_accel=2.0 * np.sin(2 * np.pi * t))
    expected = 1.011 * 2.0 / np.sqrt(2.0)
    assert values(run)['weighted_acceleration_m_s2'] == pytest.approx(expected, rel=0.05)
    short = made_run(np.zeros(160))
    why = 'the run ends less than 1 s after control start'
    assert reason(short, 'weighted_acceleration_m_s2') == why


@pytest.mark.parametrize('name', ['joint_speed', 'joint_effort', 'vehicle_accel', 'slip_speed'])
def test_a_value_that_is_not_finite_makes_no_number_up(name):
    run = made_run(np.full(301, 100.0))
    spoiled = run.signals[name].copy()
    spoiled[150] = np.nan
    found = values(made_run(np.full(301, 100.0), **{name: spoiled}))
    assert all(value is None or np.isfinite(value) for value in found.values())


@pytest.mark.parametrize('rows', [1, 2, 30, 61, 62])
def test_a_run_of_any_length_has_a_value_or_a_reason_for_each_metric(rows):
    judged = engagement(made_run(np.full(rows, 100.0)))
    found = metrics_of(judged)
    nulls = {name for name, value in found.items() if value is None}
    assert set(found) == set(METRICS)
    assert nulls - {'peak_jerk_over_least'} == set(null_reasons(judged, found))
