# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every criterion for a run with known values."""

from dataclasses import asdict, replace

import numpy as np
import pytest
from made_run import CONTROL_START, RAD_S_PER_RPM, made_run, times

from ddct_bringup.metrics.catalogue import CRITERION_UNITS
from ddct_bringup.metrics.engagement import Engagement
from ddct_bringup.metrics.plant import JudgedPlant
from ddct_bringup.metrics.signals.vibration import weighted_acceleration
from ddct_bringup.metrics.values import compute_metrics, criteria_of, existing, metrics_of
from ddct_bringup.verdict.limits import limits_of_text, packaged_limits
from ddct_bringup.verdict.state import STATES
from ddct_bringup.verdict.verdict import verdict_of
from ddct_plant.models.driveline import PhaseEvent
from ddct_plant.models.parameters import DrivelineParameters, VehicleParameters

T = times()
WINDOW_S, WINDOW = (0.6, 2.0), (60, 200)
PLANT = JudgedPlant.of_parameters(DrivelineParameters(), VehicleParameters())


def values(run, start=CONTROL_START, engagements=1000.0):
    return criteria(Engagement(run, start, WINDOW, engagements, PLANT))


def criteria(engagement):
    return criteria_of(engagement, metrics_of(engagement))


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


def test_a_linear_clutch_never_locks():
    found = values(made_run(600.0 - 600.0 * (T - 0.6)))
    assert found['time_to_lock'] is None
    assert found['releases_after_lock'] is None
    assert found['peak_temperature'] is None
    assert found['engagement_time'] == pytest.approx(1.0)


def test_time_to_lock_is_that_of_the_first_lock_after_control_start():
    events = {
        20: [(0.195, 'lock')],
        30: [(0.3, 'release')],
        151: [(1.5034, 'lock'), (1.509, 'release')],
        160: [(1.595, 'lock')],
    }
    found = values(sticking(events, phases((0, 1), (20, 2), (30, 1), (160, 2))))
    assert found['time_to_lock'] == pytest.approx(0.9034)
    assert found['releases_after_lock'] == 1


def test_releases_of_plates_that_were_locked_at_control_start_count():
    events = {20: [(0.195, 'lock')], 100: [(0.993, 'release')], 120: [(1.2, 'lock')]}
    found = values(sticking(events, phases((0, 1), (20, 2), (100, 1), (120, 2))))
    assert found['time_to_lock'] is None
    assert found['releases_after_lock'] == 1


def test_plates_that_only_slip_have_no_releases():
    found = values(sticking({}, phases((0, 1))))
    assert found['time_to_lock'] is None
    assert found['releases_after_lock'] is None


def test_friction_energy_is_the_work_that_the_run_reports_or_that_of_torque_and_slip():
    torque = shaft(np.full(301, 100.0), 1)
    slip = np.full(301, 2.0 / RAD_S_PER_RPM)
    assert values(made_run(slip, joint_effort=torque))['friction_energy'] == pytest.approx(600.0)
    work = np.full(301, 0.5)
    reported = made_run(slip, joint_effort=torque, friction_work=work)
    assert values(reported)['friction_energy'] == pytest.approx(150.5)


def test_peak_temperature_is_the_highest():
    found = values(made_run(np.zeros(301), clutch_temperature=np.linspace(20.0, 180.0, 301)))
    assert found['peak_temperature'] == 180.0


def test_judder_is_the_rms_of_w_sr_while_slipping_within_its_band():
    slip = np.where(T <= 2.0, 300.0, -1.0)
    in_band = 4.0 * RAD_S_PER_RPM * np.sin(2 * np.pi * 8.0 * T)
    outside = 9.0 * RAD_S_PER_RPM * np.sin(2 * np.pi * 0.3 * T)
    after = np.where(T > 2.01, 1000.0, 0.0)
    speed = shaft(in_band + outside + after)
    found = values(made_run(slip, joint_speed=speed))['judder']
    assert found == pytest.approx(4.0 / np.sqrt(2.0), rel=0.05)


