# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What a lower weighted acceleration costs: runs of `least_jerk` with gentler or quicker plans."""

from itertools import product

from ddct_bringup.floor.floor import floors_of_run
from ddct_bringup.run.headless import run_headless
from ddct_bringup.verdict.limits import TRACTION
from ddct_controllers.least_jerk.controller import NAME
from ddct_plant.base.errors import DdctError
from ddct_plant.program.table import Table, text_or_dash
from ddct_plant.program.workers import in_processes
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings
from generator.least_jerk.repeated_cases import scored
from generator.least_jerk.variants import Variant

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


PACKAGED = Variant('as packaged')
PLANS = (
    *product(
        ('thesis', 'launch', 'launch_hot', 'launch_hill'),
        (PACKAGED, Variant('slower', SLOWER), Variant('slowest', SLOWEST)),
    ),
    ('tip_in', PACKAGED),
    ('tip_in', Variant('demand over 3 periods', {'demand_periods': 3.0})),
    ('upshift', PACKAGED),
    ('upshift', Variant('quicker', {'shift_s': 0.8})),
    ('upshift_full', PACKAGED),
    ('upshift_full', Variant('quicker', {'shift_s': 0.8})),
    (
        'upshift_full',
        Variant(
            'torque rises within 0.15 s, at once',
            {'refill_s': 0.15},
            {'OPENING': 0, 'REFILLING': 1},
        ),
    ),
)
"""Scenarios with the plans in them, in the order of the table."""


def price_table() -> Table:
    """Return the table of the plans."""
    with in_processes(lambda place: price_row(*PLANS[place]), len(PLANS), chunk=1) as rows:
        return Table('What lower limits cost', _HEADERS, list(rows))


def price_row(scenario: str, plan: Variant) -> tuple[str, ...]:
    """Return the row of a plan, with a new clutch and exact signals."""
    made = load_scenario(scenario, plan.changes, clutch='stick_slip')
    settings = RunSettings(made, clutch='stick_slip', seed=1)
    with plan.constants_changed():
        run = run_headless(settings, NAME)
    verdict = scored(settings, run).verdict
    values = {each.name: each.value for each in verdict.results}
    try:
        over = floors_of_run(settings, [WEIGHTED], run, attain=False)[WEIGHTED]
    except DdctError:
        over = None
    return (
        f'`{scenario}`',
        plan.label,
        f'`{verdict.state}`',
        *(text_or_dash(values[name], form) for name, form in _CRITERIA),
        text_or_dash(over.floor.least if over else None, '.3f'),
    )
