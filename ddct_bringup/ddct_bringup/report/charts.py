# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Time charts of the page: one per signal with all runs, on one time axis."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ddct_bringup.bag.run_facts import MEASURED
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.documents.bokeh_charts import PageCharts, styled_figure
from ddct_bringup.documents.palette import NEUTRAL
from ddct_bringup.report.chart_marks import (
    ChartRun,
    mark_events,
    mark_feedback,
    mark_line,
    mark_thesis,
    mark_window,
    switch,
)
from ddct_bringup.report.chart_signals import (
    CHART_SIGNALS,
    CLUTCH_SIGNALS,
    LOG_SIGNALS,
    SENSOR_SIGNALS,
    SHOWN_FIRST,
    ChartSignal,
)
from ddct_bringup.report.phase_lanes import LANES, draw_lanes
from ddct_bringup.report.shift_signals import OFF_GOING, SHIFT_SIGNALS
from ddct_plant.base.units import rpm_from_rad_s

if TYPE_CHECKING:
    from bokeh.models import ColumnDataSource, Range1d
    from bokeh.models.annotations import Span
    from bokeh.plotting import figure

_HEIGHT_PX = 300
FAINT = 0.6
"""Opacity of a thin line next to the line of its run."""
_SHADE = 0.2
"""Opacity of the area between the demand and an engine torque below it."""


def time_charts(runs: Sequence[ChartRun], page: PageCharts) -> list[str]:
    """Add the charts to a page at the places `chart-KEY`, and return their keys."""
    from bokeh.models import Range1d
    from bokeh.models.annotations import Span

    time_axis = Range1d(start=0.0, end=max(run.trajectory.time_s[-1] for run in runs))
    cursor = Span(dimension='height', line_color=NEUTRAL, line_width=1)
    drawn = _drawn(runs)
    sources = [_source(run, of) for run, of in zip(runs, drawn, strict=True)]
    charts = {}
    for quantity in charted_signals(runs):
        chart = _chart(quantity.key, quantity.unit, time_axis, cursor, runs)
        for run, source, of in zip(runs, sources, drawn, strict=True):
            if quantity in of:
                _line(chart, quantity, run, source)
        if quantity.key == 'w_d':
            _draw_shared(chart, runs, sources, 'reference')
            mark_thesis(chart, runs)
            mark_events(chart, runs)
        if quantity.key == 'C_m':
            _draw_shared(chart, runs, sources, 'demand')
            _shade_withheld(chart, runs, sources)
        if quantity.key == 'w_d1':
            mark_events(chart, runs, OFF_GOING)
        charts[quantity.key] = chart
    sticking = [run for run in runs if run.trajectory.clutch_phase is not None]
    if sticking:
        chart = _chart(LANES, '', time_axis, cursor, runs)
        draw_lanes(chart, sticking)
        charts[LANES] = chart
    for key, chart in charts.items():
        page.add_figure(f'chart-{key}', chart)
    return list(charts)


def charted_signals(runs: Sequence[ChartRun]) -> list[ChartSignal]:
    """Return the signals that at least one run has, in the order of the page."""
    return sorted(dict.fromkeys(each for of in _drawn(runs) for each in of), key=_place)


def chart_signals_of(trajectory: Trajectory, *, with_log: bool = False) -> tuple[ChartSignal, ...]:
    """Return the signals of a run that are drawn; `with_log`: it is a log or compared with one."""
    possible = (
        *CHART_SIGNALS,
        *(() if trajectory.clutch_phase is None else CLUTCH_SIGNALS),
        *(SHIFT_SIGNALS if trajectory.shift else ()),
        *(SENSOR_SIGNALS if trajectory.sensed else ()),
        *(LOG_SIGNALS if with_log else ()),
    )
    drawn = (
        each for each in dict.fromkeys(possible) if np.isfinite(each.values(trajectory)).any()
    )
    return tuple(sorted(drawn, key=_place))


def _place(signal: ChartSignal) -> int:
    """Return the place of a chart on the page: those of `SHOWN_FIRST`, then the others."""
    return SHOWN_FIRST.index(signal.key) if signal.key in SHOWN_FIRST else len(SHOWN_FIRST)