def test_judder_of_a_linear_clutch_that_never_comes_together_is_that_of_the_whole_run():
    speed = shaft(4.0 * RAD_S_PER_RPM * np.sin(2 * np.pi * 8.0 * T))
    found = values(made_run(np.full(301, 300.0), joint_speed=speed))
    assert found['engagement_time'] is None
    assert found['judder'] == pytest.approx(4.0 / np.sqrt(2.0), rel=0.05)


@pytest.mark.parametrize('samples', [0, 50, 51])
def test_the_limit_of_judder_does_not_apply_to_a_slip_that_is_too_short_for_it(samples):
    phase = phases((0, 2), (60, 1), (60 + samples, 2)) if samples else phases((0, 2))
    run = made_run(np.zeros(301), clutch_phase=phase)
    judged = Engagement(run, CONTROL_START, WINDOW)
    assert existing(judged)['judder'] == (samples >= 51)


@pytest.mark.parametrize('samples', [15, 50, 51, 100, 101])
@pytest.mark.parametrize('clutch', ['linear', 'stick_slip'])
def test_judder_needs_half_a_second_of_slipping_one_period_of_2_hz(clutch, samples):
    from scipy.signal import butter, sosfiltfilt

    speed = 9.0 * np.sin(50.0 * T)
    if clutch == 'linear':
        slip = np.where((60 + samples) / 100.0 - 1e-9 > T, 300.0, -1e-9)
        found = values(made_run(slip, joint_speed=shaft(speed)))['judder']
    else:
        phase = phases((0, 2), (60, 1), (60 + samples, 2))
        found = values(sticking({}, phase, joint_speed=shaft(speed)))['judder']
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
    some = values(sticking({}, phases((0, 1), *every), joint_speed=speed))['judder']
    slips_on = values(sticking({}, phases((0, 1), (190, 2)), joint_speed=speed))['judder']
    assert some == slips_on
    assert some == pytest.approx(1.0 / np.sqrt(2.0) / RAD_S_PER_RPM, rel=0.1)


def test_slip_acceleration_at_lock_is_that_of_the_first_lock_after_control_start():
    events = {
        20: [(0.195, 'lock', -1.0)],
        30: [(0.3, 'release', 2.0)],
        151: [(1.503, 'reverse', -3.0), (1.505, 'lock', 62.5), (1.507, 'release', 0.0)],
        160: [(1.595, 'lock', -5.0)],
    }
    phase = phases((0, 1), (20, 2), (30, 1), (160, 2))
    slip = np.where(T < 0.195, 9.0, np.where(phase == 2, 0.0, 200.0 * np.abs(1.51 - T)))
    found = values(sticking(events, phase, slip))
    assert found['slip_acceleration_at_lock'] == 62.5
    assert found['time_to_lock'] == pytest.approx(0.905)
    assert found['engagement_time'] == pytest.approx(0.903)


def test_plates_locked_at_control_start_have_no_first_lock():
    events = {100: [(0.993, 'release', 1.0)], 120: [(1.2, 'lock', -62.5)]}
    phase = phases((0, 2), (100, 1), (120, 2))
    found = values(sticking(events, phase, np.where(phase == 2, 0.0, 5.0)))
    for name in ('slip_acceleration_at_lock', 'time_to_lock', 'engagement_time'):
        assert found[name] is None, name


def test_shuffle_after_lock_has_an_amplitude_and_a_time_in_which_it_decays():
    lock = 1.5
    after = np.maximum(T - lock, 0.0)
    ringing = np.where(lock <= T, np.exp(-after / 0.2) * np.cos(2 * np.pi * 8.0 * after), 99.0)
    run = sticking(
        {150: [(lock, 'lock')]},
        phases((0, 1), (150, 2)),
        joint_speed=shaft(30.0 * RAD_S_PER_RPM * ringing),
    )
    found = values(run)
    assert found['shuffle_amplitude'] == pytest.approx(30.0)
    # The last half wave above 1/e ends up to half a period, 62.5 ms, before or after 0.2 s.
    assert found['shuffle_decay'] == pytest.approx(0.2, abs=0.0625)


