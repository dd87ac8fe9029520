# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What a lower weighted acceleration costs: runs of `least_jerk` with gentler or quicker plans."""

from collections.abc import Mapping
from contextlib import ExitStack
from dataclasses import dataclass, field
from unittest.mock import patch

from ddct_bringup.floor.floor import floors_of_run
from ddct_bringup.run.headless import run_headless
from ddct_bringup.verdict.limits import TRACTION
from ddct_controllers.least_jerk import torque_plan
from ddct_controllers.least_jerk.controller import NAME
from ddct_plant.base.errors import DdctError
from ddct_plant.program.table import Table, text_or_dash
from ddct_plant.program.workers import in_processes
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings
from generator.least_jerk.repeated_cases import scored

WEIGHTED = 'weighted_acceleration'
_CRITERIA = (
    ('time_to_lock', '.2f'),
    ('peak_jerk', '.1f'),
    (WEIGHTED, '.3f'),
    ('daily_vibration_dose', '.1f'),
    (TRACTION, '.2f'),
    ('friction_work_over_least', '.1f'),
)
_HEADERS = (
    *('scenario', 'plan', 'state', 'time to lock s', 'peak jerk m/s^3'),
    *('weighted acceleration m/s^2', 'daily dose m/s^1.75', 'traction m/s^2'),
    *('friction work over the least', 'least weighted acceleration for that time'),
)
SLOWER = {'jerk_m_s3': 2.0, 'latest_s': 1.2, 'least_s': 1.6}
SLOWEST = {'jerk_m_s3': 1.5, 'latest_s': 1.6, 'least_s': 2.0}


@dataclass(frozen=True)
class Plan:
    """A run of a scenario with other options and constants than the packaged ones."""

    scenario: str
    label: str = 'as packaged'
    options: Mapping[str, float] = field(default_factory=dict)
    constants: Mapping[str, int] = field(default_factory=dict)
    """Constants of `torque_plan` by name."""


PLANS = (
    *(
        plan
        for scenario in ('thesis', 'launch', 'launch_hot', 'launch_hill')
        for plan in (
            Plan(scenario),
            Plan(scenario, 'slower', SLOWER),
            Plan(scenario, 'slowest', SLOWEST),
        )
    ),
    Plan('tip_in'),
    Plan('tip_in', 'demand over 3 periods', {'demand_periods': 3.0}),
    Plan('upshift_full'),
    Plan(
        'upshift_full',
        'torque rises within 0.15 s, at once',
        {'refill_s': 0.15},
        {'OPENING': 0, 'REFILLING': 1},
    ),
)
"""Plans in the order of the table."""


def price_table() -> Table:
    """Return the table of the plans."""
    with in_processes(lambda place: price_row(PLANS[place]), len(PLANS), chunk=1) as rows:
        return Table('What lower limits cost', _HEADERS, list(rows))


def price_row(plan: Plan) -> tuple[str, ...]:
    """Return the row of a plan, with a new clutch and exact signals."""
    changes = {f'controllers.{NAME}.{key}': value for key, value in plan.options.items()}
    scenario = load_scenario(plan.scenario, changes, clutch='stick_slip')
    settings = RunSettings(scenario, clutch='stick_slip', seed=1)
    with ExitStack() as changed:
        for name, value in plan.constants.items():
            changed.enter_context(patch.object(torque_plan, name, value))
        run = run_headless(settings, NAME)
    verdict = scored(settings, run).verdict
    values = {each.name: each.value for each in verdict.results}
    try:
        over = floors_of_run(settings, [WEIGHTED], run, attain=False)[WEIGHTED]
    except DdctError:
        over = None
    return (
        f'`{plan.scenario}`',
        plan.label,
        f'`{verdict.state}`',
        *(text_or_dash(values[name], form) for name, form in _CRITERIA),
        text_or_dash(over.floor.least if over else None, '.3f'),
    )
