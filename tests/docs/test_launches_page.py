"""The table of docs/use/launches.md is what the packaged scenarios give."""

import re
from pathlib import Path

from ddct_bringup.run.headless import run_headless
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

PAGE = Path(__file__).resolve().parents[2] / 'docs' / 'use' / 'launches.md'
SCENARIOS = ('launch', 'launch_hill', 'launch_gentle', 'launch_hot', 'tip_in')
CONTROLLERS = ('ls8', 'hinf1', 'hinf_sampled')


def row(name: str, controller: str) -> str:
    settings = RunSettings(load_scenario(name), clutch='stick_slip')
    trajectory = run_headless(settings, controller)
    assert trajectory.phase_events is not None
    assert trajectory.friction_work is not None
    events = [event for step in trajectory.phase_events for event in step]
    locked_s = next(time for time, kind in events if kind == 'lock')
    wheel_radius = settings.scenario.vehicle.wheel_radius_m
    figures = (
        f'{locked_s:.2f}',
        str(len(events)),
        f'{1e-3 * trajectory.friction_work.sum():.1f}',
        f'{trajectory.joint_effort[:, 1].max():.0f}',
        f'{3.6 * trajectory.joint_speed[-1, 2] * wheel_radius:.1f}',
    )
    return f'| `{name}` | {controller} | {" | ".join(figures)} |'


def table() -> list[str]:
    return [row(name, controller) for name in SCENARIOS for controller in CONTROLLERS]


def test_the_table_of_launches_is_what_the_scenarios_give():
    page = PAGE.read_text(encoding='utf-8')
    block = re.search(r'<!-- launches -->\n(.*?)<!-- end -->', page, re.DOTALL)
    assert block is not None
    assert block[1].splitlines()[2:] == table()
