# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A gear shift in the graph with a controller of each kind, as headless."""

import shutil
from pathlib import Path

import pytest
from support.exported_mpc import compile_c
from support.fmu import controller_file, skip_without_fmus
from support.runs import expected, plan, record

from ddct_bringup.run.plan import RunPlan
from ddct_controllers.from_file.c_library.host import TEMPLATE

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[3]


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


@pytest.mark.compiler
@pytest.mark.parametrize('kind', ['python file', 'transfer function', 'C library', 'FMU'])
def test_a_controller_of_any_kind_and_a_handover_in_a_file_shift_in_the_graph_as_headless(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, kind: str
) -> None:
    monkeypatch.chdir(tmp_path)
    Path('ramps.py').write_text(HANDOVER, encoding='utf-8')
    # The process of a library in C ends with that of its node.
    layout = 'processes' if kind == 'C library' else 'single-process'
    run = shift(_file_of(kind), layout, 'ramps.py')
    trajectory = record(run, tmp_path / 'run').trajectory
    assert trajectory.sha256() == expected(run).sha256()
    assert not trajectory.closed_loop_torque[trajectory.handover_share < 1.0].any()
    assert trajectory.closed_loop_torque[-60:].any()


def _file_of(kind: str) -> str:
    """Return a controller file of a kind in the present folder."""
    if kind == 'FMU':
        skip_without_fmus()
        return controller_file(2)
    if kind == 'C library':
        for file in TEMPLATE.iterdir():
            shutil.copy(file, file.name)
        compile_c(Path(), '-O2', '-shared', '-fPIC', 'my_controller.c', '-o', 'my_controller.so')
        return 'my_controller.yaml'
    if kind == 'transfer function':
        return str(ROOT / 'docs' / 'templates' / 'transfer_function.yaml')
    Path('mine.py').write_text(PYTHON, encoding='utf-8')
    return 'mine.py'


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
