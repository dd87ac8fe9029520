# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every controller in every packaged scenario, new and worn: state, figures and slip."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from ddct_bringup.many_runs.engine import results_of
from ddct_bringup.reproduction.studies.study import (
    WEAR_GAINS,
    Study,
    StudyColumn,
    StudyFunction,
    cells,
    friction_kj,
    headers,
    identified_by,
)
from ddct_bringup.reproduction.study_run import StudyRun, study_run
from ddct_bringup.verdict.state import ENGAGED
from ddct_controllers.design.drawing.line_styles import BLACK, BLUE, GREY, VERMILLION
from ddct_controllers.registry import own_controller_names
from ddct_plant.base.timebase import PERIOD_S, time_of_step
from ddct_plant.program.table import TextColumn
from ddct_plant.scenario.choices.scenarios import scenario_names
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PANELS_IN_A_ROW = 5
PANEL_INCHES = (2.2, 1.45)
DOTS_PER_INCH = 58.0
"""Resolution of a chart, at which its file is smaller than 150 kB."""
MARGIN = 0.15
"""Margin beyond the slips of engaged runs, as a share; larger slips leave the panel."""
_COLOURS = (VERMILLION, BLACK, BLUE)
Case = tuple[str, float, str]
"""Scenario, wear gain, controller."""


@dataclass(frozen=True, eq=False)
class Slip:
    """Slip of one run, and its state."""

    controller: str
    label: str
    """Wear gain as text, which distinguishes the runs of a controller."""
    state: str
    start: int
    """Step at which control starts."""
    rpm: np.ndarray
    """Slip speed w_d in rpm, (N+1,)."""


def _together(run: StudyRun) -> float | None:
    """Return the time to the final lock in s; t_a for a clutch that never locks."""
    name = 'time_to_final_lock_s' if run.settings.stick_slip else 'engagement_time_s'
    return run.scores.metrics[name]


COLUMNS: tuple[StudyColumn, ...] = (
    TextColumn('state', '', lambda run: run.scores.state),
    TextColumn('lock s', '.2f', _together),
    TextColumn('friction kJ', '.1f', friction_kj),
    TextColumn('releases', '.0f', lambda run: run.scores.metrics['releases']),
    TextColumn('peak jerk m/s^3', '.1f', lambda run: run.scores.metrics['peak_jerk_m_s3']),
)


def engagement(case: Case) -> tuple[tuple[str, ...], Slip]:
    """Run one case; return its row and its slip, small enough to send between processes."""
    scenario, wear_gain, controller = case
    settings = RunSettings(
        KnownSettings(load_scenario(scenario)), CaseSettings(wear_gain=wear_gain)
    )
    run = study_run(settings, controller)
    label = f'{wear_gain:g}'
    row = (label, controller, *cells(COLUMNS, run))
    return row, Slip(controller, label, run.scores.state, run.start, run.slip_rpm)


def _engagements(scenario: str) -> Study:
    title = f'Every controller in {scenario}'
    cases = [
        (scenario, wear_gain, controller)
        for wear_gain in WEAR_GAINS
        for controller in own_controller_names()
    ]
    rows, slips = zip(*results_of(engagement, cases), strict=True)
    return Study(
        title,
        ('K_usura', 'controller', *headers(COLUMNS)),
        rows,
        weights=identified_by(2),
        draw=partial(engagement_chart, title, slips),
    )


def engagement_chart(title: str, slips: Sequence[Slip]) -> 'Figure':
    """Return a panel per controller with all its runs over time in s, and their states."""
    from matplotlib.figure import Figure

    panels: dict[str, list[Slip]] = {}
    for slip in slips:
        panels.setdefault(slip.controller, []).append(slip)
    rows = math.ceil(len(panels) / PANELS_IN_A_ROW)
    size = (PANELS_IN_A_ROW * PANEL_INCHES[0], rows * PANEL_INCHES[1])
    figure = Figure(figsize=size, dpi=DOTS_PER_INCH)
    figure.suptitle(f'{title}: w_d in rpm over s; control starts at the grey line')
    all_axes = figure.subplots(rows, PANELS_IN_A_ROW, squeeze=False, sharex=True, sharey=True).flat
    for axes, panel in zip(all_axes, panels.values(), strict=False):
        _draw(axes, panel)
    for axes in figure.axes[len(panels) :]:
        axes.set_axis_off()
    first = figure.axes[0]
    first.set_ylim(*_range(slips))
    first.set_xlim(0.0, time_of_step(max(len(slip.rpm) for slip in slips) - 1))
    return figure


def _draw(axes: 'Axes', panel: Sequence[Slip]) -> None:
    axes.set_title(panel[0].controller, fontsize=9.0)
    axes.tick_params(labelsize=7.0)
    axes.set_xlabel('Time, s', visible=False)  # for the chart's data; the title shows it
    axes.set_ylabel('w_d, rpm', visible=False)
    axes.axvline(time_of_step(panel[0].start), color=GREY, linewidth=0.8)
    for place, (slip, colour) in enumerate(zip(panel, _COLOURS, strict=True)):
        time = np.arange(len(slip.rpm)) * PERIOD_S
        axes.plot(time, slip.rpm, label=f'K_usura {slip.label}', color=colour, linewidth=1.1)
        axes.text(
            0.98,
            0.96 - 0.13 * place,
            f'{slip.label} {slip.state}',
            transform=axes.transAxes,
            color=colour,
            fontsize=7.5,
            horizontalalignment='right',
            verticalalignment='top',
            bbox={'facecolor': 'white', 'alpha': 0.75, 'edgecolor': 'none', 'pad': 0.5},
        )


def _range(slips: Sequence[Slip]) -> tuple[float, float]:
    """Return the range in rpm of the panels: of engaged runs, or of all without one."""
    together = [slip.rpm for slip in slips if slip.state == ENGAGED]
    shown = together or [slip.rpm for slip in slips]
    low, high = min(rpm.min() for rpm in shown), max(rpm.max() for rpm in shown)
    margin = MARGIN * (high - low)
    return float(low - margin), float(high + margin)


def _functions() -> dict[str, StudyFunction]:
    """Return the studies by name, one for each packaged scenario that is no gear shift."""
    return {
        f'engagements_{name}': partial(_engagements, name)
        for name in scenario_names()
        if not load_scenario(name).shift
    }


ENGAGEMENTS = _functions()
"""Studies by name, one per scenario."""