def dashed_lines(runs: Sequence[ChartRun]) -> list[str]:
    """Return the names of the dashed lines that some run has; only some logs have a reference."""
    signals = {'reference': 'slip_reference', 'demand': 'torque_demand'}
    return [
        name
        for name, signal in signals.items()
        if any(np.isfinite(run.trajectory.at_tick(signal)).any() for run in runs)
    ]


def _drawn(runs: Sequence[ChartRun]) -> list[tuple[ChartSignal, ...]]:
    """Return the drawn signals of each run; next to a log also those of a log."""
    with_log = any(run.facts.mode == MEASURED for run in runs)
    return [chart_signals_of(run.trajectory, with_log=with_log) for run in runs]


def _source(run: ChartRun, quantities: Sequence[ChartSignal]) -> 'ColumnDataSource':
    """Return the data of the charts; single precision draws the same and halves the page."""
    from bokeh.models import ColumnDataSource

    trajectory = run.trajectory
    columns = {'t': trajectory.time_s}
    for quantity in quantities:
        columns[quantity.key] = quantity.values(trajectory)
        if quantity.thin:
            columns[quantity.thin_key] = quantity.thin(trajectory)
    columns['reference'] = rpm_from_rad_s(trajectory.at_tick('slip_reference'))
    columns['demand'] = trajectory.torque_demand
    controlled = trajectory.time_s >= run.facts.control_start_s
    withheld = np.where(controlled, trajectory.torque_demand - trajectory.engine_torque, 0.0)
    columns['with_withheld'] = trajectory.engine_torque + np.fmax(withheld, 0.0)
    return ColumnDataSource({key: values.astype(np.float32) for key, values in columns.items()})


def _chart(
    key: str, unit: str, time_axis: 'Range1d', cursor: 'Span', runs: Sequence[ChartRun]
) -> 'figure':
    from bokeh.models import CrosshairTool, DataRange1d

    chart = styled_figure(
        _HEIGHT_PX,
        x_range=time_axis,
        y_range=DataRange1d(only_visible=True),
        x_axis_label='time, s',
        y_axis_label=unit,
        name=key,
    )
    chart.add_tools(CrosshairTool(overlay=cursor))
    mark_window(chart, runs[0].facts)
    mark_feedback(chart, runs)
    return chart


def _line(
    chart: 'figure', quantity: ChartSignal, run: ChartRun, source: 'ColumnDataSource'
) -> None:
    line = chart.line(
        't',
        quantity.key,
        source=source,
        line_width=1.8,
        line_color=run.look.colour,
        line_dash=list(run.look.dash),
        name=run.label,
    )
    switch(line, [run])
    if run.look.mark:
        mark_line(chart, quantity, run, source)
    if quantity.thin:
        thin = chart.line(
            't',
            quantity.thin_key,
            source=source,
            line_width=1.0,
            line_alpha=FAINT,
            line_color=run.look.colour,
        )
        switch(thin, [run], alpha=FAINT)


def _draw_shared(
    chart: 'figure', runs: Sequence[ChartRun], sources: 'Sequence[ColumnDataSource]', column: str
) -> None:
    """Draw each distinct line of a column once; it is visible while one of its runs is."""
    groups: dict[bytes, list[int]] = {}
    for position, source in enumerate(sources):
        values = np.asarray(source.data[column])
        if np.isfinite(values).any():
            groups.setdefault(values.tobytes(), []).append(position)
    for positions in groups.values():
        members = [runs[position] for position in positions]
        line = chart.line(
            't',
            column,
            source=sources[positions[0]],
            line_width=1.4,
            line_color=NEUTRAL,
            line_dash=[5, 4],
        )
        switch(line, members)


def _shade_withheld(
    chart: 'figure', runs: Sequence[ChartRun], sources: 'Sequence[ColumnDataSource]'
) -> None:
    """Shade what C_m lacks of the demand from control start on, as `torque_late_s` counts it."""
    for run, source in zip(runs, sources, strict=True):
        if 'C_m' not in source.data:
            continue
        area = chart.varea(
            't',
            'C_m',
            'with_withheld',
            source=source,
            fill_color=run.look.colour,
            fill_alpha=_SHADE,
        )
        switch(area, [run], area=True, alpha=_SHADE)
