# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Charts as files: PNG and SVG, and figures for Python, by matplotlib; pages by Bokeh.

Bokeh cannot write a picture without a browser.
"""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from ddct_bringup.documents.chart import (
    Area,
    Cells,
    Chart,
    ChartAxis,
    Item,
    Line,
    Marks,
    Panel,
    legend,
)
from ddct_bringup.documents.page import chart_page
from ddct_controllers.design.drawing.chart_style import (
    chart_style,
    headed,
    save_chart,
    typeset,
)
from ddct_controllers.design.drawing.line_styles import LineStyle, dash_style
from ddct_plant.files.output_file import write_text

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_WIDTH_IN, _WIDE_IN = 8.0, 11.0
"""Width of a figure with one column of panels, and with several."""
_PIXELS_PER_IN = 100.0
_LEGEND_COLUMNS = 5
_MOST_TICKS = 5
"""Largest number of ticks across a panel beside others: the labels of large values are wide."""
_MARKS = {
    'circle': 'o',
    'square': 's',
    'star': '*',
    'plus': 'P',
    'diamond': 'D',
    'triangle': '^',
    'inverted_triangle': 'v',
    'x': 'x',
}


def write_chart(chart: Chart, path: Path) -> None:
    """
    Write a chart as PNG, SVG or, by Bokeh, as a page, by the file's ending.

    Raise DdctError where the file cannot be written.
    """
    if path.suffix == '.html':
        write_text(str(path), chart_page(chart))
        return
    with chart_style():
        save_chart(matplotlib_figure(chart), path)


def matplotlib_figure(chart: Chart) -> 'Figure':
    """Return a chart as a figure of matplotlib, for a file, a notebook or a slide."""
    from matplotlib.figure import Figure

    with chart_style():
        rows = -(-len(chart.panels) // chart.columns)
        heights = [
            max(panel.height_px for panel in chart.panels[first : first + chart.columns])
            for first in range(0, len(chart.panels), chart.columns)
        ]
        width = _WIDTH_IN if chart.columns == 1 else _WIDE_IN
        keys = [(key.label, _handle(key.item)) for key in legend(chart)]
        below = 0.7 + 0.25 * -(-len(keys) // _LEGEND_COLUMNS)
        figure = Figure(figsize=(width, sum(heights) / _PIXELS_PER_IN + below))
        figure.suptitle(headed(chart.title, chart.conditions, width), fontsize=11)
        axes = figure.subplots(
            rows,
            chart.columns,
            squeeze=False,
            sharex=chart.same_x,
            sharey=chart.same_y,
            height_ratios=heights,
        )
        for each, panel in zip(axes.flat, chart.panels, strict=False):
            _draw_panel(each, panel)
            place = each.get_subplotspec()
            if chart.same_x and not place.is_last_row():
                each.set_xlabel('')
            if chart.same_y and not place.is_first_col():
                each.set_ylabel('')
            if chart.columns > 1 and not (panel.x.logarithmic or panel.x.ticks):
                each.locator_params(axis='x', nbins=_MOST_TICKS - 1)
        for each in axes.flat[len(chart.panels) :]:
            each.set_axis_off()
        if keys:
            labels, handles = zip(*keys, strict=True)
            figure.legend(handles, labels, ncols=_LEGEND_COLUMNS, loc='outside lower center')
    return figure


def _draw_panel(axes: 'Axes', panel: Panel) -> None:
    axes.set_title(panel.title)
    for item in panel.items:
        _draw(axes, item)
    _set_axis(axes.xaxis, panel.x, axes.set_xscale, axes.set_xlim)
    _set_axis(axes.yaxis, panel.y, axes.set_yscale, axes.set_ylim)
    if panel.downward:
        axes.invert_yaxis()


def _set_axis(which: Any, axis: ChartAxis, set_scale: Any, set_limits: Any) -> None:
    which.set_label_text(typeset(axis.label))
    if axis.logarithmic:
        set_scale('log')
    if axis.span:
        set_limits(*axis.span)
    if axis.ticks is not None:
        which.set_ticks(list(axis.ticks), list(axis.ticks.values()))


def _draw(axes: 'Axes', item: Item) -> None:
    if isinstance(item, Line):
        (drawn,) = axes.plot(item.x, item.y, label=item.label or None, **_line_style(item))
        drawn.set_drawstyle('steps-post' if item.steps else 'default')
        drawn.set_alpha(item.opacity)
    elif isinstance(item, Marks):
        (drawn,) = axes.plot(item.x, item.y, label=item.label or None, **_mark_style(item))
        drawn.set(alpha=item.opacity, clip_on=not item.whole)
    elif isinstance(item, Area):
        axes.fill_between(
            item.x, item.low, item.high, color=item.colour, alpha=item.opacity, linewidth=0.0
        )
    else:
        _draw_cells(axes, item)


def _line_style(item: Line) -> LineStyle:
    style: LineStyle = {
        'color': item.look.colour,
        'linestyle': dash_style(item.look.dash),
        'linewidth': 0.8 * item.width,
    }
    if item.look.mark:
        style |= {'marker': _MARKS[item.look.mark], 'markersize': 6.0, 'markevery': (0.06, 0.17)}
    return style


def _mark_style(item: Marks) -> LineStyle:
    return {
        'linestyle': 'none',
        'marker': _MARKS[item.mark],
        'color': item.colour,
        'markerfacecolor': item.colour if item.filled else 'none',
        'markersize': 0.8 * item.size,
        'zorder': 5.0,
    }


def _draw_cells(axes: 'Axes', item: Cells) -> None:
    from matplotlib.colors import ListedColormap

    names = list(item.colours)
    numbers = [[names.index(name) for name in row] for row in item.names]
    axes.pcolormesh(
        item.across,
        item.up,
        numbers,
        cmap=ListedColormap(list(item.colours.values())),
        vmin=-0.5,
        vmax=len(names) - 0.5,
        edgecolors='white',
        linewidth=0.4,
    )
    axes.grid(visible=False)


def _handle(item: Item) -> 'Artist':
    """Return what stands for an item in the legend."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    if isinstance(item, Line):
        line = Line2D([], [])
        line.set(**{**_line_style(item), 'markevery': None})
        return line
    if isinstance(item, Marks):
        line = Line2D([], [])
        line.set(**_mark_style(item))
        return line
    if isinstance(item, Area):
        return Patch(facecolor=item.colour, alpha=item.opacity)
    return Patch(facecolor=next(iter(item.colours.values())), edgecolor='#7f7f7f')
