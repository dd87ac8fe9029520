# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A gear shift in the graph: every layout and every kind of controller, as headless."""

from pathlib import Path

import pytest
from support.runs import LAYOUTS, bag_bytes, expected, record
from support.shifts_in_a_graph import CONTROLLER, require_shift_from_files, shift

pytestmark = pytest.mark.slow


@pytest.mark.parametrize(
    ('controller', 'handover', 'changes', 'layouts'),
    [
        pytest.param('pi', 'adaptive', (), LAYOUTS, marks=pytest.mark.nightly),
        ('mpc4', 'slip', ('shift.torque_cut_n_m=30', 'sensors={}'), LAYOUTS[1:]),
        pytest.param(
            'mpc_preview',
            'model',
            ('shift.torque_cut_n_m=30', 'shift.preselection_s=0.1', 'shift.disengagement_s=0.9'),
            LAYOUTS[1:],
            marks=pytest.mark.nightly,
        ),
    ],
    ids=['one input', 'two inputs, sensors and a torque cut', 'preview and events of the gearbox'],
)
def test_every_layout_leaves_the_same_bytes_and_the_headless_trajectory(
    tmp_path: Path,
    controller: str,
    handover: str,
    changes: tuple[str, ...],
    layouts: tuple[str, ...],
) -> None:
    bags = []
    for layout in layouts:
        run = shift(controller, layout, handover, changes=changes, off_going_wear_gain=0.9)
        recording = record(run, tmp_path / layout)
        trajectory = expected(run)
        assert recording.trajectory.sha256() == trajectory.sha256(), layout
        assert recording.trajectory.off_going_phase_events == trajectory.off_going_phase_events
        roles = {node: info.get('role') for node, info in recording.run_info.items()}
        assert roles['/actuator'] == roles['/clutch'] == 'on_coming'
        assert roles['/off_going/actuator'] == roles['/off_going/clutch'] == 'off_going'
        assert recording.run_info['/handover']['handover'] == handover
        bags.append(bag_bytes(tmp_path / layout))
    assert all(bag == bags[0] for bag in bags)
    assert trajectory.handover_share[0] == 0.0
    assert trajectory.handover_share[-1] == 1.0
    assert trajectory.off_going_clutch_phase[0] == 2.0
    assert trajectory.off_going_clutch_phase[-1] == 0.0


@pytest.mark.nightly
def test_controller_and_handover_in_files_shift_in_the_graph_as_headless(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path('mine.py').write_text(CONTROLLER, encoding='utf-8')
    require_shift_from_files('mine.py', 'single-process', tmp_path / 'run')
