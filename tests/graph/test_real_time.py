# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Real time: 100 Hz, the trajectory of lock-step where no step was missed."""

import json
import random
from collections.abc import Collection

import pytest
from message_counts import message_counts
from samples import sampled
from support.altering import Alter, AlteringNode, add_altering, remaps
from support.in_process_graph import GraphOf
from support.runs import expected, plan

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.run.execution import recording_in_memory
from ddct_bringup.scores.scored_recording import score_recording
from ddct_bringup.scores.validity import MISS_TOLERANCE
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.signals.topics import CLUTCH_TORQUE

WALL_CLOCK = {'/controller/timing', '/diagnostics'}
"""Topics with figures of the wall clock."""
SLIP_PHASE = range(60, 170)
"""Steps from control start to the end of the score window of `thesis`."""
PEAKS = ('peak_jerk_m_s3', 'lockup_slip_acceleration_rad_s2')
"""Metrics of a single instant."""
OTHERS = (
    *('engagement_time_s', 'torsion_speed_std_rpm', 'acceleration_std_m_s2', 'slip_final_rpm'),
    *('torque_late_s', 'friction_work_j', 'weighted_acceleration_m_s2'),
)
"""Metrics of many instants, and times."""


@pytest.mark.parametrize('controller', ['ls8', 'mpc4'])
def test_real_time_without_a_miss_is_lock_step_to_the_last_bit(
    graph_of: GraphOf, controller: str
) -> None:
    run = plan(controller, mode='realtime', duration_s=1.5)
    graph = graph_of(run)
    graph.add_all()
    graph.run()
    recording = read_bag(graph.folder)
    assert recording.missed == {}
    assert recording.realtime.missed_steps == 0
    assert recording.trajectory.sha256() == expected(run).sha256()
    scores = score_recording(recording, 'bag', packaged_limits()).scores
    assert (scores.valid, scores.safe_state) == (True, '')


@pytest.mark.parametrize('mode', ['realtime', 'lockstep'])
def test_counts_and_update_times_are_those_of_the_whole_run(graph_of: GraphOf, mode: str) -> None:
    """
    The end is between two reports of the driveline, and between two of the controller.

    Figures of the wall clock are recorded in real time only.
    """
    run = plan(mode=mode, duration_s=0.55)
    graph = graph_of(run)
    graph.add_all()
    graph.run()
    timing = json.loads((graph.folder / 'timing.json').read_text())
    assert timing['steps'] == run.steps == 55
    assert len(timing['update_times_us']) == 56
    samples = 55 if mode == 'realtime' else 0
    # The run ends with the answer to the last tick.
    assert (len(timing['lateness_us']), len(timing['latency_us'])) == (
        samples,
        max(samples - 1, 0),
    )
    recorded = WALL_CLOCK & message_counts(graph.folder).keys()
    assert recorded == (WALL_CLOCK if mode == 'realtime' else set())


def _lose(steps: Collection[int]) -> Alter:
    """Lose the messages that answer the ticks of these steps."""

    def alter(node: AlteringNode, step: int, cdr: bytes) -> None:
        if step not in steps:
            node.send(cdr)

    return alter


@pytest.mark.parametrize(
    ('controller', 'tolerance', 'of_peaks'),
    sampled([('pi', 0.01, 0.15), ('mpc4', 0.2, 0.2)], every=2),
)
def test_scores_with_as_many_misses_as_a_valid_run_may_have_are_near_those_of_lock_step(
    graph_of: GraphOf, controller: str, tolerance: float, of_peaks: float
) -> None:
    run = plan(controller, mode='realtime', duration_s=3.0)
    graph = graph_of(run)
    most = round(MISS_TOLERANCE * run.steps)
    lost = random.Random(2).sample(SLIP_PHASE, most)
    graph.add('driveline', cli_args=remaps('driveline', [CLUTCH_TORQUE.name]))
    add_altering(graph, CLUTCH_TORQUE.name, _lose(lost), reader='driveline')
    graph.add_all()
    graph.run()
    found = score_recording(read_bag(graph.folder), 'bag', packaged_limits()).scores
    lockstep = recording_in_memory(
        plan(controller, duration_s=3.0).settings, controller, expected(run)
    )
    wanted = score_recording(lockstep, 'bag', packaged_limits()).scores
    assert found.valid
    assert found.metrics['missed_steps'] == most
    assert found.state == wanted.state
    for names, bound in ((OTHERS, tolerance), (PEAKS, of_peaks)):
        defined = [name for name in names if wanted.metrics[name] is not None]
        assert {name: found.metrics[name] for name in defined} == pytest.approx(
            {name: wanted.metrics[name] for name in defined}, rel=bound
        )
        assert all(found.metrics[name] is None for name in names if name not in defined)
    assert found.metrics != wanted.metrics, 'the misses change something'
