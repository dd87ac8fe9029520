# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Real time by the wall clock: it is no faster, and a run that counts stays near lock-step."""

import json
from pathlib import Path

import numpy as np
import pytest
from support.runs import expected, plan, record

from ddct_bringup.scores.scored_recording import score_recording
from ddct_bringup.scores.validity import MISS_TOLERANCE
from ddct_bringup.verdict.limits import packaged_limits

NEAR = 0.1
"""Largest difference of the slip speed from lock-step with a few missed steps, of its peak."""


@pytest.mark.parametrize('layout', ['processes', 'single-process'])
def test_a_real_time_run_is_no_faster_than_the_wall_clock_and_near_lock_step_where_it_counts(
    tmp_path: Path, layout: str
) -> None:
    run = plan(layout=layout, mode='realtime', duration_s=1.5)
    recording = record(run, tmp_path / 'bag')
    assert recording.trajectory.steps == run.steps
    assert recording.facts.mode == 'realtime'
    timing = json.loads((tmp_path / 'bag' / 'timing.json').read_text())
    assert timing['steps'] == run.steps
    assert timing['wall_time_s'] >= 0.95 * run.settings.scenario.duration_s
    scores = score_recording(recording, 'bag', packaged_limits()).scores
    few_missed = timing['missed_steps'] <= MISS_TOLERANCE * run.steps
    assert scores.valid == (few_missed and not scores.safe_state)
    if scores.valid:
        lockstep, realtime = expected(run), recording.trajectory
        peak = np.abs(lockstep.slip_speed).max()
        assert realtime.slip_speed == pytest.approx(lockstep.slip_speed, abs=NEAR * peak)
