# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Runs of the charts, and the marks in charts: windows, times of the thesis, locks, releases."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from bokeh.models import CDSView, ColumnDataSource, IndexFilter
from bokeh.models.annotations import BoxAnnotation, Span
from bokeh.models.renderers import DataRenderer
from bokeh.plotting import figure

from ddct_bringup.bag.run_facts import RunFacts
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.report.chart_signals import ChartSignal
from ddct_bringup.report.phase_lanes import draw_events
from ddct_controllers.design.drawing.line_looks import LineLook

_MARK_SPACING = 0.12
"""Distance between the marks of a line, as a share of the run."""
NEUTRAL = '#808080'
"""Colour that is readable on a light and on a dark page."""


@dataclass(frozen=True)
class ChartRun:
    """One run of the charts."""

    index: int
    """Position in the report, by which the page switches its lines on and off."""
    label: str
    look: LineLook
    trajectory: Trajectory
    facts: RunFacts
    shown: bool
    """Whether the lines are visible when the page opens."""
    thesis_engagement_time_s: float | None = None
    """Engagement time t_a of Table 5.1 in s, where the run is comparable."""


def mark_window(chart: figure, facts: RunFacts) -> None:
    """Mark the score window and where feedback starts."""
    first, last = facts.score_window_s
    chart.add_layout(
        BoxAnnotation(left=first, right=last, fill_color=NEUTRAL, fill_alpha=0.10, line_color=None)
    )
    chart.add_layout(
        Span(
            location=facts.control_start_s,
            dimension='height',
            line_color=NEUTRAL,
            line_dash=[2, 3],
            line_width=1.5,
        )
    )


def mark_line(
    chart: figure, quantity: ChartSignal, run: ChartRun, source: ColumnDataSource
) -> None:
    """Draw the marks of a line that has some, at separate times for each run."""
    steps = len(run.trajectory.time_s)
    spacing = max(1, round(_MARK_SPACING * steps))
    first = round(0.37 * run.index % 1.0 * spacing)
    marks = chart.scatter(
        't',
        quantity.key,
        source=source,
        view=CDSView(filter=IndexFilter(indices=list(range(first, steps, spacing)))),
        marker=run.look.mark,
        size=8,
        line_width=1.5,
        line_color=run.look.light,
        fill_color=run.look.light if run.look.filled else None,
    )
    switch(marks, [run], fill=run.look.filled)


def mark_thesis(chart: figure, runs: Sequence[ChartRun]) -> None:
    """Mark the times at which w_d reaches zero by Table 5.1."""
    for run in runs:
        if run.thesis_engagement_time_s is not None:
            mark = chart.scatter(
                [run.facts.control_start_s + run.thesis_engagement_time_s],
                [0.0],
                marker='diamond',
                size=13,
                fill_color=None,
                line_color=run.look.light,
                line_width=2,
            )
            switch(mark, [run])


def mark_events(chart: figure, runs: Sequence[ChartRun]) -> None:
    """Mark locks and releases where the slip is zero."""
    for run in runs:
        if run.trajectory.clutch_phase is not None:
            for mark in draw_events(chart, run.trajectory, 0.0, run.look.light):
                switch(mark, [run])


def switch(mark: DataRenderer, runs: Sequence[ChartRun], **tag: Any) -> None:
    """Let the page switch a mark with its runs; its tag has their colour, or None if neutral."""
    mark.visible = any(run.shown for run in runs)
    mark.tags = [{'runs': [run.index for run in runs], 'colour': runs[0].look.colour, **tag}]
