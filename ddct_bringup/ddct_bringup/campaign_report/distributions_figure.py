# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Figure of a campaign: distributions of the main metrics, a curve for each controller."""

from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING

import numpy as np

from ddct_bringup.campaign_report.results import Group, Results
from ddct_bringup.documents.page_parts import unit_text
from ddct_bringup.metrics.catalogue import FIGURES, TABLE_5_1
from ddct_bringup.verdict.state import ENGAGED, INVALID
from ddct_controllers.design.drawing.chart_style import chart_style, save_chart
from ddct_controllers.design.drawing.line_looks import looks_of
from ddct_controllers.design.drawing.line_styles import LineStyle, look_style
from ddct_plant.program.table import Quantity

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_ACROSS = 3
_WIDTH_IN, _PANEL_IN, _LINE_IN = 11.0, 2.7, 0.25
_LEGEND_COLUMNS = 5
_TITLE_CHARACTERS = 120
"""Largest number of characters in a line of the title."""
_MOST_TICKS = 5
"""Largest number of ticks of an x axis, so that the labels of large values do not overlap."""
_MOST_STEPS = 500
"""Largest number of steps of a curve: more cannot be distinguished."""


def write_distributions(results: Results, scenario: str, path: Path) -> None:
    """Write the figure as PNG or SVG by the file's extension; raise DdctError where that fails."""
    with chart_style():
        save_chart(distributions_figure(results, scenario), path)


def distributions_figure(results: Results, scenario: str) -> 'Figure':
    """
    Return the figure: a panel for each main metric, a curve for each controller.

    A curve is the share of the valid runs that engaged with at most this value. It ends at the
    share of the runs that engaged and have a value; the rest up to 1 failed, or has no value.
    """
    from matplotlib.figure import Figure

    metrics = [each for each in (*TABLE_5_1, *FIGURES) if each in results.quantities]
    rows = max(1, -(-len(metrics) // _ACROSS))
    legend = -(-len(results.groups) // _LEGEND_COLUMNS)
    figure = Figure(figsize=(_WIDTH_IN, _PANEL_IN * rows + _LINE_IN * legend + 1.1))
    figure.suptitle(f'{_title(results, scenario)}\n{_conditions(results)}', fontsize=11)
    panels = figure.subplots(rows, _ACROSS, squeeze=False, sharey=True)
    looks = looks_of(group.names['controller'] for group in results.groups)
    for axes, quantity in zip(panels.flat, metrics, strict=False):
        for group, look in zip(results.groups, looks, strict=True):
            _draw(axes, results, group, quantity, look_style(look))
        axes.set_xlabel(', '.join(filter(None, (quantity.symbol, unit_text(quantity.unit)))))
        axes.locator_params(axis='x', nbins=_MOST_TICKS - 1)
        axes.set_ylim(0.0, 1.02)
    for axes in panels[:, 0]:
        axes.set_ylabel('share of valid runs')
    for axes in panels.flat[len(metrics) :]:
        axes.set_axis_off()
    if metrics:
        lines = panels[0, 0].get_legend_handles_labels()
        figure.legend(*lines, ncols=_LEGEND_COLUMNS, loc='outside lower center')
    return figure


def _title(results: Results, scenario: str) -> str:
    varied = ', '.join([*results.grid, *results.random])
    return fill(f'Scenario {scenario}: {results.rows} runs over {varied}', _TITLE_CHARACTERS)


def _conditions(results: Results) -> str:
    kind = 'random samples' if results.random else 'points of a grid, not chances'
    return f'share of the valid runs that engaged with at most this value ({kind})'


def _draw(
    axes: 'Axes', results: Results, group: Group, quantity: Quantity, style: LineStyle
) -> None:
    """Draw one curve; a controller without an engaged run has a line at zero."""
    outcomes = results.outcomes[group.rows]
    values = results.columns[quantity.key][group.rows]
    taken = np.sort(values[(outcomes == ENGAGED) & ~np.isnan(values)])
    valid = max(int(np.sum(outcomes != INVALID)), 1)
    if not len(taken):
        axes.plot([], [], label=group.label, **style)
        return
    shares = np.arange(1, len(taken) + 1) / valid
    if len(taken) > _MOST_STEPS:
        kept = np.unique(np.linspace(0, len(taken) - 1, _MOST_STEPS).round().astype(int))
        taken, shares = taken[kept], shares[kept]
    steps = np.concatenate([taken[:1], taken]), np.concatenate([[0.0], shares])
    axes.plot(*steps, drawstyle='steps-post', label=group.label, **style)
