# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Phases of a stick-slip clutch in charts: shaded time spans, and instants of lock and release."""

from collections.abc import Iterator
from typing import Any

from bokeh.models import ColumnDataSource
from bokeh.models.renderers import GlyphRenderer
from bokeh.plotting import figure

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.zero_slip import LOCKED, SLIPPING
from ddct_plant.models.driveline import LOCK, RELEASE

LANES = 'phases'
"""Name of the chart of the phases."""
OPACITY = {'open': 0.0, 'slipping': 0.3, 'locked': 0.85}
"""Opacity by phase, in the order of the phase numbers."""
EVENT_MARKERS = {LOCK: 'triangle', RELEASE: 'inverted_triangle'}
_PHASES = tuple(OPACITY)
_HALF_HEIGHT = 0.36
_AFTER = {LOCK: LOCKED, RELEASE: SLIPPING}
"""Phase after an event. A reversal changes no phase: the clutch may be open."""

Span = tuple[float, float, str]
"""Start and end of a phase in scenario time, s, and its name."""


def phase_spans(run: Trajectory) -> list[Span]:
    """
    Return the spans of a run with phases, without gaps from its start to its end.

    Locks and releases are at their exact instants, an opening or closing at the first tick with
    it.
    """
    time_s = run.time_s.tolist()
    changes = [(time_s[0], run.clutch_phase[0])]
    for time, phase, events in zip(time_s, run.clutch_phase, run.phase_events, strict=True):
        changes += [(each.time_s, _AFTER[each.kind]) for each in events if each.kind in _AFTER]
        if changes[-1][1] != phase:
            changes.append((time, phase))
    ends = [time for time, _ in changes[1:]] + [time_s[-1]]
    return [
        (begin, end, _PHASES[int(phase)])
        for (begin, phase), end in zip(changes, ends, strict=True)
        if end > begin
    ]


def draw_phases(chart: figure, run: Trajectory, lane: int, colour: str) -> 'GlyphRenderer[Any]':
    """Draw the spans as boxes around the height `lane`, more opaque for closer plates."""
    begins, ends, phases = zip(*phase_spans(run), strict=True)
    source = ColumnDataSource(
        {
            'left': list(begins),
            'right': list(ends),
            'phase': list(phases),
            'opacity': [OPACITY[phase] for phase in phases],
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


def draw_events(
    chart: figure, run: Trajectory, height: float, colour: str
) -> 'Iterator[GlyphRenderer[Any]]':
    """Mark the locks and releases of a run at a height of the chart, and yield the marks."""
    for kind, marker in EVENT_MARKERS.items():
        times = [
            each.time_s for events in run.phase_events for each in events if each.kind == kind
        ]
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
