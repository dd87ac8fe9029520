# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Chart of the Pareto view: a mark for each run, whose figures the page's script chooses."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from markupsafe import Markup

from ddct_bringup.documents.bokeh_charts import styled_figure
from ddct_bringup.documents.palette import NEUTRAL, mark_svg, point_mark
from ddct_bringup.report.page_runs import PageRun
from ddct_bringup.report.pareto import ParetoView, pair_key
from ddct_bringup.verdict.state import ENGAGED

if TYPE_CHECKING:
    from bokeh.plotting import figure

PARETO = 'pareto'
"""Name of the chart."""
_HEIGHT_PX = 320


def pareto_chart(view: ParetoView, runs: Sequence[PageRun]) -> 'figure':
    """
    Return the chart of the default figures.

    A filled mark is an engaged run, a cross another one; a ring is around those that no other run
    dominates.
    """
    from bokeh.models import ColumnDataSource, HoverTool

    across, up = (view.figures[key] for key in view.default)
    front = view.fronts[pair_key(*view.default)]
    valid = [run for run in runs if run.scores.valid]
    source = ColumnDataSource(
        {
            'run': [run.index for run in valid],
            'x': [across.values.get(run.index, math.nan) for run in valid],
            'y': [up.values.get(run.index, math.nan) for run in valid],
            'ring': [float(run.index in front) for run in valid],
            'label': [run.label for run in valid],
            'state': [run.scores.state.replace('_', ' ') for run in valid],
            'colour': [run.look.colour for run in valid],
            'mark': [_mark(run) for run in valid],
        }
    )
    drawn = styled_figure(
        _HEIGHT_PX,
        tools='box_zoom,pan,reset,save',
        active_drag=None,
        window_axis='none',
        x_axis_label=across.title,
        y_axis_label=up.title,
        name=PARETO,
    )
    drawn.scatter(
        'x',
        'y',
        source=source,
        size=18,
        fill_color=None,
        line_color=NEUTRAL,
        line_width=2,
        line_alpha='ring',
    )
    marks = drawn.scatter(
        'x', 'y', source=source, marker='mark', size=10, color='colour', line_width=2
    )
    drawn.add_tools(
        HoverTool(
            renderers=[marks],
            tooltips=[('', '@label, @state'), ('across', '@x'), ('up', '@y')],
            visible=False,
        )
    )
    return drawn


def pareto_legend(runs: Sequence[PageRun]) -> dict[str, Markup]:
    """Return the samples of the marks by the labels of their runs."""
    return {run.label: mark_svg(_mark(run), run.look.colour) for run in runs if run.scores.valid}


def _mark(run: PageRun) -> str:
    return point_mark(run.index) if run.scores.state == ENGAGED else 'x'
