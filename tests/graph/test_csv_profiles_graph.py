# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Profiles from CSV files reach every node, and the bag alone is enough to score the run."""

import math
from pathlib import Path

from support.runs import bag_bytes, expected, plan, record

from ddct_bringup.scores.scored_recording import score_recording
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.scenario.csv_profiles import MOST_ROWS

COLUMNS = {'engine': 'N m', 'slope': 'deg', 'slip_reference': 'rpm'}


def test_graph_and_headless_agree_and_the_bag_needs_no_file(tmp_path: Path) -> None:
    file = tmp_path / 'drive.csv'
    rows = [
        f'{k / 100},{200.0 + 50.0 * math.sin(0.05 * k)!r},{4.0 * math.sin(0.03 * k)!r},{-k!r}\n'
        for k in range(MOST_ROWS)
    ]
    file.write_text('time,' + ','.join(COLUMNS) + '\n' + ''.join(rows))
    specs = tuple(
        f'{name}={{csv: {file}, time: time, value: {name}, unit: {unit}}}'
        for name, unit in COLUMNS.items()
    )
    changes = (*specs, 'reference.shape=profile')
    plans = [plan('pi', layout, changes=changes) for layout in ('single-process', 'headless')]
    file.unlink()
    recordings = [record(run, tmp_path / run.layout) for run in plans]
    wanted = expected(plans[0])
    assert wanted.slip_reference[80, 0] == -80 * math.pi / 30.0
    assert len(set(wanted.load_torque.round(1))) > 20, 'the slope acts'
    for recording in recordings:
        assert recording.trajectory.sha256() == wanted.sha256()
        assert recording.settings == plans[0].settings
        assert score_recording(recording, 'x', packaged_limits()).scores.valid
    assert bag_bytes(tmp_path / 'single-process') == bag_bytes(tmp_path / 'headless')
