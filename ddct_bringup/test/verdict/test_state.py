# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The state of a run is the one that a control engineer would give it."""

import numpy as np
import pytest
from made_run import CONTROL_START, RAD_S_PER_RPM, made_run, times

from ddct_bringup.metrics.plant import JudgedPlant
from ddct_bringup.metrics.zero_slip import LOCKED, SLIPPING
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verdict.state import slip_state
from ddct_bringup.verdict.swings import turns_of
from ddct_plant.models.parameters import DrivelineParameters, VehicleParameters

T = times()
CAR = DrivelineParameters(), VehicleParameters()


def state(slip_rpm, **signals):
    return slip_state(made_run(slip_rpm, **signals), CONTROL_START, packaged_limits().rules)


def falling(rate_rpm_s, peak_rpm=600.0, lowest_rpm=0.0):
    """Return a slip that rises until control start at 0.6 s, then falls as a ramp."""
    rise = peak_rpm * np.minimum(T / 0.6, 1.0)
    return np.maximum(rise - rate_rpm_s * np.maximum(T - 0.6, 0.0), lowest_rpm)


@pytest.mark.parametrize('sign', [1.0, -1.0])
def test_a_slip_that_crosses_zero_once_and_stays_small_is_engaged(sign):
    assert state(sign * falling(700.0, lowest_rpm=-12.0)) == 'engaged'


def test_a_slip_that_stays_at_zero_once_there_is_engaged():
    assert state(falling(700.0)) == 'engaged'


def test_a_slip_that_overshoots_and_comes_back_is_engaged():
    slip = falling(1000.0) - 200.0 * np.exp(-(((T - 1.5) / 0.15) ** 2))
    assert state(slip) == 'engaged'


def test_plates_that_never_part_are_engaged():
    assert state(np.zeros(301)) == 'engaged'


def sticking(slip_rpm, **signals):
    """Return the state of a run with a stick-slip clutch, locked wherever the slip is zero."""
    phase = np.where(slip_rpm == 0.0, float(LOCKED), float(SLIPPING))
    return state(slip_rpm, clutch_phase=phase, **signals)


@pytest.mark.parametrize('end_s', [2.0, 2.02, 3.0])
def test_plates_that_lock_are_engaged_at_once(end_s):
    slip = falling(429.0)[: round(100 * end_s) + 1]
    assert slip[-1] == 0.0
    assert sticking(slip) == 'engaged'
    assert state(slip) == ('engaged' if end_s > 2.02 else 'not_engaged')


def test_a_small_slip_that_stays_is_engaged_only_where_plates_cannot_lock():
    assert state(falling(700.0, lowest_rpm=35.0)) == 'engaged'
    assert sticking(falling(700.0, lowest_rpm=35.0)) == 'not_engaged'
    assert sticking(falling(700.0, lowest_rpm=5.0)) == 'nearly_engaged'


@pytest.mark.parametrize('end_s', [1.6, 1.9, 3.0])
def test_plates_that_hardly_slip_are_nearly_engaged_and_engaged_once_they_lock(end_s):
    slip = falling(700.0, lowest_rpm=5.0)[: round(100 * end_s) + 1]
    assert sticking(slip) == ('nearly_engaged' if end_s > 1.8 else 'not_engaged')
    slip[-1] = 0.0
    assert sticking(slip) == 'engaged'


def test_plates_that_part_again_at_the_end_by_little_are_nearly_engaged():
    slip = falling(700.0)
    slip[-3:] = 2.0
    assert sticking(slip) == 'nearly_engaged'
    slip[-3:] = 11.0
    assert sticking(slip) == 'not_engaged'


def test_plates_that_lock_for_less_than_they_slip_in_a_cycle_oscillate():
    beat = np.where(np.arange(301) % 40 < 28, 200.0, 0.0)
    assert sticking(beat[:280]) == sticking(beat[:279]) == 'oscillating'


def test_a_slip_of_the_linear_clutch_that_comes_back_from_beyond_zero_is_engaged():
    # It crosses zero after 1.2 s and returns with a time constant of 1 s.
    beyond = np.maximum(T - 1.2, 0.0)
    slip = falling(1000.0) - 300.0 * (np.exp(-beyond) - np.exp(-beyond / 0.2))
    assert -100.0 < slip[-1] < -40.0
    assert state(slip) == state(slip[:281]) == 'engaged'
    assert state(slip[:151]) == 'not_engaged'  # its magnitude still grows
    assert sticking(slip) == 'not_engaged'


