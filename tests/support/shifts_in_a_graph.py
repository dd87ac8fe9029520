# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Gear shifts in the graph, and a controller and a handover in files for them."""

from pathlib import Path

from ddct_bringup.run.plan import RunPlan
from support.runs import expected, plan, record

HANDOVER = """
from ddct_controllers.handover.laws import TimedHandover


class Ramps(TimedHandover):
    pass
"""
CONTROLLER = """
from ddct_controllers.interface import Command, Controller


class Mine(Controller):
    def reset(self):
        self.integral = 0.0

    def update(self, measurement):
        self.integral += 0.01 * measurement.slip_error_rpm
        return Command(-0.1 * measurement.slip_error_rpm - 0.02 * self.integral)
"""


def shift(
    controller: str,
    layout: str,
    handover: str = 'model',
    *,
    changes: tuple[str, ...] = (),
    off_going_wear_gain: float = 1.0,
) -> RunPlan:
    """Return an upshift of 1.3 s, which is over when the on-coming clutch has locked."""
    return plan(
        controller,
        layout,
        scenario='upshift',
        duration_s=1.3,
        changes=('score_window_s=[0.3, 1.3]', *changes),
        handover=handover,
        off_going_wear_gain=off_going_wear_gain,
    )


def require_shift_from_files(controller: str, layout: str, folder: Path) -> None:
    """Require the headless trajectory of a controller in a file, with `HANDOVER` beside it."""
    Path('ramps.py').write_text(HANDOVER, encoding='utf-8')
    run = shift(controller, layout, 'ramps.py')
    trajectory = record(run, folder).trajectory
    assert trajectory.sha256() == expected(run).sha256()
    assert not trajectory.closed_loop_torque[trajectory.handover_share < 1.0].any()
    assert trajectory.closed_loop_torque[-60:].any()
