"""The figure that `sweep` draws: metrics as lines over one value, states as maps over two."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing
from matplotlib.lines import Line2D

from ddct_bringup.report.typeset import unit_text
from ddct_bringup.scores.scoring import Entry
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
    GREY,
    chart_style,
    controller_style,
    save_chart,
)
from ddct_controllers.registry import controller_label
from ddct_plant.program.table import Figure

_WIDTH_IN, _PANEL_IN, _LANE_IN = 8.0, 2.3, 0.32
_MAP_IN, _ACROSS = 3.0, 3
_LEGEND_COLUMNS = 6
_MARK = {'linestyle': 'none', 'markersize': 7.0, 'markeredgewidth': 1.8, 'zorder': 5}
_CROSS: dict[str, Any] = {**_MARK, 'marker': 'x'}
_RING: dict[str, Any] = {**_MARK, 'marker': 'o', 'markerfacecolor': 'none'}
_MARKS_OF_RUNS = ((_CROSS, 'other than engaged'), (_RING, 'engaged, no value'))
_MARGIN = 0.08
"""Above and below the values shown, of their range."""
_FARTHEST = 4.0
"""
Of a value of a run that is not engaged from those of engaged runs, of their range or half their
size, to be shown at itself: one that runs away would leave no room for the others.
"""


def write_sweep_figure(
    sweep: Sweep, runs: Sequence[Entry], metrics: Sequence[Figure], path: Path
) -> None:
    """Write the figure as PNG or SVG by the file's ending; raise DdctError where it cannot be."""
    with chart_style():
        save_chart(sweep_figure(sweep, runs, metrics), path)


def sweep_figure(sweep: Sweep, runs: Sequence[Entry], metrics: Sequence[Figure]) -> Drawing:
    """Return the figure of the runs of a sweep over one axis or two, in its order."""
    names = [controller_label(each) for each in sweep.controllers]
    each = len(sweep.points)
    by_name = {
        name: list(runs[index * each : (index + 1) * each]) for index, name in enumerate(names)
    }
    return _lines(sweep, by_name, metrics) if len(sweep.axes) == 1 else _maps(sweep, by_name)


def _lines(
    sweep: Sweep, by_name: Mapping[str, Sequence[Entry]], metrics: Sequence[Figure]
) -> Drawing:
    lane = 0.5 + _LANE_IN * len(by_name)
    heights = [*(_PANEL_IN for _ in metrics), lane]
    drawing = Drawing(figsize=(_WIDTH_IN, sum(heights) + 0.8))
    panels = drawing.subplots(len(heights), sharex=True, height_ratios=heights)
    places = places_of(sweep.axes[0])
    for axes, figure in zip(panels, metrics, strict=False):
        _draw_metric(axes, places, by_name, figure)
    names = panels[0].get_legend_handles_labels()
    drawing.legend(*names, ncols=_LEGEND_COLUMNS, loc='outside upper center')
    _draw_lanes(panels[-1], places, by_name)
    label_values(sweep.axes[0], panels[-1].xaxis)
    marks = [Line2D([], [], color=GREY, label=meaning, **mark) for mark, meaning in _MARKS_OF_RUNS]
    state_legend(drawing, {_state(run) for runs in by_name.values() for run in runs}, marks)
    return drawing


def _draw_metric(
    axes: Axes, places: np.ndarray, by_name: Mapping[str, Sequence[Entry]], figure: Figure
) -> None:
    """
    Draw lines through engaged runs; a cross marks another, at the edge if it is far beyond.

    An engaged run without a value is a ring at the lower edge.
    """
    axes.set_ylabel(', '.join(filter(None, (figure.symbol, unit_text(figure.unit)))))
    values = {
        name: np.array([run['metrics'][figure.key] for run in runs], dtype=float)
        for name, runs in by_name.items()
    }
    engaged = {
        name: np.array([_state(run) == ENGAGED for run in runs]) for name, runs in by_name.items()
    }
    low, high = _range(
        np.concatenate([values[name][engaged[name]] for name in by_name]),
        np.concatenate(list(values.values())),
    )
    axes.set_ylim(low, high)
    for name, each in values.items():
        style = {'marker': 'o', **controller_style(name), 'markersize': 4.0, 'markevery': None}
        axes.plot(places, each, color=style['color'], linewidth=0.6, alpha=0.5)
        axes.plot(places, np.where(engaged[name], each, np.nan), label=name, **style)
        at = np.clip(np.nan_to_num(each, nan=low), low, high)
        for mark, chosen in (
            (_CROSS, ~engaged[name]),
            (_RING, engaged[name] & ~np.isfinite(each)),
        ):
            if chosen.any():  # an empty line beyond the clip would have the layout collapse
                axes.plot(places[chosen], at[chosen], color=style['color'], clip_on=False, **mark)


def _draw_lanes(axes: Axes, places: np.ndarray, by_name: Mapping[str, Sequence[Entry]]) -> None:
    """Draw the states, a lane per controller, the first on top."""
    rows = np.arange(len(by_name))
    states = [[_state(run) for run in runs] for runs in by_name.values()]
    draw_states(axes, (edges_of(places), edges_of(rows.astype(float))), states)
    axes.set_yticks(rows, list(by_name))
    axes.invert_yaxis()
    axes.set_ylabel('state')


def _maps(sweep: Sweep, by_name: Mapping[str, Sequence[Entry]]) -> Drawing:
    """Draw a map of states per controller, the first axis across, the second up."""
    across, up = sweep.axes
    columns = min(_ACROSS, len(by_name))
    rows = -(-len(by_name) // columns)
    drawing = Drawing(figsize=(max(_MAP_IN * columns, 4.5), _MAP_IN * rows + 0.6))
    panels = drawing.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
    edges = (edges_of(places_of(across)), edges_of(places_of(up)))
    for axes, (name, runs) in zip(panels.flat, by_name.items(), strict=False):
        states = np.array([_state(run) for run in runs]).reshape(len(across.values), -1).T
        draw_states(axes, edges, states.tolist())
        axes.set_title(name)
        axes.label_outer()
    for axes in panels.flat[len(by_name) :]:
        axes.set_axis_off()
    for column in range(columns):
        lowest = panels[(len(by_name) - 1 - column) // columns, column]
        label_values(across, lowest.xaxis)
        lowest.xaxis.set_tick_params(labelbottom=True)
    for axes in panels[:, 0]:
        label_values(up, axes.yaxis)
    state_legend(drawing, {_state(run) for runs in by_name.values() for run in runs})
    return drawing


def _state(run: Entry) -> str:
    return run['verdict']['state']


def _range(engaged: np.ndarray, every: np.ndarray) -> tuple[float, float]:
    """Return what a panel shows: the values of engaged runs, and of others near them."""
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