def test_a_slip_that_goes_further_beyond_zero_than_it_was_has_not_engaged():
    beyond = np.maximum(T - 1.2, 0.0)
    slip = falling(1000.0) - 1500.0 * (np.exp(-beyond) - np.exp(-beyond / 0.2))
    assert slip.min() < -600.0
    assert state(slip) == 'not_engaged'


def test_one_swing_beyond_zero_before_a_slip_that_stays_is_no_oscillation():
    approach = np.interp(T, [0.6, 0.65, 0.85, 1.9, 2.0, 2.2], [800, 700, 1100, -47, 75, 75])
    assert state(approach) == 'not_engaged'


@pytest.mark.parametrize('end', range(250, 301, 5))
def test_an_oscillation_whose_mean_grows_is_a_runaway(end):
    swing = 200.0 * np.sin(2 * np.pi * (T - 0.6) / 0.25)
    assert state((600.0 + 200.0 * T + swing)[: end + 1]) == 'runaway'
    assert state((600.0 + 30.0 * T + swing)[: end + 1]) == 'oscillating'


def test_an_oscillation_with_a_nonzero_reference_is_no_runaway():
    reference = np.full((len(T), 1), 300.0 * RAD_S_PER_RPM)
    swing = 200.0 * np.sin(2 * np.pi * (T - 0.6) / 0.25)
    assert state(600.0 + 200.0 * T + swing, slip_reference=reference) == 'oscillating'


def limited(slip_rpm, engine_rpm, cut_rpm=6500.0):
    """Return the state of a run with an engine whose limiter cuts the fuel at `cut_rpm`."""
    speeds = np.zeros((len(slip_rpm), 4))
    speeds[:, 0] = engine_rpm * RAD_S_PER_RPM
    run = made_run(slip_rpm, joint_speed=speeds)
    plant = JudgedPlant.of_parameters(*CAR, cut_rpm * RAD_S_PER_RPM)
    return slip_state(run, CONTROL_START, packaged_limits().rules, plant)


@pytest.mark.parametrize('ripple_rpm', [20.0, 120.0])
def test_a_slip_that_only_the_rev_limiter_limits_is_a_runaway(ripple_rpm):
    ripple = ripple_rpm * np.sin(2 * np.pi * (T - 0.6) / 0.2)
    engine = np.minimum(1000.0 + 6000.0 * np.maximum(T - 0.6, 0.0), 6400.0) + ripple
    slip = engine - np.minimum(1000.0 * T / 0.6, 1000.0)
    assert limited(slip, engine, cut_rpm=6410.0) == 'runaway'
    # Without a limiter it stays, or oscillates, by itself.
    found = 'oscillating' if ripple_rpm > 100.0 else 'not_engaged'
    assert limited(slip, engine, cut_rpm=np.inf) == found


def test_a_slip_that_has_not_grown_is_no_runaway_though_the_engine_is_at_its_limiter():
    engine = np.full(len(T), 6450.0)
    assert limited(falling(700.0, lowest_rpm=200.0), engine, cut_rpm=6410.0) == 'not_engaged'
    assert limited(falling(700.0), engine, cut_rpm=6410.0) == 'engaged'


def test_plates_with_zero_slip_in_every_swing_are_not_driven_apart():
    swing = 1500.0 * np.sin(2 * np.pi * (T - 0.6) / 0.25)
    assert state(300.0 * T + swing) == 'oscillating'


@pytest.mark.parametrize('end', range(240, 301, 5))
def test_a_cycle_with_a_bump_in_it_oscillates_wherever_the_run_ends(end):
    t = T - 0.6
    bumpy = 1500.0 * np.sin(2 * np.pi * t / 0.8) + 500.0 * np.sin(2 * np.pi * t / 0.1)
    assert state(bumpy[: end + 1]) == 'oscillating'


def test_a_slow_slip_that_has_not_arrived_is_not_engaged():
    assert state(falling(150.0)) == 'not_engaged'


def test_a_slip_that_only_passes_through_zero_at_the_end_is_not_engaged():
    assert state(falling(260.0, lowest_rpm=-1e4)) == 'not_engaged'


def test_a_slip_that_stays_away_from_zero_is_not_engaged():
    assert state(falling(700.0, lowest_rpm=120.0)) == 'not_engaged'


