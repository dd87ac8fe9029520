# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A gear shift in the graph: every layout and every kind of controller, as headless."""

from pathlib import Path

import pytest
from support.runs import LAYOUTS, bag_bytes, expected, plan, record

from ddct_bringup.run.plan import RunPlan

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[2]


def shift(
    controller: str,
    layout: str,
    handover: str = 'model',
    *,
    changes: tuple[str, ...] = (),
    mode: str = 'lockstep',
    off_going_wear_gain: float = 1.0,
) -> RunPlan:
    """Return an upshift of 1.3 s, which is over when the on-coming clutch has locked."""
    return plan(
        controller,
        layout,
        scenario='upshift',
        duration_s=1.3,
        clutch='stick_slip',
        mode=mode,
        changes=('score_window_s=[0.3, 1.3]', *changes),
        handover=handover,
        off_going_wear_gain=off_going_wear_gain,
    )


@pytest.mark.parametrize(
    ('controller', 'handover', 'changes', 'layouts'),
    [
        ('pi', 'adaptive', (), LAYOUTS),
        ('mpc4', 'slip', ('shift.torque_cut_n_m=30', 'sensors={}'), LAYOUTS[1:]),
        (
            'mpc_preview',
            'model',
            ('shift.torque_cut_n_m=30', 'shift.preselection_s=0.1', 'shift.disengagement_s=0.9'),
            LAYOUTS[1:],
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


def test_controller_and_handover_in_files_shift_in_the_graph_as_headless(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path('ramps.py').write_text(HANDOVER, encoding='utf-8')
    Path('mine.py').write_text(PYTHON, encoding='utf-8')
    run = shift('mine.py', 'single-process', 'ramps.py')
    trajectory = record(run, tmp_path / 'run').trajectory
    assert trajectory.sha256() == expected(run).sha256()
    assert not trajectory.closed_loop_torque[trajectory.handover_share < 1.0].any()
    assert trajectory.closed_loop_torque[-60:].any()


HANDOVER = """
from ddct_controllers.handover.laws import TimedHandover


class Ramps(TimedHandover):
    pass
"""
PYTHON = """
from ddct_controllers.interface import Command, Controller


class Mine(Controller):
    def reset(self):
        self.integral = 0.0

    def update(self, measurement):
        self.integral += 0.01 * measurement.slip_error_rpm
        return Command(-0.1 * measurement.slip_error_rpm - 0.02 * self.integral)
"""
