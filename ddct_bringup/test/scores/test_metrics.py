# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every metric for a trajectory with known values."""

import json
import math

import numpy as np
import pytest

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.catalogue import METRICS
from ddct_bringup.metrics.engagement import Engagement
from ddct_bringup.metrics.values import compute_metrics, metrics_of
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_plant.models.driveline import PhaseEvent
from ddct_plant.signals.topics import SHIFT_TOPICS, all_signals

STEPS = 300
TIME = np.arange(STEPS + 1) / 100.0
RPM = 30.0 / math.pi
WINDOW = (0.6, 2.0)
IN_WINDOW = slice(60, 201)
OF_SHIFT = {signal.name for topic in SHIFT_TOPICS for signal in topic.signals}


def trajectory(steps=STEPS, **signals):
    """Return a run of zeros with the given signals, cut to `steps`."""
    shapes = {
        'joint_position': (4,),
        'joint_speed': (4,),
        'joint_effort': (4,),
        'slip_reference': (1,),
        'slip_reference_rate': (1,),
        'actuator_torque': (11,),
        'clutch_torque': (11,),
    }
    arrays = {
        each.name: signals.get(each.name, np.zeros((STEPS + 1, *shapes.get(each.name, ()))))
        for each in all_signals()
        if each.name not in ('status', 'friction_work', 'clutch_phase', 'phase_events', *OF_SHIFT)
    }
    rows = {name: np.asarray(value, float)[: steps + 1] for name, value in arrays.items()}
    return Trajectory({**rows, 'status': ((),) * (steps + 1)})


def columns(index, values, width=4):
    result = np.zeros((len(values), width))
    result[:, index] = values
    return result


def score(run, timing=None, control_start_s=0.6):
    return compute_metrics(
        run, control_start_s=control_start_s, score_window_s=WINDOW, timing=timing
    )


@pytest.mark.parametrize('sign', [1.0, -1.0])
def test_engagement_time_is_interpolated_from_control_start(sign):
    # The samples around the zero at 1.254 s are those of 1.25 s and 1.26 s.
    metrics = score(trajectory(slip_speed=sign * 16.0 * (1.254 - TIME)))
    assert metrics['engagement_time_s'] == pytest.approx(1.254 - 0.6, abs=1e-12)
    assert metrics['lockup_slip_acceleration_rad_s2'] == pytest.approx(-16.0 * sign, rel=1e-9)


def test_sign_changes_before_control_start_do_not_count():
    slip = np.where(TIME < 0.3, -1.0, 1.0) * 5.0
    assert score(trajectory(slip_speed=slip))['engagement_time_s'] is None


def test_engagement_time_is_undefined_without_a_sign_change():
    metrics = score(trajectory(slip_speed=np.full(STEPS + 1, 3.0)))
    assert metrics['engagement_time_s'] is None
    assert metrics['lockup_slip_acceleration_rad_s2'] is None


def test_engagement_time_is_undefined_when_slip_is_zero_at_control_start():
    assert score(trajectory(slip_speed=np.maximum(TIME - 0.6, 0.0)))['engagement_time_s'] is None


def test_engagement_time_is_undefined_when_the_run_ends_before_control_starts():
    assert score(trajectory(steps=50))['engagement_time_s'] is None


def sticking(slip, events):
    """Return a run with a stick-slip clutch and its events by step."""
    run = trajectory(slip_speed=slip)
    steps = tuple(events.get(step, ()) for step in range(STEPS + 1))
    phase = np.where(slip == 0.0, 2.0, 1.0)
    return Trajectory({**run.signals, 'clutch_phase': phase, 'phase_events': steps})


SLIP = np.maximum(19.6 - 16.0 * TIME, 0.0)
"""Slip in rad/s that is zero from 1.23 s on, with the lock at 1.225 s."""


def test_a_clutch_that_sticks_is_engaged_at_the_instant_of_its_first_lock():
    metrics = score(sticking(SLIP, {123: (PhaseEvent(1.225, 'lock', -62.6),)}))
    assert metrics['engagement_time_s'] == pytest.approx(1.225 - 0.6, abs=1e-12)
    assert metrics['lockup_slip_acceleration_rad_s2'] == -62.6