def test_a_slip_beyond_zero_that_stays_there_is_not_engaged():
    assert state(falling(700.0, lowest_rpm=-120.0)) == 'not_engaged'


def test_a_run_that_ends_while_its_reference_still_falls_is_not_engaged():
    early = T <= 1.0
    reference = np.full((early.sum(), 1), 300.0 * RAD_S_PER_RPM)
    rising = (300.0 + 400.0 * T)[early]
    assert state(rising, slip_reference=reference) == 'not_engaged'
    assert state(rising) == 'runaway'


def test_a_run_that_ends_before_control_start_is_not_engaged():
    assert state(np.zeros(40)) == 'not_engaged'


@pytest.mark.parametrize('offset', [0.0, 400.0])
@pytest.mark.parametrize('period_s', [0.2, 0.7, 1.1])
def test_a_limit_cycle_of_270_rpm_is_oscillating_wherever_the_run_ends(offset, period_s):
    for end in range(250, 301, 5):
        t = T[: end + 1]
        cycle = offset + 270.0 * np.sin(2 * np.pi * (t - 0.6) / period_s)
        assert state(cycle) == 'oscillating', end


def test_a_slow_limit_cycle_is_not_engaged_while_it_passes_through_zero():
    for end in range(800, 1201, 20):
        t = np.arange(end + 1) / 100.0
        assert state(100.0 * np.sin(2 * np.pi * (t - 0.6) / 4.0)) == 'oscillating', end


def test_plates_that_stick_and_break_loose_again_and_again_oscillate():
    cycle = 200.0 * np.maximum(np.sin(2 * np.pi * (T - 0.6) / 0.5), 0.0)
    assert state(cycle) == 'oscillating'


def test_an_oscillation_that_has_died_down_is_engaged():
    assert state(600.0 * np.exp(-4.0 * np.maximum(T - 0.6, 0)) * np.cos(20 * T)) == 'engaged'


def test_a_ripple_within_the_band_is_engaged():
    assert state(falling(700.0) + 40.0 * np.sin(2 * np.pi * 5.0 * T)) == 'engaged'


def test_a_ripple_on_a_slow_slip_is_no_oscillation():
    assert state(falling(150.0) + 40.0 * np.sin(2 * np.pi * 5.0 * T)) == 'not_engaged'


@pytest.mark.parametrize('sign', [1.0, -1.0])
def test_a_slip_that_grows_until_26_000_rpm_is_a_runaway(sign):
    assert state(sign * 26e3 * (T / 3.0) ** 2) == 'runaway'


def test_a_slip_that_once_was_beyond_any_engine_is_a_runaway():
    assert state(falling(2e4, peak_rpm=9e3)) == 'runaway'


def test_a_slip_that_grows_at_the_end_is_a_runaway():
    assert state(300.0 + 120.0 * T) == 'runaway'
    assert state(300.0 + 60.0 * T) == 'not_engaged'


def test_a_slip_that_crosses_zero_and_runs_away_beyond_is_a_runaway():
    assert state(falling(700.0, lowest_rpm=-1e4)) == 'runaway'


@pytest.mark.parametrize('sign', [1.0, -1.0])
def test_an_overshoot_on_its_way_is_not_a_runaway(sign):
    beyond = np.maximum(T - 2.2, 0.0)
    slip = falling(375.0) - 600.0 * (1.0 - np.exp(-beyond / 0.4))
    assert slip[-1] < -400.0
    assert state(sign * slip) == 'not_engaged'


def test_a_slip_that_has_just_crossed_zero_is_not_a_runaway():
    assert state(falling(300.0, lowest_rpm=-1e4)) == 'not_engaged'


def test_an_oscillation_that_died_down_away_from_zero_is_not_engaged():
    dying = 400.0 * np.exp(-3.0 * np.maximum(T - 0.6, 0.0)) * np.cos(25.0 * T)
    assert state(dying + 80.0) == 'not_engaged'


def test_plates_that_stick_long_and_break_loose_shortly_oscillate_at_whatever_end():
    for end in range(200, 301, 10):
        beat = np.where(np.arange(end + 1) % 40 < 8, 200.0, 0.0)
        assert state(beat) == 'oscillating', end


def test_an_oscillation_that_grows_beyond_all_before_is_a_runaway():
    t = times(2.95)
    grows = 20.0 * np.exp(2.0 * t) * np.sin(2 * np.pi * (t - 0.6))
    assert state(grows[:283]) == 'runaway'


