# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Table of the launches and the tip-in with a new clutch."""

from ddct_bringup.run.headless import run_headless
from ddct_plant.models.driveline import LOCK
from ddct_plant.program.table import Table
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

SCENARIOS = ('launch', 'launch_hill', 'launch_gentle', 'launch_hot', 'tip_in')
CONTROLLERS = ('ls8', 'hinf1', 'hinf_sampled')
_HEADERS = (
    'scenario',
    'controller',
    'first lock s',
    'events',
    'friction work kJ',
    'peak torque N m',
    'car at the end km/h',
)


def launch_table() -> Table:
    """Return a row for each scenario and controller."""
    rows = [_row(name, controller) for name in SCENARIOS for controller in CONTROLLERS]
    return Table('Launches and tip-in, new clutch', _HEADERS, rows)


def _row(name: str, controller: str) -> tuple[str, ...]:
    settings = RunSettings(load_scenario(name), clutch='stick_slip')
    trajectory = run_headless(settings, controller)
    assert trajectory.phase_events is not None
    assert trajectory.friction_work is not None
    events = [event for step in trajectory.phase_events for event in step]
    locked_s = next(event.time_s for event in events if event.kind == LOCK)
    wheel_radius = settings.scenario.vehicle.wheel_radius_m
    return (
        f'`{name}`',
        controller,
        f'{locked_s:.2f}',
        str(len(events)),
        f'{1e-3 * trajectory.friction_work.sum():.1f}',
        f'{trajectory.primary_shaft_effort.max():.0f}',
        f'{3.6 * trajectory.wheel_speed[-1] * wheel_radius:.1f}',
    )
