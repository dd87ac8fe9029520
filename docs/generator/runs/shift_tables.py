# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of gear shifts, and the chart of the two phases of one."""

from collections.abc import Mapping, Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ddct_bringup.floor.control_start import control_start
from ddct_bringup.floor.floor import floor_of, floors_of_run
from ddct_bringup.floor.lock import lock_of
from ddct_bringup.metrics.shift.course import ShiftCourse
from ddct_bringup.reproduction.study_run import StudyRun, study_run
from ddct_bringup.verdict.state import SUCCESSES
from ddct_controllers.design.drawing.chart_style import chart_style
from ddct_controllers.design.drawing.line_styles import BLACK, BLUE, GREY, VERMILLION
from ddct_controllers.handover.laws import HANDOVERS
from ddct_controllers.registry import own_controller_names
from ddct_plant.base.timebase import time_of_step
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.program.table import UNDEFINED, Table, text_or_dash
from ddct_plant.program.workers import in_processes
from ddct_plant.scenario.file import load_scenario, scenario_names
from ddct_plant.scenario.settings import RunSettings
from generator.drawings.study_charts import save_study_chart
from generator.pages import DOCS

SCENARIO, SHOWN = 'upshift', 'ls8'
"""Scenario of the table of all controllers, and the controller of the chart."""
SOME = ('pi', 'ls8', 'hinf2', 'torque_estimator')
"""Controllers of the tables over handovers and over scenarios."""
CHART = 'shift_phases'
_COLUMNS = {
    'shift_time_s': ('shift time s', '.3f'),
    'inertia_phase_s': ('inertia phase s', '.3f'),
    'torque_dip_percent': ('torque dip %', '.0f'),
    'flare_rad_s': ('flare rad/s', '.1f'),
    'tie_up_work_j': ('tie-up J', '.0f'),
    'friction_energy_j': ('friction J', '.0f'),
    'off_going_friction_energy_j': ('off-going J', '.0f'),
    'peak_jerk_m_s3': ('peak jerk m/s^3', '.1f'),
    'on_coming_releases': ('parts again', 'd'),
}
"""Heading and format by metric."""
_OF_FLOOR = ('least jerk m/s^3', 'jerk /least')
"""Headings of the least peak jerk at the lock time of a run, and of the run over it."""
_JERK = 'peak_jerk'
Case = tuple[str, str, str]
"""Scenario, handover, controller."""


def shift_scenarios() -> list[str]:
    """Return the packaged scenarios that are gear shifts."""
    return [name for name in scenario_names() if load_scenario(name).shift is not None]


def shift_tables() -> Mapping[str, Table]:
    """Return the tables by name, and draw the chart into `images`."""
    with chart_style():
        save_study_chart(phases_chart(), DOCS / 'images' / f'{CHART}.png')
    default = RunSettings(load_scenario(SCENARIO), clutch='stick_slip').handover
    return {
        'controllers': _table(
            'Every controller',
            'controller',
            {(SCENARIO, default, name): name for name in own_controller_names()},
        ),
        'handovers': _table(
            'Handovers',
            'handover, controller',
            {(SCENARIO, each, name): f'{each}, {name}' for each in HANDOVERS for name in SOME},
        ),
        'scenarios': _table(
            'Scenarios',
            'scenario, controller',
            {
                (each, default, name): f'`{each}`, {name}'
                for each in shift_scenarios()
                for name in SOME
            },
        ),
    }


def _table(title: str, key: str, cases: Mapping[Case, str]) -> Table:
    each = list(cases)
    with in_processes(lambda index: shift_row(each[index]), len(each)) as found:
        rows = [(label, *row) for label, row in zip(cases.values(), found, strict=True)]
    headings = (heading for heading, _ in _COLUMNS.values())
    return Table(title, (key, 'state', *headings, *_OF_FLOOR), rows)


def shift_row(case: Case) -> tuple[str, ...]:
    """Return the state and the metrics of one shift as text."""
    run = _run(case)
    metrics = run.metrics
    return (
        run.verdict.state,
        *(text_or_dash(metrics[key], form) for key, (_, form) in _COLUMNS.items()),
        *_least_jerk(run),
    )


def _least_jerk(run: StudyRun) -> tuple[str, str]:
    """
    Return the least peak jerk of the clutch alone at the run's lock time, and the run over it.

    A run that commands the engine too may be below: it has the least, and no ratio.
    """
    start = control_start(run.settings)
    lock = lock_of(run.trajectory, start.step)
    if lock is None or run.verdict.state not in SUCCESSES:
        return UNDEFINED, UNDEFINED
    over = floors_of_run(run.settings, [_JERK], run.trajectory, start, attain=False)[_JERK]
    least = over.floor.least if over else floor_of(run.settings, _JERK, lock.time_s).least
    return text_or_dash(least, '.1f'), text_or_dash(over.over_floor if over else None, '.2f')


def _run(case: Case) -> StudyRun:
    scenario, handover, controller = case
    settings = RunSettings(load_scenario(scenario), clutch='stick_slip', handover=handover)
    return study_run(settings, controller)


def phases_chart() -> Figure:
    """Return speeds, clutch torques and wheel torque of one shift, with its two phases shaded."""
    settings = RunSettings(load_scenario(SCENARIO), clutch='stick_slip')
    run = study_run(settings, SHOWN).trajectory
    course = ShiftCourse(run, settings.scenario.control_start_step)
    figure = Figure(figsize=(8.0, 7.2))
    speeds, torques, wheels = figure.subplots(3, sharex=True)
    speeds.set_title('Speeds')
    torques.set_title('Torques of both clutches')
    wheels.set_title('Torque at the wheels')
    for axes, unit in ((speeds, 'rpm'), (torques, 'N m'), (wheels, 'N m')):
        axes.set_ylabel(unit)
    lines = (
        (speeds, 'engine', rpm_from_rad_s(run.engine_speed), BLACK),
        (speeds, 'shaft of the old gear', rpm_from_rad_s(run.off_going_shaft_speed), VERMILLION),
        (speeds, 'shaft of the next gear', rpm_from_rad_s(run.primary_shaft_speed), BLUE),
        (torques, 'off-going clutch', run.off_going_transmitted_torque, VERMILLION),
        (torques, 'on-coming clutch', run.primary_shaft_effort, BLUE),
        (torques, 'engine', run.engine_torque, BLACK),
        (wheels, 'driveshaft', run.driveshaft_effort, BLACK),
    )
    for axes, label, values, colour in lines:
        axes.plot(run.time_s, values, label=label, color=colour)
    for axes in (speeds, torques):
        axes.legend(loc='center left', bbox_to_anchor=(1.0, 0.5), frameon=False)
    _shade(figure.axes, course)
    wheels.set_xlabel('time, s')
    wheels.set_xlim(0.0, run.time_s[-1])
    return figure


def _shade(panels: Sequence[Axes], course: ShiftCourse) -> None:
    """Shade the torque phase and the inertia phase in all panels, and name them in the first."""
    assert course.lock_s is not None
    start_s, share_s = time_of_step(course.start), time_of_step(course.feedback_start)
    phases = (
        ('torque\nphase', start_s, share_s, 0.30),
        ('inertia phase', share_s, course.lock_s, 0.12),
    )
    for axes in panels:
        for _, begin, end, opacity in phases:
            axes.axvspan(begin, end, color=GREY, alpha=opacity, linewidth=0.0)
    top = panels[0].get_ylim()[1]
    for name, begin, end, _ in phases:
        panels[0].text(
            (begin + end) / 2.0,
            top,
            name,
            horizontalalignment='center',
            verticalalignment='top',
            fontsize=9.0,
        )