def test_shuffle_that_goes_on_has_no_decay_and_one_without_lock_no_amplitude():
    speed = shaft(np.sin(50.0 * T))
    locked = sticking({150: [(1.5, 'lock')]}, phases((0, 1), (150, 2)), joint_speed=speed)
    assert values(locked)['shuffle_decay'] is None
    assert values(locked)['shuffle_amplitude'] > 9.0
    slipping = made_run(np.full(301, 100.0), joint_speed=speed)
    assert values(slipping)['shuffle_amplitude'] is None


def test_torque_dip_is_the_largest_fall_after_control_start():
    torque = np.interp(T, [0.0, 0.1, 1.0, 1.2, 1.5, 3.0], [0.0, 900.0, 500.0, 380.0, 600.0, 570.0])
    torque[:60] = np.linspace(900.0, 0.0, 60)
    found = values(made_run(np.zeros(301), joint_effort=shaft(torque)))
    expected = torque[60] - 380.0
    assert found['torque_dip'] == pytest.approx(expected)


def test_mean_jerk_is_the_change_of_acceleration_within_one_second():
    acceleration = np.interp(T, [0.0, 1.0, 1.5, 3.0], [9.0, 0.0, 1.5, 1.5])
    acceleration[:60] = -99.0
    found = values(made_run(np.zeros(301), vehicle_accel=acceleration))
    assert found['mean_jerk'] == pytest.approx(abs(acceleration[160] - acceleration[60]))
    assert found['peak_acceleration'] == pytest.approx(acceleration[60])


def test_mean_acceleration_and_mean_negative_jerk_are_those_of_iso_15622():
    acceleration = np.interp(T, [0.6, 1.0, 2.0, 2.6], [0.0, 3.0, 3.0, 0.0])
    acceleration[:60] = 99.0
    found = values(made_run(np.zeros(301), vehicle_accel=acceleration))
    assert found['mean_acceleration'] == pytest.approx((0.6 + 3.0 + 0.9) / 2.0)
    assert found['mean_negative_jerk'] == pytest.approx(-3.0)
    rising = values(made_run(np.zeros(301), vehicle_accel=T))
    assert rising['mean_negative_jerk'] == 0.0
    short = values(made_run(np.zeros(260), vehicle_accel=acceleration[:260]))
    assert short['mean_acceleration'] is None
    assert short['mean_negative_jerk'] is not None
    assert values(made_run(np.zeros(160)))['mean_negative_jerk'] is None


def test_friction_work_is_relative_to_the_loss_of_two_free_inertias():
    # A heavy car: C_f = C_m + J_m w_d/t takes the slip w_d linearly to zero within t.
    slip_rpm, time_s, demand = 400.0, 1.0, 300.0
    slip = slip_rpm * np.clip(1.6 - T, 0.0, 1.0)
    slip_rad_s = slip_rpm * RAD_S_PER_RPM
    torque = np.where(slip > 0.0, demand + PLANT.engine_inertia * slip_rad_s / time_s, 0.0)
    run = made_run(slip, joint_effort=shaft(torque, 1))
    heavy = replace(PLANT, rest_inertia=1e9)
    found = criteria(Engagement(run, CONTROL_START, WINDOW, plant=heavy))[
        'friction_work_over_least'
    ]
    assert found == pytest.approx(1.0 + demand * time_s / (PLANT.engine_inertia * slip_rad_s))
    limit = packaged_limits().of('thesis')['friction_work_over_least'].value
    assert limit == pytest.approx(found, rel=0.02)


def test_friction_work_before_control_start_does_not_count():
    slip, work = np.full(301, 400.0), np.where(T <= 0.6, 1e6, 2.0)
    found = values(made_run(slip, friction_work=work))['friction_work_over_least']
    least = PLANT.joint_inertia * (400.0 * RAD_S_PER_RPM) ** 2 / 2.0
    assert found == pytest.approx(480.0 / least)


