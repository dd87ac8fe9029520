# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Figure of `sweep`: metrics as lines over one key, states as maps over two."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ddct_bringup.campaign.rows import ScoredRow
from ddct_bringup.documents.page_parts import unit_text
from ddct_bringup.sweep.state_map import (
    draw_states,
    edges_of,
    label_values,
    places_of,
    state_legend,
)
from ddct_bringup.sweep.sweep import Sweep
from ddct_bringup.verdict.state import ENGAGED
from ddct_controllers.design.drawing.chart_style import (
    chart_style,
    controllers_text,
    headed,
    save_chart,
)
from ddct_controllers.design.drawing.line_styles import GREY, LineStyle, controller_style
from ddct_controllers.registry import controller_label
from ddct_plant.program.table import Quantity

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

_WIDTH_IN, _PANEL_IN, _LANE_IN = 8.0, 2.3, 0.32
_MAP_IN, _ACROSS = 3.0, 3
_LEGEND_COLUMNS = 6
_MARK: LineStyle = {'linestyle': 'none', 'markersize': 7.0, 'markeredgewidth': 1.8, 'zorder': 5}
_CROSS: LineStyle = {**_MARK, 'marker': 'x'}
_RING: LineStyle = {**_MARK, 'marker': 'o', 'markerfacecolor': 'none'}
_MARKS_OF_RUNS = ((_CROSS, 'other than engaged'), (_RING, 'engaged, no value'))
_HALF_LINE = 0.3
"""Half of the length of the line of a run at a name, where names are 1 apart."""
_MARGIN = 0.08
"""Margin above and below the values shown, as a share of their range."""
_FARTHEST = 4.0
"""
Largest distance of a value shown at its place from those of engaged runs.

It applies to runs that are not engaged, in ranges of the engaged values or halves of their size: a
runaway would leave no room for the others.
"""


def write_sweep_figure(
    sweep: Sweep, runs: Sequence[ScoredRow], metrics: Sequence[Quantity], path: Path
) -> None:
    """Write the figure as PNG or SVG by the file's ending; raise DdctError where it cannot be."""
    with chart_style():
        save_chart(sweep_figure(sweep, runs, metrics), path)


def _title(sweep: Sweep, names: Sequence[str], width_in: float) -> str:
    """Return the title for a figure of this width: controllers and axes, then the conditions."""
    return headed(f'{controllers_text(names)} {sweep.varied}', sweep.conditions, width_in)


def sweep_figure(sweep: Sweep, runs: Sequence[ScoredRow], metrics: Sequence[Quantity]) -> 'Figure':
    """Return the figure of the runs of a sweep over one axis or two, in its order."""
    from matplotlib.figure import Figure

    names = [controller_label(each) for each in sweep.controllers]
    states = np.array([run.scores.state for run in runs]).reshape(len(names), -1)
    if len(sweep.axes) > 1:
        return _maps(sweep, names, states)
    lane = 0.5 + _LANE_IN * len(names)
    heights = [*(_PANEL_IN for _ in metrics), lane]
    drawing = Figure(figsize=(_WIDTH_IN, sum(heights) + 1.3))
    panels = drawing.subplots(len(heights), sharex=True, height_ratios=heights)
    panels[0].set_title(_title(sweep, names, _WIDTH_IN))  # below the legend
    swept = sweep.axes[0]
    places = places_of(swept)
    for axes, figure in zip(panels, metrics, strict=False):
        values = np.array([run.scores.metrics[figure.key] for run in runs], dtype=float)
        axes.set_ylabel(', '.join(filter(None, (figure.symbol, unit_text(figure.unit)))))
        values = values.reshape(states.shape)
        _draw_metric(axes, places, names, values, states == ENGAGED, joined=swept.numeric)
    lines = panels[0].get_legend_handles_labels()
    drawing.legend(*lines, ncols=_LEGEND_COLUMNS, loc='outside upper center')
    _draw_lanes(panels[-1], places, names, states)
    label_values(swept, panels[-1].xaxis)
    marks = [_legend_mark(mark, meaning) for mark, meaning in _MARKS_OF_RUNS]
    state_legend(drawing, {*states.flat}, marks)
    return drawing


def _legend_mark(mark: LineStyle, meaning: str) -> 'Line2D':
    from matplotlib.lines import Line2D

    line = Line2D([], [], color=GREY, label=meaning)
    line.set(**mark)
    return line


