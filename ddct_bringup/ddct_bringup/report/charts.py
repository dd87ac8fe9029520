"""The time charts of the page: one per signal, all runs in each, one time axis for all."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from bokeh.document import Document
from bokeh.models import ColumnDataSource, CrosshairTool, DataRange1d, HoverTool, Range1d
from bokeh.models.annotations import BoxAnnotation, Span
from bokeh.models.renderers import GlyphRenderer
from bokeh.plotting import figure

from ddct_bringup.bag.run_facts import RunFacts
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.report.run_marks import LIGHT_COLOURS, LineLook
from ddct_plant.base.units import rpm_from_rad_s

_HEIGHT_PX = 300
NEUTRAL = '#808080'
"""Readable on a light and on a dark page."""


@dataclass(frozen=True)
class Quantity:
    """What one chart shows."""

    key: str
    title: str
    symbol: str
    unit: str
    values: Callable[[Trajectory], np.ndarray]
    """(N+1,) in the unit."""


QUANTITIES = (
    Quantity('w_d', 'Slip speed', 'w_d', 'rpm', lambda run: rpm_from_rad_s(run.slip_speed)),
    Quantity(
        'error',
        'Slip error, reference less w_d',
        'e',
        'rpm',
        lambda run: rpm_from_rad_s(run.slip_reference[:, 0] - run.slip_speed),
    ),
    Quantity(
        'w_sr',
        'Torsion speed of the driveshaft',
        'w_sr',
        'rpm',
        lambda run: rpm_from_rad_s(run.joint_speed[:, 3]),
    ),
    Quantity('A_x', 'Vehicle acceleration', 'A_x', 'm/s²', lambda run: run.vehicle_accel),
    Quantity(
        'C_f_request', 'Clutch torque requested', 'C_f', 'N m', lambda run: run.torque_request
    ),
    Quantity(
        'C_f_actuator',
        'Clutch torque of the actuator',
        'C_f',
        'N m',
        lambda run: run.actuator_torque[:, 0],
    ),
    Quantity(
        'C_f_clutch',
        'Clutch torque with wear',
        'C_f',
        'N m',
        lambda run: run.clutch_torque[:, 0],
    ),
    Quantity('C_m', 'Engine torque', 'C_m', 'N m', lambda run: run.engine_torque),
)


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
    """Whether its lines are on when the page opens."""
    thesis_engagement_time_s: float | None = None
    """t_a of Table 5.1, where the run may be set beside it."""


def chart_document(runs: Sequence[ChartRun]) -> tuple[dict[str, Any], dict[str, str]]:
    """Return the Bokeh document as JSON, and per quantity the id of its chart in it."""
    time_axis = Range1d(start=0.0, end=max(run.trajectory.time_s[-1] for run in runs))
    cursor = Span(dimension='height', line_color=NEUTRAL, line_width=1)
    sources = [_source(run.trajectory) for run in runs]
    document = Document()
    roots = {}
    for quantity in QUANTITIES:
        chart = _chart(quantity, time_axis, cursor)
        _mark_phases(chart, runs[0].facts)
        lines = [
            _line(chart, quantity, run, source) for run, source in zip(runs, sources, strict=True)
        ]
        if quantity.key == 'w_d':
            _draw_references(chart, runs, sources)
            _mark_thesis(chart, runs)
        _add_hover(chart, quantity, lines)
        document.add_root(chart)
        roots[quantity.key] = str(chart.id)
    return dict(document.to_json(deferred=False)), roots


def _source(trajectory: Trajectory) -> ColumnDataSource:
    """Return what the charts show; single precision draws the same and halves the page."""
    columns = {quantity.key: quantity.values(trajectory) for quantity in QUANTITIES}
    columns['t'] = trajectory.time_s
    columns['reference'] = rpm_from_rad_s(trajectory.slip_reference[:, 0])
    return ColumnDataSource({key: values.astype(np.float32) for key, values in columns.items()})


def _chart(quantity: Quantity, time_axis: Range1d, cursor: Span) -> figure:
    chart = figure(
        height=_HEIGHT_PX,
        sizing_mode='stretch_width',
        x_range=time_axis,
        y_range=DataRange1d(only_visible=True),
        x_axis_label='time, s',
        y_axis_label=quantity.unit,
        tools='xbox_zoom,xpan,xwheel_zoom,reset,save',
        active_drag='xbox_zoom',
        active_scroll=None,
        window_axis='x',
        background_fill_color=None,
        border_fill_color=None,
        outline_line_color=None,
        min_border=6,
        name=quantity.key,
    )
    chart.toolbar.logo = None
    chart.xgrid.grid_line_color = None
    chart.axis.axis_label_text_font_style = 'normal'
    chart.axis.minor_tick_line_color = None
    chart.add_tools(CrosshairTool(overlay=cursor))
    return chart


def _mark_phases(chart: figure, facts: RunFacts) -> None:
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


def _line(
    chart: figure, quantity: Quantity, run: ChartRun, source: ColumnDataSource
) -> GlyphRenderer:
    line = chart.line(
        't',
        quantity.key,
        source=source,
        line_width=1.8,
        line_color=LIGHT_COLOURS[run.look.colour],
        line_dash=list(run.look.dash),
        name=run.label,
        visible=run.shown,
    )
    line.tags = [_tag(run)]
    return line


def _draw_references(
    chart: figure, runs: Sequence[ChartRun], sources: Sequence[ColumnDataSource]
) -> None:
    """Draw each distinct slip reference once; it shows while one of its runs does."""
    groups: dict[bytes, list[int]] = {}
    for position, source in enumerate(sources):
        groups.setdefault(np.asarray(source.data['reference']).tobytes(), []).append(position)
    for positions in groups.values():
        members = [runs[position] for position in positions]
        line = chart.line(
            't',
            'reference',
            source=sources[positions[0]],
            line_width=1.4,
            line_color=NEUTRAL,
            line_dash=[5, 4],
            visible=any(run.shown for run in members),
        )
        line.tags = [{'runs': [run.index for run in members], 'colour': None}]


def _mark_thesis(chart: figure, runs: Sequence[ChartRun]) -> None:
    """Mark where Table 5.1 has w_d reach zero."""
    for run in runs:
        if run.thesis_engagement_time_s is None:
            continue
        mark = chart.scatter(
            [run.facts.control_start_s + run.thesis_engagement_time_s],
            [0.0],
            marker='diamond',
            size=13,
            fill_color=None,
            line_color=LIGHT_COLOURS[run.look.colour],
            line_width=2,
            visible=run.shown,
        )
        mark.tags = [_tag(run)]


def _tag(run: ChartRun) -> dict[str, Any]:
    """Return what the page knows a line by: its runs, and its colour or None for the neutral."""
    return {'runs': [run.index], 'colour': run.look.colour}


def _add_hover(chart: figure, quantity: Quantity, lines: Sequence[GlyphRenderer]) -> None:
    chart.add_tools(
        HoverTool(
            renderers=list(lines),
            line_policy='nearest',
            tooltips=[
                ('', '$name'),
                ('time', '@t{0.00} s'),
                (quantity.symbol, f'@{{{quantity.key}}}{{0.000}} {quantity.unit}'),
            ],
        )
    )