def test_a_lock_between_two_samples_that_both_slip_is_an_engagement():
    events = (PhaseEvent(1.003, 'lock', -50.0), PhaseEvent(1.005, 'release', 0.0))
    metrics = score(sticking(np.full(STEPS + 1, 3.0), {101: events}))
    assert metrics['engagement_time_s'] == pytest.approx(1.003 - 0.6, abs=1e-12)
    assert metrics['lockup_slip_acceleration_rad_s2'] == -50.0


def test_plates_that_pass_through_zero_are_engaged_there_and_locked_later():
    slip = np.where(TIME < 1.0025, 3.0, np.where(TIME < 1.5, -3.0, 0.0))
    passing, lock = PhaseEvent(1.0075, 'reverse', -20.0), PhaseEvent(1.495, 'lock', 44.0)
    metrics = score(sticking(slip, {101: (passing,), 150: (lock,)}))
    assert metrics['engagement_time_s'] == pytest.approx(1.0075 - 0.6, abs=1e-12)
    assert metrics['lockup_slip_acceleration_rad_s2'] == 44.0


def test_bags_from_before_reversals_and_slip_accelerations_have_the_other_metrics():
    slip = np.where(TIME < 1.0025, 3.0, np.where(TIME < 1.5, -1.0, 0.0))
    later = score(sticking(slip, {150: (PhaseEvent(1.495, 'lock'),)}))
    assert later['engagement_time_s'] == pytest.approx(1.0075 - 0.6, abs=1e-12)
    assert later['lockup_slip_acceleration_rad_s2'] is None
    lock = score(sticking(SLIP, {123: (PhaseEvent(1.225, 'lock'),)}))
    assert lock['engagement_time_s'] == pytest.approx(1.225 - 0.6, abs=1e-12)
    assert lock['lockup_slip_acceleration_rad_s2'] is None


def test_events_before_control_start_do_not_count():
    slip = np.where((TIME > 0.2) & (TIME < 0.3), 0.0, 3.0)
    lock = (PhaseEvent(0.195, 'lock', -9.0),)
    metrics = score(sticking(slip, {20: lock, 31: (PhaseEvent(0.3, 'release', 0.0),)}))
    assert metrics['engagement_time_s'] is None
    assert metrics['lockup_slip_acceleration_rad_s2'] is None


def test_standard_deviations_are_over_the_window_with_both_ends_and_ddof_0():
    values = np.random.default_rng(1).standard_normal(STEPS + 1)
    metrics = score(trajectory(joint_speed=columns(3, values), vehicle_accel=2.0 * values))
    inside = values[IN_WINDOW]
    expected = math.sqrt(float(np.mean((inside - inside.mean()) ** 2)))
    assert metrics['torsion_speed_std_rpm'] == pytest.approx(expected * RPM, rel=1e-12)
    assert metrics['acceleration_std_m_s2'] == pytest.approx(2.0 * expected, rel=1e-12)


def test_final_slip_keeps_its_sign():
    assert score(trajectory(slip_speed=-TIME))['slip_final_rpm'] == pytest.approx(-3.0 * RPM)


def test_window_metrics_do_not_depend_on_what_comes_after_the_window():
    values = np.random.default_rng(2).standard_normal(STEPS + 1)
    signals = {'vehicle_accel': values, 'joint_speed': columns(3, values)}
    whole, cut = (score(trajectory(steps, **signals)) for steps in (300, 200))
    for name in ('torsion_speed_std_rpm', 'acceleration_std_m_s2'):
        assert whole[name] == cut[name] > 0.0


def test_window_metrics_are_undefined_when_the_run_is_one_step_too_short():
    metrics = score(trajectory(steps=199))
    assert metrics['torsion_speed_std_rpm'] is None
    assert metrics['acceleration_std_m_s2'] is None
    assert metrics['peak_jerk_m_s3'] == 0.0, 'a figure has no window'
    assert metrics['slip_final_rpm'] == 0.0
    assert metrics['steps'] == 199


@pytest.mark.parametrize('at_s', [0.65, 1.9, 2.1, 2.95])
def test_peak_jerk_counts_from_control_start_to_the_end_of_the_run(at_s):
    """A jolt after the score window, as from a late lock, counts as much as one within it."""
    jolt = 0.05 * np.exp(-(((TIME - at_s) / 0.03) ** 2))
    steady = 0.5 * TIME + np.where(TIME < 0.3, 100.0, 0.0)
    found = score(trajectory(vehicle_accel=steady + jolt))['peak_jerk_m_s3']
    steepest = 0.05 / 0.03 * math.sqrt(2.0) * math.exp(-0.5)
    assert found == pytest.approx(0.5 + steepest, rel=0.1)


