# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Real time: 100 Hz on the wall clock, the trajectory of lock-step where no step was missed."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.in_process_graph import GraphOf
from support.patient_clock import PatientClock, realtime_owner
from support.runs import expected, plan, record

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.bag.recording import Recording
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.scores.scored_recording import score_recording
from ddct_bringup.scores.validity import MISS_TOLERANCE
from ddct_bringup.verdict.limits import packaged_limits

NEAR = 0.1
"""Largest difference of the slip speed from lock-step with a few missed steps, of its peak."""


def _timing(folder: Path) -> dict[str, Any]:
    return json.loads((folder / 'timing.json').read_text())


def _best_of_three(run: RunPlan, folder: Path) -> tuple[Recording, dict[str, Any]]:
    """Repeat a run while it misses steps: a busy machine may be too slow for real time."""
    runs = []
    for number in range(3):
        recording = record(run, folder / str(number))
        runs.append((recording, _timing(folder / str(number))))
        if runs[-1][1]['missed_steps'] == 0:
            break
    return min(runs, key=lambda each: each[1]['missed_steps'])


@pytest.mark.parametrize('controller', ['ls8', 'mpc4'])
def test_real_time_without_a_miss_is_lock_step_to_the_last_bit(
    graph_of: GraphOf, controller: str
) -> None:
    run = plan(controller, mode='realtime', duration_s=1.5)
    graph = graph_of(run)
    graph.add_all()
    PatientClock(realtime_owner(graph))
    graph.run(60)
    recording = read_bag(graph.folder)
    assert recording.missed == {}
    assert recording.realtime.missed_steps == 0
    assert recording.trajectory.sha256() == expected(run).sha256()
    scores = score_recording(recording, 'bag', packaged_limits()).scores
    assert (scores.valid, scores.safe_state) == (True, '')


@pytest.mark.parametrize('layout', ['processes', 'single-process'])
def test_a_real_time_run_that_counts_stays_near_lock_step(tmp_path: Path, layout: str) -> None:
    run = plan(layout=layout, mode='realtime', duration_s=1.5)
    recording, timing = _best_of_three(run, tmp_path)
    if timing['missed_steps'] > MISS_TOLERANCE * run.steps:
        pytest.skip(f'too busy for real time: {timing["missed_steps"]} of {run.steps} missed')
    lockstep, realtime = expected(run), recording.trajectory
    peak = np.abs(lockstep.slip_speed).max()
    assert realtime.slip_speed == pytest.approx(lockstep.slip_speed, abs=NEAR * peak)
    assert timing['steps'] == run.steps
    assert len(timing['update_times_us']) >= 0.9 * run.steps


def test_real_time_is_no_faster_than_the_wall_clock(tmp_path: Path) -> None:
    run = plan(layout='single-process', mode='realtime')
    recording = record(run, tmp_path / 'bag')
    assert recording.trajectory.steps == run.steps
    assert recording.facts.mode == 'realtime'
    timing = _timing(tmp_path / 'bag')
    assert 0.95 <= timing['wall_time_s'] / run.settings.scenario.duration_s <= 2.0


def test_wall_clock_figures_are_recorded_in_real_time_only(tmp_path: Path) -> None:
    topics = {'/controller/timing', '/diagnostics'}
    for mode, recorded in (('realtime', topics), ('lockstep', set())):
        run = plan(layout='single-process', mode=mode, duration_s=0.5)
        counts = record(run, tmp_path / mode).counts
        assert topics & {topic for topic, count in counts.items() if count} == recorded
