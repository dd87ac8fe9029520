# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Figures 2.11 to 2.28, 3.10 to 3.19, 4.3 to 4.8 and 5.1: w_d, w_sr and A_x of each group."""

import functools
from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.reproduction.figures.figure_groups import FIGURE_GROUPS, FigureGroup
from ddct_bringup.reproduction.figures.thesis_figure import ThesisFigure, draw_over_time
from ddct_bringup.reproduction.numbers.gate import judge
from ddct_bringup.reproduction.numbers.gate_tables import computed_text
from ddct_bringup.reproduction.numbers.number_files import thesis_numbers
from ddct_bringup.reproduction.numbers.thesis_number import ThesisNumber
from ddct_bringup.reproduction.study_run import StudyRun, thesis_run
from ddct_bringup.reproduction.values.closed_loop_values import FIGURE_CLAIMS
from ddct_bringup.thesis.table_5_1 import CALIBRATED, PREDICTED, thesis_row
from ddct_controllers.design.drawing.line_styles import REFERENCE_LINE
from ddct_controllers.registry import controller_label
from ddct_plant.base.units import rpm_from_rad_s

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_FIRST_S = 0.5
"""Start of the time axis in s: "before 0.6 seconds" (Section 2.3)."""
_LABELS = {'w_d': 'w_d, rpm', 'w_sr': 'w_sr, rpm', 'A_x': 'A_x, m/s²'}
_SCORES = {
    'w_d': (
        ('t_a in s', 'engagement_time_s', '.2f'),
        ('RMS error in rpm', 'slip_rmse_rpm', '.0f'),
    ),
    'w_sr': (('σ in rpm', 'torsion_speed_std_rpm', '.2f'),),
    'A_x': (('σ in m/s²', 'acceleration_std_m_s2', '.2f'),),
}
"""Name, metric and format of the score of each quantity."""
_ARCHITECTURES = {
    'base': 'Base',
    'feedforward': 'Feedforward',
    'feedforward_tanh': 'Feedforward with tanh reference',
    'detailed': "CRF's detailed model",
}


def _line(run: Trajectory, quantity: str) -> tuple[np.ndarray, np.ndarray]:
    """Return time in s and w_d, its reference or w_sr in rpm, or A_x in m/s^2, from _FIRST_S."""
    speeds = {
        'w_d': run.slip_speed,
        'reference': run.at_tick('slip_reference'),
        'w_sr': run.driveshaft_speed,
    }
    values = rpm_from_rad_s(speeds[quantity]) if quantity in speeds else run.vehicle_accel
    shown = run.time_s >= _FIRST_S
    return run.time_s[shown], values[shown]


def thesis_label(controller: str) -> str:
    """Return the thesis's name of a controller of the registry."""
    return controller.replace('hinf', 'H∞').upper()


def _legend(chosen: str, wear_gain: float, group: FigureGroup) -> str:
    name = thesis_label(chosen) if chosen in group.controllers else controller_label(chosen)
    return name + (f' (K_usura = {wear_gain:g})' if len(group.wear_gains) > 1 else '')


def _draw(axes: 'Axes', group: FigureGroup, quantity: str, own: Sequence[str]) -> str:
    runs: dict[str, StudyRun] = {}
    for chosen in (*group.controllers, *own):
        for wear in group.wear_gains:
            legend = _legend(chosen, wear, group)
            runs[legend] = thesis_run(chosen, group.architecture, wear)
    lines = {name: _line(run.trajectory, quantity) for name, run in runs.items()}
    if quantity == 'w_d':
        lines['reference'] = _line(list(runs.values())[-1].trajectory, 'reference')
    end_s = max(time[-1] for time, _ in lines.values())
    draw_over_time(
        axes, _LABELS[quantity], (_FIRST_S, end_s), lines, {'reference': REFERENCE_LINE}
    )
    return f'{_claim(group, quantity)} {_scores(group, runs, quantity)}.' + _table_5_1(
        group, quantity
    )


def _claim(group: FigureGroup, quantity: str) -> str:
    """Return the claim and its verdicts below the first figure of a group, below others where."""
    first = group.numbers[0]
    if quantity != next(iter(_LABELS)):
        return f'The claim of the thesis and its verdict stand below Figure {first}.'
    verdicts = [_verdict(name) for name in group.listed] or [
        'The list of numbers has no such claim'
    ]
    return ' '.join(
        f'{sentence}.'
        for sentence in (f'Thesis: {group.thesis_claim}', *verdicts, group.remark)
        if sentence
    )


def _verdict(name: str) -> str:
    """Return the verdict of `thesis numbers` on a claim, with the values behind it."""
    number = next(number for number in _listed() if number.id == name)
    (row,) = judge((number,), {name: FIGURE_CLAIMS[name]()})
    return (
        f'{row.outcome.capitalize()} in the list of numbers: {number.item}: "{number.printed}", '
        f'ours {computed_text(row)}'
    )


@functools.cache
def _listed() -> tuple[ThesisNumber, ...]:
    return thesis_numbers()


def _scores(group: FigureGroup, runs: dict[str, StudyRun], quantity: str) -> str:
    """Return the score of the quantity for each run as text."""
    beside = {
        thesis_label(name): thesis_run(name, group.architecture, 1.0) for name in group.compared
    }
    parts = []
    for what, metric, form in _SCORES[quantity]:
        part = f'{what}: {_texts(runs, metric, form)}'
        if beside:
            part += f' (for comparison {_texts(beside, metric, form)})'
        parts.append(part)
    return '; '.join(parts)


def _texts(runs: dict[str, StudyRun], metric: str, form: str) -> str:
    values = {name: run.metrics[metric] for name, run in runs.items()}
    return ', '.join(
        f'{name} {"none" if value is None else format(value, form)}'
        for name, value in values.items()
    )


def _table_5_1(group: FigureGroup, quantity: str) -> str:
    """Return the values of Table 5.1 for these runs in the detailed architecture as text."""
    metric = _SCORES[quantity][0][1]
    rows = [thesis_row(name) for name in group.controllers if group.architecture == 'detailed']
    found = ''
    for use, kind in ((CALIBRATED, 'used'), (PREDICTED, 'not used')):
        printed = [
            f'{thesis_label(row.controller)} {row.printed_values()[metric]:.2f}'
            for row in rows
            if row and row.use == use
        ]
        if printed:
            found += f' Table 5.1, {kind} in the calibration: {", ".join(printed)}.'
    return found


def _names(controllers: tuple[str, ...]) -> str:
    labels = [thesis_label(name) for name in controllers if name != 'pi']
    several = f'{labels[0]}-{labels[-1].lstrip("LSH∞MPC")}' if len(labels) > 1 else labels[0]
    return f'{several} and PI' if 'pi' in controllers else several


def run_figures(own: Sequence[str] = ()) -> list[ThesisFigure]:
    """Return the figures of all groups; `own` are further controllers in each, names or files."""
    return [
        ThesisFigure(
            number,
            f'{quantity}, {_names(group.controllers)}, {_ARCHITECTURES[group.architecture]}',
            partial(
                _draw,
                group=group,
                quantity=quantity,
                own=[chosen for chosen in own if chosen not in group.controllers],
            ),
        )
        for group in FIGURE_GROUPS
        for quantity, number in zip(_LABELS, group.numbers, strict=False)
    ]