@pytest.mark.parametrize('control_start_s', [0.0, 0.6])
def test_peak_jerk_of_an_even_ramp_is_its_slope_at_both_ends_too(control_start_s):
    ramp = 7.0 - 2.5 * TIME
    found = score(trajectory(vehicle_accel=ramp), control_start_s=control_start_s)[
        'peak_jerk_m_s3'
    ]
    assert found == pytest.approx(2.5, rel=1e-3)


@pytest.mark.parametrize(('planned', 'is_there'), [(200, True), (201, False)])
def test_peak_jerk_of_a_whole_run_is_there_and_of_one_that_ends_before_its_plan_is_not(
    planned, is_there
):
    run = trajectory(200, vehicle_accel=np.sin(2.0 * np.pi * TIME))
    found = metrics_of(Engagement(run, 60, (60, 200), planned))['peak_jerk_m_s3']
    assert (found is not None) is is_there
    assert found is None or found > 6.0


def test_friction_work_is_the_integral_of_the_magnitude_of_power_from_control_start_on():
    slip = 1.5 - TIME
    metrics = score(trajectory(slip_speed=slip, joint_effort=columns(1, np.full(301, -100.0))))
    expected = 100.0 * (0.9**2 + 1.5**2) / 2.0
    assert metrics['friction_work_j'] == pytest.approx(expected, rel=1e-9)


def test_wall_clock_metrics_come_from_timing():
    timing = RunTiming(
        update_times_us=[float(i) for i in range(1, 102)], missed_steps=3, resends=4
    )
    metrics = score(trajectory(), timing)
    assert metrics['update_time_median_us'] == 51.0
    assert metrics['update_time_p99_us'] == pytest.approx(100.0)
    assert (metrics['missed_steps'], metrics['resends']) == (3, 4)


def test_wall_clock_metrics_are_undefined_without_timing():
    metrics = score(trajectory())
    assert metrics['update_time_median_us'] is None
    assert metrics['update_time_p99_us'] is None
    assert metrics['missed_steps'] is None
    assert metrics['resends'] is None


def test_update_times_are_undefined_when_none_was_taken():
    metrics = score(trajectory(), RunTiming())
    assert metrics['update_time_median_us'] is None
    assert metrics['missed_steps'] == 0


@pytest.mark.parametrize('value', [math.nan, math.inf, -math.inf])
def test_non_finite_signals_give_no_non_finite_metric(value):
    spoiled = np.sin(TIME)
    spoiled[100] = value
    metrics = score(
        trajectory(
            slip_speed=spoiled,
            vehicle_accel=spoiled,
            torque_request=spoiled,
            joint_speed=columns(3, spoiled),
            joint_effort=columns(1, spoiled),
        )
    )
    json.dumps(metrics, allow_nan=False)
    assert metrics['torsion_speed_std_rpm'] is None
    assert metrics['friction_work_j'] is None


def test_metrics_have_the_names_that_other_scripts_rely_on():
    assert list(METRICS) == [
        'time_to_final_lock_s',
        'torque_late_s',
        'peak_jerk_m_s3',
        'friction_work_j',
        'weighted_acceleration_m_s2',
        'releases',
        'peak_jerk_over_least',
        'friction_work_over_least',
        'shift_time_s',
        'torque_phase_s',
        'inertia_phase_s',
        'torque_dip_percent',
        'flare_rad_s',
        'tie_up_work_j',
        'engagement_time_s',
        'torsion_speed_std_rpm',
        'acceleration_std_m_s2',
        'slip_final_rpm',
        'lockup_slip_acceleration_rad_s2',
        'peak_temperature_degc',
        'driving_acceleration_m_s2',
        'mean_acceleration_m_s2',
        'mean_negative_jerk_m_s3',
        'judder_rpm',
        'steps',
        'update_time_median_us',
        'update_time_p99_us',
        'missed_steps',
        'resends',
        'worst_lateness_us',
        'torque_dip_n_m',
        'off_going_friction_work_j',
        'on_coming_peak_temperature_degc',
        'off_going_peak_temperature_degc',
        'on_coming_locks',
        'on_coming_releases',
        'off_going_locks',
        'off_going_releases',
    ]
