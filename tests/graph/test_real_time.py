"""Real time: 100 Hz on the wall clock, the trajectory of lock-step where no step was missed."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.runs import expected, plan, record

from ddct_bringup.bag.reader import Recording
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.scores.scoring import score_recording

NEAR = 0.1
"""How near the slip speed stays to that of lock-step if a few steps are missed, of its peak."""


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


@pytest.mark.parametrize('layout', ['processes', 'single-process'])
def test_real_time_is_lock_step_as_long_as_no_step_is_missed(tmp_path: Path, layout: str) -> None:
    run = plan(layout=layout, mode='realtime', duration_s=1.5)
    recording, timing = _best_of_three(run, tmp_path)
    lockstep, realtime = expected(run), recording.trajectory
    if timing['missed_steps'] == 0:
        assert np.array_equal(realtime.joint_position, lockstep.joint_position)
        assert np.array_equal(realtime.joint_speed, lockstep.joint_speed)
    peak = np.abs(lockstep.slip_speed).max()
    assert realtime.slip_speed == pytest.approx(lockstep.slip_speed, abs=NEAR * peak)
    assert timing['missed_steps'] <= 0.1 * run.steps, timing
    assert timing['steps'] == run.steps
    assert len(timing['update_times_us']) >= 0.9 * run.steps


def test_real_time_is_no_faster_than_the_wall_clock(tmp_path: Path) -> None:
    run = plan(layout='single-process', mode='realtime')
    recording = record(run, tmp_path / 'bag')
    entry = score_recording(recording, 'bag')
    assert entry['valid'], entry['reason']
    assert entry['mode'] == 'realtime'
    timing = _timing(tmp_path / 'bag')
    assert 0.95 <= timing['wall_time_s'] / run.settings.scenario.duration_s <= 2.0


def test_wall_clock_figures_are_recorded_in_real_time_only(tmp_path: Path) -> None:
    topics = {'/controller/timing', '/diagnostics'}
    for mode, recorded in (('realtime', topics), ('lockstep', set())):
        run = plan(layout='single-process', mode=mode, duration_s=0.5)
        counts = record(run, tmp_path / mode).counts
        assert topics & {topic for topic, count in counts.items() if count} == recorded
