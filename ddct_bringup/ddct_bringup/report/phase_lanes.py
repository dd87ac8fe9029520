# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The chart of the phases: a row for each clutch that sticks, and for each gear shift."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.documents.palette import NEUTRAL
from ddct_bringup.metrics.shift.course import ShiftCourse
from ddct_bringup.metrics.zero_slip import LOCKED, SLIPPING
from ddct_bringup.report.chart_marks import ChartRun, draw_events, switch
from ddct_bringup.report.shift_signals import OFF_GOING
from ddct_plant.base.timebase import time_of_step
from ddct_plant.models.driveline import LOCK, RELEASE

if TYPE_CHECKING:
    from bokeh.models.renderers import DataRenderer, GlyphRenderer
    from bokeh.plotting import figure

LANES = 'phases'
"""Name of the chart of the phases."""
OPACITY = {'open': 0.0, 'slipping': 0.3, 'locked': 0.85}
"""Opacity by phase, in the order of the phase numbers."""
TORQUE_PHASE, INERTIA_PHASE = 'torque phase', 'inertia phase'
SHIFT_OPACITY = {TORQUE_PHASE: 0.15, INERTIA_PHASE: 0.5}
"""Opacity by phase of a gear shift, in the order of time."""
_PHASES = tuple(OPACITY)
_HALF_HEIGHT = 0.36
_LANE_PX, _LANES_FRAME_PX = 28, 70
_MOST_WIDE, _NARROW_LANE_PX = 36, 16
"""Largest number of rows of full height, and the height in px of the rows of more."""
_AFTER = {LOCK: LOCKED, RELEASE: SLIPPING}
"""Phase after an event. A reversal changes no phase: the clutch may be open."""

PhaseSpan = tuple[float, float, str]
"""Start and end of a phase in scenario time, s, and its name."""


def phase_spans(run: Trajectory, side: str = '') -> list[PhaseSpan]:
    """
    Return the spans of a run with phases, without gaps from its start to its end.

    Locks and releases are at their exact instants, an opening or closing at the first tick with
    it. `side` is the prefix of the signals of the clutch.
    """
    time_s = run.time_s.tolist()
    phases, periods = (getattr(run, f'{side}{name}') for name in ('clutch_phase', 'phase_events'))
    changes = [(time_s[0], phases[0])]
    for time, phase, events in zip(time_s, phases, periods, strict=True):
        changes += [(each.time_s, _AFTER[each.kind]) for each in events if each.kind in _AFTER]
        if changes[-1][1] != phase:
            changes.append((time, phase))
    ends = [time for time, _ in changes[1:]] + [time_s[-1]]
    return [
        (begin, end, _PHASES[int(phase)])
        for (begin, phase), end in zip(changes, ends, strict=True)
        if end > begin
    ]


def shift_spans(course: ShiftCourse) -> list[PhaseSpan]:
    """
    Return the spans of the torque phase and the inertia phase of a gear shift.

    Where one does not end, it goes on to the end of the run.
    """
    end_s = time_of_step(course.trajectory.steps)
    start_s, share_s = time_of_step(course.start), time_of_step(course.feedback_start)
    torque = (start_s, min(share_s, end_s), TORQUE_PHASE)
    if not course.handed_over:
        return [torque]
    lock_s = float(course.lock_s)
    return [torque, (share_s, end_s if math.isnan(lock_s) else lock_s, INERTIA_PHASE)]


def draw_phases(
    chart: 'figure', spans: Sequence[PhaseSpan], lane: int, colour: str
) -> 'GlyphRenderer[Any]':
    """Draw the spans as boxes around the height `lane`, more opaque for closer plates."""
    from bokeh.models import ColumnDataSource

    begins, ends, phases = zip(*spans, strict=True)
    opacity = {**OPACITY, **SHIFT_OPACITY}
    source = ColumnDataSource(
        {
            'left': list(begins),
            'right': list(ends),
            'phase': list(phases),
            'opacity': [opacity[phase] for phase in phases],
        }
    )
    return chart.quad(
        left='left',
        right='right',
        bottom=lane + _HALF_HEIGHT,
        top=lane - _HALF_HEIGHT,
        source=source,
        fill_color=colour,
        fill_alpha='opacity',
        line_color=colour,
        line_width=1.0,
    )


@dataclass(frozen=True)
class _Lane:
    """One row of the chart of the phases."""

    label: str
    run: ChartRun
    spans: Sequence[PhaseSpan]
    side: str | None
    """Prefix of the signals of the clutch whose events are marked; None for none."""


def _lanes_of(run: ChartRun) -> list[_Lane]:
    """Return the rows of a run: its clutch, or in a gear shift the shift and both clutches."""
    on_coming = phase_spans(run.trajectory)
    if run.course is None:
        return [_Lane(run.label, run, on_coming, '')]
    return [
        _Lane(run.label, run, shift_spans(run.course), None),
        _Lane(f'{run.label}: on-coming', run, on_coming, ''),
        _Lane(f'{run.label}: off-going', run, phase_spans(run.trajectory, OFF_GOING), OFF_GOING),
    ]


def draw_lanes(chart: 'figure', runs: Sequence[ChartRun]) -> None:
    """Shade the phases of each run in rows of its own, with locks and releases."""
    from bokeh.models import HoverTool, Range1d

    lanes = [lane for run in runs for lane in _lanes_of(run)]
    height = _LANE_PX if len(lanes) <= _MOST_WIDE else _NARROW_LANE_PX
    chart.height = _LANES_FRAME_PX + height * len(lanes)
    chart.y_range = Range1d(start=len(lanes) - 0.5, end=-0.5)
    chart.yaxis.ticker = list(range(len(lanes)))
    chart.yaxis.major_label_overrides = {row: lane.label for row, lane in enumerate(lanes)}
    chart.ygrid.grid_line_color = None
    shades: list[DataRenderer] = []
    for row, lane in enumerate(lanes):
        shade = draw_phases(chart, lane.spans, row, lane.run.look.colour)
        shade.name = lane.label
        switch(shade, [lane.run])
        if lane.side is not None:
            for mark in draw_events(chart, lane.run.trajectory, row, NEUTRAL, lane.side):
                switch(mark, [lane.run])
        shades.append(shade)
    chart.add_tools(
        HoverTool(
            renderers=shades,
            tooltips=[('', '$name'), ('phase', '@phase'), ('', '@left{0.000} to @right{0.000} s')],
        )
    )
