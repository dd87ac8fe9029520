# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Figure of `limit`: the front of each metric over the lock time, with controllers on it."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ddct_bringup.floor.front import ControllerRow
from ddct_bringup.floor.metric_units import METRICS
from ddct_bringup.floor.values import Floor
from ddct_controllers.design.drawing.chart_style import chart_style, save_chart
from ddct_controllers.design.drawing.line_styles import BLACK, GREY, LineStyle, controller_style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_WIDTH_IN, _PANEL_IN, _MARGINS_IN = 8.0, 2.6, 1.1
_LEGEND_COLUMNS = 5
_HEADROOM = 8.0
"""Highest value shown over the median of the front; controllers beyond are at the upper edge."""


def write_front_figure(
    floors: Sequence[Floor],
    rows: Sequence[ControllerRow],
    title: str,
    path: Path,
    counted_from: str = 'control start',
) -> None:
    """Write the figure as PNG or SVG by the file's ending; raise DdctError where it cannot be."""
    with chart_style():
        save_chart(front_figure(floors, rows, title, counted_from), path)


def front_figure(
    floors: Sequence[Floor],
    rows: Sequence[ControllerRow],
    title: str,
    counted_from: str = 'control start',
) -> 'Figure':
    """
    Return the figure with one panel for each metric, from floors and rows of controllers.

    Lock times count from the instant that `counted_from` names.
    """
    from matplotlib.figure import Figure

    metrics = list(dict.fromkeys(floor.metric for floor in floors))
    drawing = Figure(figsize=(_WIDTH_IN, _PANEL_IN * len(metrics) + _MARGINS_IN))
    panels = drawing.subplots(len(metrics), sharex=True, squeeze=False)[:, 0]
    panels[0].set_title(title)
    for axes, metric in zip(panels, metrics, strict=True):
        _draw(axes, [f for f in floors if f.metric == metric], _marks(rows, metric))
        axes.set_ylabel(f'{metric.replace("_", " ")}\n{METRICS[metric]}')
    panels[-1].set_xlabel(f'time from {counted_from} to the lock, s')
    handles, labels = panels[0].get_legend_handles_labels()
    drawing.legend(handles, labels, ncols=_LEGEND_COLUMNS, loc='outside upper center')
    return drawing


class _Mark(NamedTuple):
    """Run of a controller in a panel: its lock time in s and its value of the metric."""

    controller: str
    lock_time_s: float
    value: float


def _marks(rows: Sequence[ControllerRow], metric: str) -> list[_Mark]:
    """Return the runs with a lock time and a value of a metric."""
    return [
        _Mark(row.controller, row.lock_time_s, row.value)
        for row in rows
        if row.metric == metric and row.lock_time_s is not None and row.value is not None
    ]


def _draw(axes: 'Axes', floors: Sequence[Floor], marks: Sequence[_Mark]) -> None:
    """Draw the proven least as an edge of what is impossible, the attained values as circles."""
    times = np.array([floor.lock_time_s for floor in floors])
    least = np.array([np.nan if floor.least is None else floor.least for floor in floors])
    attained = np.array([np.nan if f.attained is None else f.attained for f in floors])
    axes.fill_between(times, 0.0, least, color=GREY, alpha=0.25, label='no run can be here')
    axes.plot(times, least, color=BLACK, linewidth=1.2, label='least, proven')
    axes.plot(
        times,
        attained,
        color=BLACK,
        linestyle='none',
        marker='o',
        markersize=4.0,
        markerfacecolor='white',
        label='attained by a run',
    )
    values = [*least, *attained]
    top = _HEADROOM * float(np.nanmedian(values)) if np.isfinite(values).any() else 1.0
    highest = max(
        [float(np.nanmax(values)), *(min(mark.value, top) for mark in marks)], default=1.0
    )
    axes.set_ylim(0.0, 1.1 * highest if highest > 0.0 else 1.0)
    for mark in marks:
        style: LineStyle = {'marker': 'o', **controller_style(mark.controller)}
        style['linestyle'] = 'none'
        place = min(mark.value, 1.1 * highest)
        axes.plot(mark.lock_time_s, place, label=mark.controller, clip_on=False, **style)
