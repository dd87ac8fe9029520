# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The state of a run says whether it engaged, and if not what went wrong."""

import numpy as np
import pytest
from made_run import CONTROL_START, made_run, times

from ddct_bringup.metrics.engagement import Engagement
from ddct_bringup.metrics.zero_slip import LOCKED, SLIPPING
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verdict.state import EngineCommand, state_of
from ddct_plant.models.driveline import PhaseEvent
from ddct_plant.models.engine_limits import OVER_REVVED, STALLED

T = times()
RULES = packaged_limits().rules


def judged(run, engine_end=None):
    return state_of(Engagement(run, CONTROL_START, (60, 200)), engine_end, RULES)


def state(slip_rpm, **signals):
    return judged(made_run(slip_rpm, **signals)).name


def falling(rate_rpm_s, peak_rpm=600.0, lowest_rpm=0.0):
    """Return a slip that rises until control start at 0.6 s, then falls as a ramp."""
    rise = peak_rpm * np.minimum(T / 0.6, 1.0)
    return np.maximum(rise - rate_rpm_s * np.maximum(T - 0.6, 0.0), lowest_rpm)


def sticking(*changes, **signals):
    """
    Return a run with plates that stick, from their changes of phase as (time in s, kind).

    They slip by 100 rpm until the first change, and whenever they are not locked.
    """
    phase = np.full(len(T), float(SLIPPING))
    events: list[tuple[PhaseEvent, ...]] = [()] * len(T)
    for time_s, kind in changes:
        step = int(np.ceil(100.0 * time_s - 1e-9))
        phase[step:] = LOCKED if kind == 'lock' else SLIPPING
        events[step] = (*events[step], PhaseEvent(time_s, kind, 0.0))
    slip = np.where(phase == LOCKED, 0.0, 100.0)
    return made_run(slip, clutch_phase=phase, phase_events=tuple(events), **signals)


@pytest.mark.parametrize('sign', [1.0, -1.0])
def test_a_slip_of_a_linear_clutch_that_ends_within_the_band_is_engaged(sign):
    assert state(sign * falling(700.0, lowest_rpm=-12.0)) == 'engaged'
    assert state(sign * falling(700.0, lowest_rpm=49.0)) == 'engaged'
    assert state(sign * falling(700.0, lowest_rpm=51.0)) == 'not_engaged'


@pytest.mark.parametrize('last_rpm', [12.0, -12.0])
def test_the_slip_of_a_linear_clutch_has_to_be_within_the_band_for_the_settled_time(last_rpm):
    periods = round(100 * RULES.settled_time)
    slip = np.concatenate([np.linspace(600.0, 70.0, 100), np.full(periods + 1, last_rpm)])
    assert state(slip) == 'engaged'
    found = judged(made_run(slip[:-1]))
    assert found.name == 'not_engaged'
    assert f'{last_rpm:.1f} rpm at the end, is not within 50 rpm over the last 0.3 s' in found.why


def test_a_slip_that_passes_through_the_band_once_in_a_swing_is_not_engaged():
    assert state(600.0 * np.cos(2.0 * np.pi * T)) == 'not_engaged'


def test_plates_that_are_locked_for_half_a_second_at_the_end_are_engaged():
    assert judged(sticking((2.5, 'lock'))) == ('engaged', '')
    found = judged(sticking((2.5001, 'lock')))
    assert found.name == 'late'
    assert found.why == 'the plates are locked for the last 0.50 s, less than 0.5 s'


def test_only_the_final_lock_counts():
    again = sticking((1.0, 'lock'), (2.6, 'release'), (2.7, 'lock'))
    assert judged(again).name == 'late'
    assert judged(sticking((1.0, 'lock'), (1.2, 'release'), (1.4, 'lock'))).name == 'engaged'


def test_plates_that_never_part_are_engaged():
    assert judged(sticking((0.2, 'lock'))).name == 'engaged'
    assert state(np.zeros(301)) == 'engaged'


def test_plates_that_slip_at_the_end_are_not_engaged_however_little():
    found = judged(sticking((1.0, 'lock'), (2.9, 'release')))
    assert found == (
        'not_engaged',
        'the plates are not locked at the end: slip 100.0 rpm after 1 release',
    )
    creeping = sticking()
    creeping.slip_speed[:] = 0.1
    assert judged(creeping).why == 'the plates are not locked at the end: slip 1.0 rpm'


