"""Every controller in every packaged scenario, new and worn: what its verdict says."""

from functools import partial
from typing import Any

from ddct_bringup.reproduction.runs import THESIS_SCENARIO
from ddct_bringup.reproduction.studies.engagement_charts import Slip, engagement_chart
from ddct_bringup.reproduction.studies.study import (
    Study,
    StudyColumn,
    StudyFunction,
    StudyRun,
    cells,
    headers,
    study_run,
)
from ddct_controllers.registry import own_controller_names
from ddct_plant.models.clutch import CLUTCHES, STICK_SLIP
from ddct_plant.program.table import Column
from ddct_plant.program.workers import in_processes
from ddct_plant.scenario.file import load_scenario, scenario_names
from ddct_plant.scenario.settings import RunSettings

WEAR_GAINS = (0.7, 1.0, 1.3)
Case = tuple[str, str, float, str]
"""Scenario, clutch, wear gain, controller."""


def criterion(run: StudyRun, name: str) -> Any:
    """Return the value of a criterion of a run."""
    return next(each['value'] for each in run.verdict['criteria'] if each['name'] == name)


def _criterion_column(header: str, form: str, name: str, unit: float = 1.0) -> StudyColumn:
    def value(run: StudyRun) -> float | None:
        found = criterion(run, name)
        return None if found is None else found * unit

    return Column(header, form, value)


def _together(run: StudyRun) -> float | None:
    """Return the time to lock in s, of a clutch that never locks t_a."""
    name = 'time_to_lock' if run.settings.stick_slip else 'engagement_time'
    return criterion(run, name)


COLUMNS: tuple[StudyColumn, ...] = (
    Column('state', '', lambda run: run.verdict['state']),
    Column('limits', '', lambda run: run.verdict['limits']),
    Column('lock s', '.2f', _together),
    _criterion_column('friction kJ', '.1f', 'friction_energy', 1e-3),
    _criterion_column('releases', '.0f', 'releases_after_lock'),
    _criterion_column('peak jerk m/s^3', '.1f', 'peak_jerk'),
)


def engagement(case: Case) -> tuple[tuple[str, ...], Slip]:
    """Run one case; return its row and its slip, small enough to come from another process."""
    scenario, clutch, wear_gain, controller = case
    settings = RunSettings(load_scenario(scenario), clutch=clutch, wear_gain=wear_gain)
    run = study_run(settings, controller)
    label = f'{wear_gain:g}'
    row = (label, controller, *cells(COLUMNS, run))
    return row, Slip(controller, label, run.verdict['state'], run.start, run.slip_rpm)


def cases_of(scenario: str, clutch: str) -> list[Case]:
    """Return every packaged controller at every wear gain, in the order of the table."""
    return [
        (scenario, clutch, wear_gain, controller)
        for wear_gain in WEAR_GAINS
        for controller in own_controller_names()
    ]


def _engagements(scenario: str, clutch: str) -> Study:
    title = f'Every controller in {scenario}, clutch {clutch}'
    cases = cases_of(scenario, clutch)
    with in_processes(lambda index: engagement(cases[index]), len(cases)) as found:
        rows, slips = zip(*found, strict=True)
    return Study(
        title,
        ('K_usura', 'controller', *headers(COLUMNS)),
        rows,
        draw=partial(engagement_chart, title, slips),
    )


def _functions() -> dict[str, StudyFunction]:
    """Return the studies by name: the stick-slip clutch everywhere, the linear one in `thesis`."""
    thesis = THESIS_SCENARIO.name
    pairs = [(thesis, clutch) for clutch in CLUTCHES]
    pairs += [(name, STICK_SLIP) for name in scenario_names() if name != thesis]
    return {
        f'engagements_{scenario}' + (f'_{clutch}' if scenario == thesis else ''): partial(
            _engagements, scenario, clutch
        )
        for scenario, clutch in pairs
    }


ENGAGEMENTS = _functions()
"""A study per scenario and clutch."""
