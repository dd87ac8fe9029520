# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Runs of the charts, and the marks in charts: windows, times of the thesis, locks, releases."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from ddct_bringup.bag.run_facts import RunFacts
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.documents.palette import NEUTRAL, LineLook
from ddct_bringup.metrics.shift.course import ShiftCourse
from ddct_bringup.report.chart_signals import ChartSignal
from ddct_plant.base.timebase import steps_in, time_of_step
from ddct_plant.models.driveline import LOCK, RELEASE

if TYPE_CHECKING:
    from bokeh.models import ColumnDataSource
    from bokeh.models.renderers import DataRenderer, GlyphRenderer
    from bokeh.plotting import figure

_MARK_SPACING = 0.12
"""Distance between the marks of a line, as a share of the run."""
EVENT_MARKERS = {LOCK: 'triangle', RELEASE: 'inverted_triangle'}


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

    @cached_property
    def course(self) -> ShiftCourse | None:
        """Course of a gear shift; None for any other run, and one that ends before the shift."""
        if not self.trajectory.shift:
            return None
        start = steps_in('control_start_s', self.facts.control_start_s)
        course = ShiftCourse(self.trajectory, start)
        return course if course.begun else None


def mark_window(chart: 'figure', facts: RunFacts) -> None:
    """Mark the score window, and where control starts."""
    from bokeh.models.annotations import BoxAnnotation, Span

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
    chart: 'figure', quantity: ChartSignal, run: ChartRun, source: 'ColumnDataSource'
) -> None:
    """Draw the marks of a line that has some, at separate times for each run."""
    from bokeh.models import CDSView, IndexFilter

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
        color=run.look.colour,
    )
    switch(marks, [run])


def mark_thesis(chart: 'figure', runs: Sequence[ChartRun]) -> None:
    """Mark the times at which w_d reaches zero by Table 5.1."""
    for run in runs:
        if run.thesis_engagement_time_s is not None:
            mark = chart.scatter(
                [run.facts.control_start_s + run.thesis_engagement_time_s],
                [0.0],
                marker='diamond',
                size=13,
                fill_color=None,
                line_color=run.look.colour,
                line_width=2,
            )
            switch(mark, [run])


def mark_feedback(chart: 'figure', runs: Sequence[ChartRun]) -> None:
    """Mark where the inertia phase of gear shifts begins, and feedback with it."""
    from bokeh.models.annotations import Span

    courses = (run.course for run in runs)
    steps = {course.feedback_start for course in courses if course and course.handed_over}
    for step in sorted(steps):
        chart.add_layout(
            Span(
                location=time_of_step(step),
                dimension='height',
                line_color=NEUTRAL,
                line_dash=[6, 3],
                line_width=1.5,
            )
        )


def mark_events(chart: 'figure', runs: Sequence[ChartRun], side: str = '') -> None:
    """Mark locks and releases of a clutch where its slip is zero."""
    for run in runs:
        if getattr(run.trajectory, f'{side}clutch_phase') is not None:
            for mark in draw_events(chart, run.trajectory, 0.0, run.look.colour, side):
                switch(mark, [run])


def draw_events(
    chart: 'figure', run: Trajectory, height: float, colour: str, side: str = ''
) -> 'Iterator[GlyphRenderer[Any]]':
    """
    Mark the locks and releases of a clutch at a height of the chart, and yield the marks.

    `side` is the prefix of its signals.
    """
    periods = getattr(run, f'{side}phase_events')
    for kind, marker in EVENT_MARKERS.items():
        times = [each.time_s for events in periods for each in events if each.kind == kind]
        if times:
            yield chart.scatter(
                times,
                [height] * len(times),
                marker=marker,
                size=9,
                fill_color='#ffffff',
                line_color=colour,
                line_width=1.5,
            )


def switch(mark: 'DataRenderer', runs: Sequence[ChartRun], **tag: Any) -> None:
    """Let the page switch a mark with its runs, whose positions are in its tag."""
    mark.visible = any(run.shown for run in runs)
    mark.tags = [{'runs': [run.index for run in runs], **tag}]
