"""Real time: 100 Hz on the wall clock, the trajectory of lock-step where no step was missed."""

import json
from pathlib import Path

import numpy as np
import pytest
from support.runs import expected, plan, record

from ddct_bringup.scoring import score_recording

SLIP_PER_MISSED_STEP_RAD_S = 1.0
"""
How far one missed step may move the slip speed.

It holds torques for 10 ms that would have moved by less than 20 N m, on inertias above 0.2 kg m^2.
"""


@pytest.mark.parametrize('layout', ['processes', 'single-process'])
def test_real_time_is_lock_step_as_long_as_no_step_is_missed(tmp_path: Path, layout: str) -> None:
    run = plan(layout=layout, mode='realtime', duration_s=2.0)
    recording = record(run, tmp_path / 'bag')
    timing = json.loads((tmp_path / 'bag' / 'timing.json').read_text())
    lockstep = expected(run)
    slip_shift = np.abs(recording.trajectory.slip_speed - lockstep.slip_speed).max()
    assert slip_shift <= SLIP_PER_MISSED_STEP_RAD_S * timing['missed_steps'], timing
    if timing['missed_steps'] == 0:
        assert np.array_equal(recording.trajectory.joint_position, lockstep.joint_position)
    assert timing['missed_steps'] <= 0.1 * run.steps, timing
    assert timing['steps'] == run.steps
    assert len(timing['update_times_us']) >= 0.9 * run.steps


def test_real_time_is_no_faster_than_the_wall_clock(tmp_path: Path) -> None:
    run = plan(layout='single-process', mode='realtime')
    recording = record(run, tmp_path / 'bag')
    entry = score_recording(recording, 'bag')
    assert entry['valid'], entry['reason']
    assert entry['mode'] == 'realtime'
    timing = json.loads((tmp_path / 'bag' / 'timing.json').read_text())
    assert 0.95 <= timing['wall_time_s'] / run.settings.scenario.duration_s <= 2.0


def test_wall_clock_figures_are_recorded_in_real_time_only(tmp_path: Path) -> None:
    topics = {'/controller/timing', '/diagnostics'}
    for mode, recorded in (('realtime', topics), ('lockstep', set())):
        run = plan(layout='single-process', mode=mode, duration_s=0.5)
        counts = record(run, tmp_path / mode).counts
        assert topics & {topic for topic, count in counts.items() if count} == recorded
