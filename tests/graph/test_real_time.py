# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Real time: 100 Hz on the wall clock, the trajectory of lock-step where no step was missed."""

import json
import random
from collections.abc import Collection
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.in_process_graph import GraphOf
from support.patient_clock import PatientClock, realtime_owner
from support.runs import expected, plan, record

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.bag.recording import Recording
from ddct_bringup.run.execution import recording_in_memory
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.scores.scored_recording import score_recording
from ddct_bringup.scores.validity import MISS_TOLERANCE
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.base.timebase import step_of_stamp
from ddct_plant.signals.topics import CLUTCH_TORQUE
from ddct_plant.ticks.realtime_owner import RealtimeOwner

pytestmark = pytest.mark.slow

NEAR = 0.1
"""Largest difference of the slip speed from lock-step with a few missed steps, of its peak."""
SLIP_PHASE = range(60, 170)
"""Steps from control start to the end of the score window of `thesis`."""
PEAKS = ('peak_jerk_m_s3', 'lockup_slip_acceleration_rad_s2')
"""Metrics of a single instant."""
OTHERS = (
    *('engagement_time_s', 'torsion_speed_std_rpm', 'acceleration_std_m_s2', 'slip_rmse_rpm'),
    *('slip_final_rpm', 'friction_energy_j', 'vdv_m_s1_75', 'torque_total_variation_n_m'),
)
"""Metrics of many instants, and times."""


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
    _skip_where_too_busy(timing, run)
    lockstep, realtime = expected(run), recording.trajectory
    peak = np.abs(lockstep.slip_speed).max()
    assert realtime.slip_speed == pytest.approx(lockstep.slip_speed, abs=NEAR * peak)
    assert timing['steps'] == run.steps
    assert len(timing['update_times_us']) >= 0.9 * run.steps


def _skip_where_too_busy(timing: dict[str, Any], run: RunPlan) -> None:
    missed = timing['missed_steps']
    if missed > MISS_TOLERANCE * run.steps:
        pytest.skip(f'too busy for real time: {missed} of {run.steps} missed')


def test_real_time_is_no_faster_than_the_wall_clock(tmp_path: Path) -> None:
    run = plan(layout='single-process', mode='realtime')
    recording = record(run, tmp_path / 'bag')
    assert recording.trajectory.steps == run.steps
    assert recording.facts.mode == 'realtime'
    timing = _timing(tmp_path / 'bag')
    share = timing['wall_time_s'] / run.settings.scenario.duration_s
    assert share >= 0.95
    _skip_where_too_busy(timing, run)
    assert share <= 2.0


def test_wall_clock_figures_are_recorded_in_real_time_only(tmp_path: Path) -> None:
    topics = {'/controller/timing', '/diagnostics'}
    for mode, recorded in (('realtime', topics), ('lockstep', set())):
        run = plan(layout='single-process', mode=mode, duration_s=0.5)
        counts = record(run, tmp_path / mode).counts
        assert topics & {topic for topic, count in counts.items() if count} == recorded


@pytest.mark.parametrize('mode', ['realtime', 'lockstep'])
def test_counts_and_update_times_are_those_of_the_whole_run(tmp_path: Path, mode: str) -> None:
    """The end is between two reports of the driveline, and between two of the controller."""
    run = plan(layout='single-process', mode=mode, duration_s=0.55)
    record(run, tmp_path / mode)
    timing = _timing(tmp_path / mode)
    assert timing['steps'] == run.steps == 55
    updates = len(timing['update_times_us'])
    assert updates == 56 or (mode == 'realtime' and updates + timing['missed_steps'] >= 56)
    ticks = {name: sum(each['counts'].values()) for name, each in timing['durations'].items()}
    assert ticks.get('lateness') == (55 if mode == 'realtime' else None)


def _lose(owner: RealtimeOwner, steps: Collection[int]) -> None:
    """Lose the clutch torques that answer the ticks of these steps, and wait for none of them."""
    offer, missing = owner.offer, owner.missing

    def lossy_offer(topic: str, stamp_ns: int, reply: Any) -> None:
        if topic != CLUTCH_TORQUE.name or step_of_stamp(stamp_ns) not in steps:
            offer(topic, stamp_ns, reply)

    def others_missing() -> list[str]:
        lost = [CLUTCH_TORQUE.name] if owner.step in steps else []
        return [topic for topic in missing() if topic not in lost]

    owner.offer, owner.missing = lossy_offer, others_missing  # type: ignore[method-assign]


@pytest.mark.parametrize(
    ('controller', 'tolerance', 'of_peaks'),
    [('pi', 0.01, 0.15), ('lqi', 0.01, 0.15), ('mpc3', 0.01, 0.15), ('mpc4', 0.2, 0.2)],
)
def test_scores_with_as_many_misses_as_a_valid_run_may_have_are_near_those_of_lock_step(
    graph_of: GraphOf, controller: str, tolerance: float, of_peaks: float
) -> None:
    run = plan(controller, mode='realtime', duration_s=3.0)
    graph = graph_of(run)
    graph.add_all()
    most = round(MISS_TOLERANCE * run.steps)
    _lose(realtime_owner(graph), random.Random(2).sample(SLIP_PHASE, most))
    PatientClock(realtime_owner(graph))
    graph.run(60)
    found = score_recording(read_bag(graph.folder), 'bag', packaged_limits()).scores
    lockstep = recording_in_memory(
        plan(controller, duration_s=3.0).settings, controller, expected(run)
    )
    wanted = score_recording(lockstep, 'bag', packaged_limits()).scores
    assert found.valid
    assert found.metrics['missed_steps'] == most
    assert found.verdict.state == wanted.verdict.state
    for names, bound in ((OTHERS, tolerance), (PEAKS, of_peaks)):
        defined = [name for name in names if wanted.metrics[name] is not None]
        assert {name: found.metrics[name] for name in defined} == pytest.approx(
            {name: wanted.metrics[name] for name in defined}, rel=bound
        )
        assert all(found.metrics[name] is None for name in names if name not in defined)
    assert found.metrics != wanted.metrics, 'the misses change something'
