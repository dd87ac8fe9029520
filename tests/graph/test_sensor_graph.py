# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
A run with sensors is the same in one process and headless, and control reads sensor values.

That of many processes is in tests/nightly.
"""

from pathlib import Path

import numpy as np
from message_counts import message_counts
from support.in_process_graph import GraphOf
from support.runs import LAYOUTS, bag_bytes, expected, plan, record
from support.sensors import ALL_ON, FLAGS

from ddct_bringup.bag.reader import read_bag
from ddct_plant.signals.topics import SENSED_SLIP

DURATION_S = 0.7
SEED = 2**31 - 1


def test_both_layouts_leave_the_same_bytes_and_the_headless_trajectory(tmp_path: Path) -> None:
    bags = []
    for layout in LAYOUTS[1:]:
        run = plan('pi', layout, duration_s=DURATION_S, seed=SEED, changes=(ALL_ON,))
        folder = tmp_path / layout
        trajectory = record(run, folder).trajectory
        assert trajectory.sha256() == expected(run).sha256(), layout
        assert all(set(np.unique(trajectory.signals[name])) == {0.0, 1.0} for name in FLAGS)
        bags.append(bag_bytes(folder))
    assert all(bag == bags[0] for bag in bags)


def test_two_inputs_closing_stage_and_shaft_speed_go_by_the_sensors(graph_of: GraphOf) -> None:
    run = plan(
        'decoupled_pid',
        'single-process',
        duration_s=DURATION_S,
        seed=3,
        scenario='thesis_sticking',
        changes=(
            ALL_ON,
            'closing={}',
            'reference.shape=engine_speed_target',
            'engine_speed_reference={time_s: [0.0, 2.0], speed_rad_s: [160.0, 180.0]}',
        ),
    )
    graph = graph_of(run)
    graph.add_all()
    graph.run()
    trajectory = read_bag(graph.folder).trajectory
    assert (trajectory.sensed, trajectory.two_input) == (True, True)
    assert trajectory.sha256() == expected(run).sha256()


def test_a_run_in_real_time_has_them_too(graph_of: GraphOf) -> None:
    run = plan('pi', 'single-process', duration_s=0.5, mode='realtime', changes=(ALL_ON,))
    graph = graph_of(run)
    graph.add_all()
    graph.run()
    recording = read_bag(graph.folder)
    headless = expected(plan('pi', duration_s=0.5, changes=(ALL_ON,)))
    counts = message_counts(graph.folder)
    assert counts[SENSED_SLIP.resolved_name] == headless.steps + 1
    assert not recording.missed and not recording.realtime.missed_steps
    assert np.array_equal(recording.trajectory.sensed_slip_speed, headless.sensed_slip_speed)