def test_with_hardly_any_slip_at_control_start_there_is_no_minimum_of_the_work():
    for slip_rpm, exists in ((49.9, False), (50.1, True), (-50.1, True)):
        run = made_run(np.full(301, slip_rpm), friction_work=np.ones(301))
        judged = Engagement(run, CONTROL_START, WINDOW, plant=PLANT)
        value = criteria(judged)['friction_work_over_least']
        assert (value is not None) == exists == existing(judged)['friction_work_over_least']
        unknown = replace(judged, plant=None)
        assert criteria(unknown)['friction_work_over_least'] is None
        assert existing(unknown)['friction_work_over_least'] == exists


def test_criteria_of_the_stick_slip_clutch_do_not_exist_for_a_linear_clutch():
    for run, expected in ((made_run(np.zeros(301)), False), (sticking({}, phases((0, 1))), True)):
        found = existing(Engagement(run, CONTROL_START, WINDOW))
        only = ('time_to_lock', 'peak_temperature', 'releases_after_lock')
        assert all(found[name] == expected for name in only)
        assert found['peak_jerk']


def test_the_limit_of_judder_is_the_shuffle_that_alone_is_felt():
    # A_x = r_w/J_v (c_sa + k_sa/(j w)) w_sr with the wheel's load constant, weighted by W_d.
    car, vehicle, t = DrivelineParameters(), VehicleParameters(), times(40.0)
    angular = 2 * np.pi * 2.93
    stiffness = abs(car.halfshaft_damping + car.halfshaft_stiffness / (1j * angular))
    per_speed = stiffness * vehicle.wheel_radius_m / car.vehicle_inertia
    felt = weighted_acceleration(per_speed * np.sin(angular * t))[2000:]
    at_limit_rpm = 0.315 * np.sqrt(0.5) / np.sqrt(np.mean(felt**2)) / RAD_S_PER_RPM
    assert packaged_limits().of('thesis')['judder'].value == pytest.approx(at_limit_rpm, rel=0.1)


def test_the_daily_dose_is_that_of_all_engagements_in_the_sense_of_the_directive():
    acceleration = np.sin(2 * np.pi * T[:201])
    run = made_run(np.zeros(201), vehicle_accel=acceleration)
    one = compute_metrics(run, control_start_s=0.6, score_window_s=WINDOW_S)['vdv_m_s1_75']
    # Vibration 16 times as long has twice the dose; horizontal axes count 1.4 fold.
    assert values(run, engagements=16.0)['daily_vibration_dose'] == pytest.approx(2.8 * one)


def test_weighted_acceleration_of_a_sine_is_its_rms_times_the_weight():
    t = times(40.0)
    run = made_run(np.zeros(len(t)), vehicle_accel=2.0 * np.sin(2 * np.pi * t))
    metrics = compute_metrics(run, control_start_s=0.6, score_window_s=(20.0, 39.99))
    expected = 1.011 * 2.0 / np.sqrt(2.0)
    assert metrics['weighted_acceleration_m_s2'] == pytest.approx(expected, rel=0.01)


def test_a_jolt_after_the_score_window_counts_as_one_within_it():
    def jolt(at_s):
        run = made_run(np.zeros(301), vehicle_accel=5.0 * np.exp(-(((T - at_s) / 0.1) ** 2)))
        found = values(run)
        return found['weighted_acceleration'], found['daily_vibration_dose']

    within = compute_metrics(
        made_run(np.zeros(301), vehicle_accel=5.0 * np.exp(-(((T - 1.2) / 0.1) ** 2))),
        control_start_s=0.6,
        score_window_s=WINDOW_S,
    )
    assert jolt(1.2)[0] == pytest.approx(within['weighted_acceleration_m_s2'], rel=0.01)
    assert jolt(2.5) == pytest.approx(jolt(1.2), rel=0.05)
    assert jolt(0.2)[0] < 0.5 * jolt(1.2)[0]  # a jolt before control start does not count


@pytest.mark.parametrize('name', ['joint_speed', 'joint_effort', 'vehicle_accel', 'slip_speed'])
def test_a_value_that_is_not_finite_makes_no_number_up(name):
    run = made_run(np.full(301, 100.0))
    spoiled = run.signals[name].copy()
    spoiled[150] = np.nan
    found = values(made_run(np.full(301, 100.0), **{name: spoiled}))
    assert all(value is None or np.isfinite(value) for value in found.values())