def _draw_metric(
    axes: 'Axes',
    places: np.ndarray,
    names: Sequence[str],
    values: np.ndarray,
    engaged: np.ndarray,
    *,
    joined: bool,
) -> None:
    """
    Draw lines through engaged runs; a cross marks another run, at the edge if it is far away.

    Names have no order, so that runs at names are not `joined`: each has a short line of its own,
    by whose dash its controller is known. An engaged run without a value is a ring at the lower
    edge. `values` and `engaged` are (controllers, places).
    """
    low, high = _range(values[engaged], values)
    axes.set_ylim(low, high)
    for name, each, good in zip(names, values, engaged, strict=True):
        style = controller_style(name)
        style |= {'marker': style.get('marker', 'o'), 'markersize': 4.0, 'markevery': None}
        shown = np.where(good, each, np.nan)
        if joined:
            axes.plot(places, each, color=style['color'], linewidth=0.6, alpha=0.5)
            axes.plot(places, shown, label=name, **style)
        else:
            _draw_apart(axes, places, shown, name, style)
        at = np.clip(np.nan_to_num(each, nan=low), low, high)
        for mark, chosen in ((_CROSS, ~good), (_RING, good & ~np.isfinite(each))):
            if chosen.any():  # an empty line outside the clip makes the layout collapse
                axes.plot(places[chosen], at[chosen], color=style['color'], clip_on=False, **mark)


def _draw_apart(
    axes: 'Axes', places: np.ndarray, values: np.ndarray, name: str, style: LineStyle
) -> None:
    """Draw a mark for each of (n,) values, and through it a line that reaches no neighbour."""
    across = places[:, np.newaxis] + np.array([-_HALF_LINE, 0.0, _HALF_LINE, np.nan])
    up = np.repeat(values, across.shape[1])
    (line,) = axes.plot(across.ravel(), up, label=name, **style)
    line.set_markevery(slice(1, None, across.shape[1]))


def _draw_lanes(
    axes: 'Axes', places: np.ndarray, names: Sequence[str], states: np.ndarray
) -> None:
    """Draw the (controllers, places) states, a lane per controller, the first on top."""
    rows = np.arange(len(names))
    draw_states(axes, (edges_of(places), edges_of(rows.astype(float))), states.tolist())
    axes.set_yticks(rows, names)
    axes.invert_yaxis()
    axes.set_ylabel('state')


def _maps(sweep: Sweep, names: Sequence[str], states: np.ndarray) -> 'Figure':
    """Draw a map of states per controller, the first axis across, the second up."""
    from matplotlib.figure import Figure

    across, up = sweep.axes
    columns = min(_ACROSS, len(names))
    rows = -(-len(names) // columns)
    width = max(_MAP_IN * columns, 4.5)
    drawing = Figure(figsize=(width, _MAP_IN * rows + 1.1))
    drawing.suptitle(_title(sweep, names, width))
    panels = drawing.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
    edges = (edges_of(places_of(across)), edges_of(places_of(up)))
    for axes, name, each in zip(panels.flat, names, states, strict=False):
        draw_states(axes, edges, each.reshape(len(across.values), -1).T.tolist())
        axes.set_title(name)
        axes.label_outer()
    for axes in panels.flat[len(names) :]:
        axes.set_axis_off()
    for column in range(columns):
        lowest = panels[(len(names) - 1 - column) // columns, column]
        label_values(across, lowest.xaxis)
        lowest.xaxis.set_tick_params(labelbottom=True)
    for axes in panels[:, 0]:
        label_values(up, axes.yaxis)
    state_legend(drawing, {*states.flat})
    return drawing


def _range(engaged: np.ndarray, every: np.ndarray) -> tuple[float, float]:
    """Return the range of a panel: the values of engaged runs, and of others near them."""
    every, engaged = every[np.isfinite(every)], engaged[np.isfinite(engaged)]
    if len(engaged):
        low, high = np.min(engaged), np.max(engaged)
        far = _FARTHEST * max(high - low, 0.5 * abs(high))
        every = every[(every >= low - far) & (every <= high + far)]
    if not len(every):
        return 0.0, 1.0
    low, high = float(np.min(every)), float(np.max(every))
    margin = _MARGIN * (high - low) or 0.5 * abs(high) or 0.5
    return low - margin, high + margin
