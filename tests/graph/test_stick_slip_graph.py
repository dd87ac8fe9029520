# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A clutch that sticks in the graph: every layout leaves the bytes of the headless loop."""

from pathlib import Path

import pytest
from support.in_process_graph import GraphOf, by_hand
from support.runs import LAYOUTS, bag_bytes, expected, plan, record

from ddct_bringup.scores.scored_recording import score_recording
from ddct_bringup.verdict.limits import packaged_limits

LAUNCH = (
    'initial.shaft_speed_rad_s=0',
    'initial.engine_speed_rad_s=104.7',
    'gear=1',
    'load.slope_rad=0.05',
    'brake.time_s=[0.2,0.4]',
    'brake.torque_n_m=[600,0]',
    'friction.static_over_kinetic=1.2',
)
"""Changes for a start from rest uphill, braked, with a higher static than kinetic capacity."""
OVER_REVVED = (
    'engine_limits.over_rev_rad_s=200',
    'engine_limits.cut_rad_s=199',
    'engine_limits.resume_rad_s=190',
    'engine_limits.idle_rad_s=100',
    'engine_limits.full_load_n_m=[0, 110, 170, 225, 250, 217, 165, 308]',
)


@pytest.mark.parametrize(
    ('controller', 'changes', 'layouts'),
    [
        pytest.param('ls8', (), LAYOUTS, marks=pytest.mark.nightly),
        ('pi', LAUNCH, LAYOUTS[1:]),
    ],
    ids=['thesis', 'launch'],
)
def test_every_layout_leaves_the_same_bytes_and_the_headless_trajectory(
    tmp_path: Path,
    controller: str,
    changes: tuple[str, ...],
    layouts: tuple[str, ...],
) -> None:
    bags = []
    for layout in layouts:
        run = plan(controller, layout, duration_s=2.0, scenario='thesis_sticking', changes=changes)
        recording = record(run, tmp_path / layout)
        trajectory = expected(run)
        assert recording.trajectory.sha256() == trajectory.sha256(), layout
        assert recording.trajectory.phase_events == trajectory.phase_events
        bags.append(bag_bytes(tmp_path / layout))
    assert all(bag == bags[0] for bag in bags)
    assert {1.0, 2.0} <= set(trajectory.clutch_phase)
    assert trajectory.friction_work.sum() > 100.0


def test_an_engine_that_over_revs_ends_every_layout_at_once_with_a_bag_that_counts(
    tmp_path: Path,
) -> None:
    bags = []
    for layout in LAYOUTS[1:]:
        run = plan('pi', layout, scenario='thesis_sticking', wear_gain=0.7, changes=OVER_REVVED)
        recording = record(run, tmp_path / layout)
        speeds = recording.trajectory.joint_speed[:, 0]
        assert speeds[-1] >= 200.0 > speeds[:-1].max()
        assert recording.trajectory.steps < run.steps
        assert recording.trajectory.sha256() == expected(run).sha256()
        assert score_recording(recording, layout, packaged_limits()).scores.valid
        bags.append(bag_bytes(tmp_path / layout))
    assert bags[0] == bags[1]


@pytest.mark.parametrize(
    ('node', 'complaint'),
    [
        ('clutch', 'clutch/torque has the joints clutch: this run needs clutch, clutch_static'),
        ('load', 'no load/holding_torque'),
    ],
)
def test_a_node_with_another_clutch_ends_the_run_with_an_error(
    graph_of: GraphOf, node: str, complaint: str
) -> None:
    graph = graph_of(plan('pi', 'single-process', scenario='thesis_sticking'))
    by_hand(graph, {'scenario': 'thesis_sticking'})
    changes = {'driveline': {'require_recorder': False, 'answer_timeout_s': 1.0}}
    graph.add(node, {'scenario': 'thesis'})
    graph.add('driveline', changes['driveline'])
    graph.add_all(without=('recorder',))
    failed, words = graph.first_failure()
    assert failed == 'driveline'
    assert complaint in words
