# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Chart of `limit`: the front of each metric over the lock time, with controllers on it."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ddct_bringup.documents.chart import Area, Chart, ChartAxis, Item, Line, Marks, Panel
from ddct_bringup.documents.page_parts import unit_text
from ddct_bringup.documents.palette import NEUTRAL, LineLook, looks, point_mark
from ddct_bringup.floor.front import ControllerRow
from ddct_bringup.floor.metric_units import METRICS
from ddct_bringup.floor.values import Floor

_HEADROOM = 8.0
"""Highest value shown over the median of the front; controllers beyond are at the upper edge."""


def front_chart(
    floors: Sequence[Floor],
    rows: Sequence[ControllerRow],
    title: str,
    counted_from: str = 'control start',
) -> Chart:
    """
    Return the chart with one panel for each metric, from floors and rows of controllers.

    Lock times count from the instant that `counted_from` names.
    """
    names = dict.fromkeys(row.controller for row in rows)
    points = {
        name: _Point(look.colour, point_mark(position))
        for position, (name, look) in enumerate(zip(names, looks(len(names)), strict=True))
    }
    across = ChartAxis(f'time from {counted_from} to the lock, s')
    panels = [
        _panel(
            metric,
            across,
            [floor for floor in floors if floor.metric == metric],
            _marks(rows, metric),
            points,
        )
        for metric in dict.fromkeys(floor.metric for floor in floors)
    ]
    return Chart(title, tuple(panels), same_x=True)


class _Point(NamedTuple):
    """Look of the points of a controller: colour and shape."""

    colour: str
    mark: str


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


def _panel(
    metric: str,
    across: ChartAxis,
    floors: Sequence[Floor],
    marks: Sequence[_Mark],
    points: dict[str, _Point],
) -> Panel:
    """Return the proven least as an edge of what is impossible, the attained values as circles."""
    times = np.array([floor.lock_time_s for floor in floors])
    least = np.array([np.nan if floor.least is None else floor.least for floor in floors])
    attained = np.array([np.nan if f.attained is None else f.attained for f in floors])
    values = [float(each) for each in (*least, *attained) if np.isfinite(each)]
    top = _HEADROOM * float(np.median(values)) if values else 1.0
    highest = max([*values, *(min(mark.value, top) for mark in marks)], default=1.0)
    ceiling = 1.1 * highest if highest > 0.0 else 1.0
    items: list[Item] = [
        Area(times, np.zeros(len(times)), least, 'no run can be here'),
        Line(times, least, LineLook(NEUTRAL), 'least, proven'),
        Marks(times, attained, NEUTRAL, 'attained by a run', filled=False, size=6.0),
    ]
    for mark in marks:
        point = points[mark.controller]
        items.append(
            Marks(
                np.array([mark.lock_time_s]),
                np.array([min(mark.value, ceiling)]),
                point.colour,
                mark.controller,
                point.mark,
                size=9.0,
                hint=f'{mark.controller}: {mark.value:.4g}',
                whole=True,
            )
        )
    label = f'{metric.replace("_", " ")}, {unit_text(METRICS[metric])}'
    return Panel(tuple(items), across, ChartAxis(label, (0.0, ceiling)))