@pytest.mark.parametrize('end', [STALLED, OVER_REVVED])
def test_an_engine_that_ends_the_run_gives_its_state_whatever_the_plates_do(end):
    assert judged(sticking((1.0, 'lock')), end).name == end


def commanded(request, torque=None, demand=200.0, **signals):
    """Return an engaged run in which the controller requests an engine torque in N m."""
    demand, request = (np.broadcast_to(each, T.shape) + 0.0 for each in (demand, request))
    torque = np.minimum(request, 250.0) if torque is None else np.broadcast_to(torque, T.shape)
    return sticking(
        (1.0, 'lock'),
        torque_demand=demand,
        engine_torque=torque,
        engine_torque_request=request,
        **signals,
    )


def for_time(value, seconds, otherwise=200.0):
    """Return a signal that has a value for a time after control start."""
    return np.where((T >= 0.6 - 1e-9) & (0.6 + seconds - 1e-9 > T), value, otherwise)


@pytest.mark.parametrize(('seconds', 'expected'), [(0.6, 'engaged'), (0.61, 'withheld')])
def test_a_controller_may_withhold_the_demand_for_six_tenths_of_a_second(seconds, expected):
    found = judged(commanded(for_time(0.0, seconds)))
    assert found.name == expected
    if expected == 'withheld':
        assert 'takes 0.61 s of the largest demand away, more than 0.6 s' in found.why


def test_withheld_torque_counts_as_a_share_of_the_largest_demand():
    assert judged(commanded(for_time(100.0, 1.2))).name == 'engaged'
    assert judged(commanded(for_time(100.0, 1.22))).name == 'withheld'
    low = np.where(T < 1.5, 100.0, 200.0)
    assert judged(commanded(for_time(0.0, 0.9, low), demand=low)).name == 'engaged'


def test_the_demand_has_to_be_requested_at_the_end():
    tail = np.where(T >= 2.7 - 1e-9, 1.0, 0.0)
    assert judged(commanded(200.0 - 39.0 * tail)).name == 'engaged'
    found = judged(commanded(200.0 - 41.0 * tail))
    assert found.name == 'withheld'
    assert 'requests 80 % of the demand over the last 0.3 s, less than 80 %' in found.why
    assert judged(commanded(0.0 * T, demand=np.where(T < 0.65, 200.0, 0.0))).name == 'engaged'


@pytest.mark.parametrize(('seconds', 'expected'), [(0.6, 'engaged'), (0.61, 'added')])
def test_a_controller_may_add_the_largest_demand_for_six_tenths_of_a_second(seconds, expected):
    doubled = for_time(400.0, seconds)
    assert judged(commanded(doubled, torque=doubled)).name == expected


def test_only_torque_that_is_requested_and_given_is_added():
    doubled = for_time(400.0, 2.0)
    assert judged(commanded(doubled, torque=200.0)).name == 'engaged'
    assert judged(commanded(200.0, torque=doubled)).name == 'engaged'


def test_a_controller_of_the_clutch_alone_withholds_and_adds_nothing():
    run = sticking(
        (1.0, 'lock'), torque_demand=np.full(301, 200.0), engine_torque=for_time(0.0, 2.0)
    )
    assert judged(run).name == 'engaged'
    assert EngineCommand.of(Engagement(run, CONTROL_START, (60, 200)), RULES) is None


def test_without_a_positive_demand_nothing_can_be_withheld():
    for demand in (0.0, -20.0):
        assert judged(commanded(-100.0, demand=demand)).name == 'engaged'


def test_what_a_torque_cut_of_the_handover_takes_is_not_withheld_by_the_controller():
    less = for_time(0.0, 2.0)
    cut = commanded(less, torque=less, torque_cut=for_time(200.0, 2.0, 0.0))
    assert judged(cut).name == 'engaged'
    assert judged(commanded(less, torque=less)).name == 'withheld'


def test_a_request_that_the_engine_cannot_follow_withholds_what_the_engine_lacks():
    assert judged(commanded(for_time(-400.0, 0.55), torque=for_time(0.0, 0.55))).name == 'engaged'
    idle = commanded(for_time(-400.0, 2.0), torque=np.full(301, 200.0))
    assert judged(idle).name == 'engaged'


def test_a_run_that_did_not_engage_is_not_judged_by_its_engine_torque():
    run = commanded(0.0 * T)
    slipping = sticking(
        **{
            name: run.signals[name]
            for name in ('torque_demand', 'engine_torque', 'engine_torque_request')
        }
    )
    assert judged(slipping).name == 'not_engaged'
    assert judged(run).name == 'withheld'