@pytest.mark.parametrize('rows', [1, 2, 30, 61, 62])
def test_a_run_that_ends_early_has_the_criteria_that_are_defined(rows):
    assert set(values(made_run(np.full(rows, 100.0)))) == set(CRITERION_UNITS)


def test_a_criterion_is_within_beyond_or_without_limit_by_its_magnitude():
    text = """\
rules: RULES
limits:
- {criterion: slip_acceleration_at_lock, value: 40, unit: rad/s^2, applies_to: all,
   source: A, clause: '1'}
- {criterion: peak_jerk, value: 5, unit: m/s^3, applies_to: [launch], source: B, clause: '2'}
- {criterion: judder, value: 5, unit: rpm, applies_to: all, convention: true, reason: C}
"""
    rules = {
        name: {'value': 3.0, 'unit': unit, 'reason': 'x'}
        for name, unit in [
            ('engaged_slip', 'rpm'),
            ('locked_slip', 'rpm'),
            ('settled_time', 's'),
            ('oscillation_turns', '1'),
            ('runaway_slip', 'rpm'),
            ('runaway_growth', 'rpm/s'),
            ('runaway_swing', '1'),
            ('engagements_a_day', '1'),
        ]
    }
    limits = limits_of_text(text.replace('RULES', repr(rules)), 'x')
    known = dict.fromkeys(CRITERION_UNITS)

    def judged(scenario='thesis', state='engaged', without=(), **given):
        exists = {key: key not in without for key in known}
        verdict = verdict_of(state, {**known, **given}, limits, scenario, exists=exists)
        return verdict, {each.name: each for each in verdict.criteria}

    verdict, criteria = judged(slip_acceleration_at_lock=-41.0, peak_jerk=6.0)
    assert (verdict.state, verdict.limits) == ('engaged', 'beyond')
    assert asdict(criteria['slip_acceleration_at_lock']) == {
        'name': 'slip_acceleration_at_lock',
        'value': -41.0,
        'unit': 'rad/s^2',
        'limit': 40.0,
        'source': 'A, 1',
        'convention': False,
        'state': 'beyond',
        'least': None,
        'over_floor': None,
        'least_at_any_lock': None,
    }
    assert (criteria['judder'].source, criteria['judder'].convention) == ('convention: C', True)
    assert (criteria['peak_jerk'].limit, criteria['peak_jerk'].state) == (None, 'no_limit')
    assert judged('launch', peak_jerk=6.0)[0].limits == 'beyond'
    assert judged(slip_acceleration_at_lock=-40.0, judder=5.0)[0].limits == 'within'
    assert (
        judged(slip_acceleration_at_lock=-40.0)[0].limits == 'no_limit'
    )  # the judder has no value
    assert judged(peak_jerk=6.0)[0].limits == 'no_limit'
    # An undefined criterion of a plant does not count; without a limit there is no result.
    without = judged(slip_acceleration_at_lock=-40.0, without=['judder'])
    assert without[0].limits == 'within'
    assert (without[1]['judder'].limit, without[1]['judder'].state) == (None, 'no_limit')
    none = judged(without=['judder', 'slip_acceleration_at_lock'])
    assert none[0].limits == 'no_limit'
    for state in STATES:
        success = state in ('engaged', 'nearly_engaged')
        found = judged(state=state, slip_acceleration_at_lock=-40.0, judder=4.0)
        assert found[0].limits == ('within' if success else 'failed')
        beyond = judged(state=state, slip_acceleration_at_lock=-41.0)
        assert beyond[0].limits == ('beyond' if success else 'failed')
    undefined = judged()[1]['judder']
    assert (undefined.value, undefined.limit, undefined.state) == (None, 5.0, 'no_limit')


def test_the_packaged_file_limits_the_dose_by_the_action_value():
    limit = packaged_limits().of('thesis')['daily_vibration_dose']
    assert (limit.value, limit.unit) == (9.1, 'm/s^1.75')
