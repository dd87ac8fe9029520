# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""States of a gear shift: tied up, flared, or as its on-coming clutch ends."""

from dataclasses import replace
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from made_run import made_facts
from made_shift import (
    LOCKED,
    RATIOS,
    SLIPPING,
    START,
    STEP,
    STEPS,
    WINDOW,
    events,
    joints,
    made_shift,
)

from ddct_bringup.bag.reader import Recording
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.scores.scoring import score_run
from ddct_bringup.verdict.limits import Limits, packaged_limits
from ddct_plant.base.timebase import PERIOD_S

FACTS = made_facts(
    clutch='stick_slip',
    scenario='upshift',
    control_start_s=0.01 * START,
    score_window_s=tuple(0.01 * step for step in WINDOW),
    duration_s=0.01 * STEPS,
)


def scored(limits: Limits | None = None, **signals: Any) -> ScoredRun:
    """Return the scores of a shift made by hand."""
    recording = Recording(Path('shift.mcap'), made_shift(**signals), FACTS)
    return score_run(recording, 'shift', limits or packaged_limits(), None)


def opposing(torque: float) -> dict[str, Any]:
    """Return the signals of clutches that work against each other from 0.41 to 0.6 s."""
    opposing = (STEP > 40) & (STEP < 60)
    on_coming, off_going = (np.where(opposing, each, 0.0) for each in (200.0, -torque))
    return {
        'joint_effort': joints(second=on_coming, fourth=1000.0),
        'off_going_transmitted_torque': off_going,
        'tie_up_work': np.where(opposing, torque * 70.0 * PERIOD_S, 0.0),
    }


def risen(rise: float) -> dict[str, Any]:
    """Return the signals of an engine that has run up by a speed in rad/s at 0.45 s."""
    run = made_shift()
    engine = run.engine_speed + np.where(STEP == 45, rise, 0.0)
    return {
        'joint_speed': joints(engine, 10.0 * RATIOS[1], 10.0),
        'off_going_clutch_phase': np.where(STEP < 40, LOCKED, SLIPPING),
    }


def test_a_shift_whose_on_coming_clutch_is_locked_at_the_end_is_engaged():
    run = scored()
    assert (run.state, run.why, run.is_shift) == ('engaged', '', True)


@pytest.mark.parametrize(('rise', 'state'), [(10.4, 'engaged'), (10.6, 'flared')])
def test_an_engine_that_runs_up_by_more_than_100_rpm_has_flared(rise, state):
    run = scored(**risen(rise))
    assert run.state == state
    assert ('between the gears' in run.why) == (state == 'flared')


@pytest.mark.parametrize(('torque', 'state'), [(7.5, 'engaged'), (8.5, 'tied_up')])
def test_clutches_that_do_more_than_110_j_against_each_other_have_tied_up(torque, state):
    run = scored(**opposing(torque))
    assert run.metrics['tie_up_work_j'] == pytest.approx(torque * 70.0 * 0.19)
    assert run.state == state


def test_a_tie_up_is_the_state_also_where_the_on_coming_clutch_still_slips():
    slipping = {
        'slip_speed': np.full(STEPS + 1, 70.0),
        'clutch_phase': np.full(STEPS + 1, SLIPPING),
        'phase_events': events(),
    }
    assert scored(**slipping).state == 'not_engaged'
    assert scored(**slipping, **risen(50.0)).state == 'not_engaged'
    assert scored(**slipping, **opposing(50.0)).state == 'tied_up'


def test_a_handover_that_never_ends_is_judged_from_the_start_of_the_shift():
    half = {'handover_share': np.clip((STEP - START) / 500.0, 0.0, 1.0)}
    still = {'phase_events': events(), 'clutch_phase': np.full(STEPS + 1, SLIPPING)}
    slip = np.full(STEPS + 1, 70.0)
    assert scored(**half, **still, slip_speed=slip).state == 'not_engaged'
    assert scored(**half).state == 'engaged'


def test_an_invalid_shift_stays_invalid():
    broken = made_shift().slip_speed.copy()
    broken[20] = np.nan
    assert scored(**opposing(50.0), slip_speed=broken).state == 'invalid'


def test_limits_of_ones_own_may_set_both_thresholds():
    packaged = packaged_limits()
    loud = replace(packaged, rules=replace(packaged.rules, flare_rad_s=60.0, tie_up_work_j=5.0))
    assert scored(loud, **risen(40.0)).state == 'engaged'
    assert scored(loud, **opposing(1.0)).state == 'tied_up'


def test_the_packaged_thresholds_say_that_they_are_conventions():
    assert (packaged_limits().rules.flare_rad_s, packaged_limits().rules.tie_up_work_j) == (
        10.5,
        110.0,
    )
    text = (files('ddct_bringup.verdict') / 'limits.yaml').read_text(encoding='utf-8')
    assert 'All thresholds are conventions' in text