STEPS = np.interp(T, [0.0, 1.8, 1.9, 2.4, 2.5, 3.0], [200, 200, 80, 80, 200, 200])
"""Driver's demand in N m that falls and rises again."""
ANSWERS = np.interp(
    T, [0.0, 0.7, 1.2, 1.8, 1.9, 2.2, 2.4, 2.5, 2.65], [0, 600, 0, 0, 150, 0, 0, 150, 0]
)
"""Slip in rpm that grows after each change of `STEPS`, and returns to zero."""


def driven(slip, **signals):
    """Return the state of a run with the driveline of the thesis."""
    plant = JudgedPlant.of_parameters(*CAR)
    return slip_state(made_run(slip, **signals), CONTROL_START, packaged_limits().rules, plant)


@pytest.mark.parametrize('sign', [1.0, -1.0])
def test_swings_that_changes_of_the_demand_cause_are_no_oscillation(sign):
    assert driven(sign * ANSWERS, torque_demand=STEPS) == 'engaged'
    # The same swings under a constant demand are an oscillation, and also without a known demand.
    assert driven(sign * ANSWERS, torque_demand=np.full(len(T), 200.0)) == 'oscillating'
    assert driven(sign * ANSWERS, torque_demand=np.full(len(T), np.nan)) == 'oscillating'
    assert driven(sign * ANSWERS) == state(sign * ANSWERS, torque_demand=STEPS) == 'oscillating'


def test_swings_that_a_changing_slope_causes_are_no_oscillation():
    # 10 % of slope is 470 N m at the wheels of a car of 1500 kg.
    slip = np.interp(T, [0.0, 0.7, 1.2, 1.5, 2.0, 2.2], [0, 600, 0, 0, 110, 0])[:261]
    demand, load = np.full(261, 200.0), np.interp(T, [1.4, 1.6], [60.0, 530.0])[:261]
    assert driven(slip, torque_demand=demand, load_torque=load) == 'engaged'
    assert driven(slip, torque_demand=demand, load_torque=np.full(261, 60.0)) == 'oscillating'


def test_a_change_of_the_demand_that_explains_less_than_half_of_a_swing_forces_none():
    # Within 0.1 s, 10 N m more turn an engine of 0.25 kg m2 by 38 rpm.
    step = np.where(T < 1.81, 200.0, 210.0)[:251]
    slip = np.interp(T, [0.0, 0.7, 1.2, 1.8, 1.9, 2.1], [0, 600, 0, 0, 110, 0])[:251]
    assert driven(slip, torque_demand=step) == 'oscillating'
    assert driven(slip, torque_demand=200.0 + 2.0 * (step - 200.0)) == 'engaged'


def test_a_cycle_that_goes_on_after_a_change_of_the_demand_oscillates():
    swing = 270.0 * np.sin(2 * np.pi * (T - 0.6) / 0.25)
    for at in (1.0, 1.4, 1.8, 2.2, 2.6, 2.8, 2.9):
        assert driven(swing, torque_demand=np.where(at > T, 100.0, 250.0)) == 'oscillating', at


@pytest.mark.parametrize('longer', range(8))
def test_plates_that_stay_locked_a_little_longer_before_the_next_swing_oscillate(longer):
    # Each swing takes 12 samples; the plates stay locked for 16 before it, at last for more.
    swing, lock = 1400.0 * np.sin(np.pi * np.arange(1, 12) / 12.0), np.zeros(17)
    cycle = np.concatenate([np.zeros(60), *[swing, lock] * 6, swing, lock, np.zeros(longer)])
    for part in range(2, 12):
        assert sticking(np.concatenate([cycle, swing[:part]])) == 'oscillating', part


@pytest.mark.parametrize(('samples', 'expected'), [(30, 'not_engaged'), (31, 'engaged')])
def test_the_time_within_the_band_runs_from_the_first_sample_in_it_to_the_last(samples, expected):
    # 31 samples span 0.3 s.
    slip = np.concatenate([np.full(200, 60.0), np.full(samples, 40.0)])
    assert state(slip) == expected


def test_turns_are_extremes_from_which_the_values_move_back():
    assert turns_of(np.array([0.0, 5.0, 1.0, 4.0, -3.0, 9.0]), 3.5) == [1, 4]
    assert turns_of(np.array([5.0, 4.0, 0.0]), 3.0) == []
    assert turns_of(np.array([0.0, 3.0, 1.0, 3.0]), 2.0) == [1, 2]
