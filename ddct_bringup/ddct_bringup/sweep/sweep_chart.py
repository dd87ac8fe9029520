# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Chart of `sweep`: metrics as lines over one key, states as maps over two."""

from collections.abc import Iterator, Sequence

import numpy as np

from ddct_bringup.campaign.rows import ScoredRow
from ddct_bringup.documents.chart import Chart, ChartAxis, Item, Line, Marks, Panel
from ddct_bringup.documents.page_parts import unit_text
from ddct_bringup.documents.palette import NEUTRAL, LineLook, looks
from ddct_bringup.sweep.state_map import chart_axis, edges_of, places_of, state_cells
from ddct_bringup.sweep.sweep import Sweep
from ddct_bringup.verdict.state import ENGAGED
from ddct_controllers.design.drawing.chart_style import controllers_text
from ddct_controllers.registry import controller_label
from ddct_plant.program.table import Quantity

_PANEL_PX, _LANE_PX, _LANES_PX, _MAP_PX = 230, 32, 60, 300
_ACROSS = 3
OTHER, NO_VALUE = 'other than engaged, at the edge without a value', 'engaged, no value'
"""Meanings of a cross and of a ring."""
_HALF_LINE = 0.3
"""Half of the length of the line of a run at a name, where names are 1 apart."""
_MARGIN = 0.08
"""Margin above and below the values shown, as a share of their range."""
_FARTHEST = 4.0
"""
Largest distance of a value shown at its place from those of engaged runs.

It applies to runs that are not engaged, in ranges of the engaged values or halves of their size: a
runaway would leave no room for the others.
"""


def sweep_chart(sweep: Sweep, runs: Sequence[ScoredRow], metrics: Sequence[Quantity]) -> Chart:
    """Return the chart of the runs of a sweep over one axis or two, in its order."""
    names = [controller_label(each) for each in sweep.controllers]
    title = f'{controllers_text(names)} {sweep.varied}'
    states = np.array([run.scores.state for run in runs]).reshape(len(names), -1)
    if len(sweep.axes) > 1:
        maps = _maps(sweep, names, states)
        columns = min(_ACROSS, len(names))
        return Chart(title, maps, sweep.conditions, columns, same_x=True, same_y=True)
    swept = sweep.axes[0]
    across, places = chart_axis(swept), places_of(swept)
    panels = [
        _metric_panel(
            figure,
            across,
            places,
            names,
            _values(runs, figure).reshape(states.shape),
            states == ENGAGED,
            joined=swept.numeric,
        )
        for figure in metrics
    ]
    panels.append(_lanes(across, places, names, states))
    return Chart(title, tuple(panels), sweep.conditions, same_x=True)


def _values(runs: Sequence[ScoredRow], figure: Quantity) -> np.ndarray:
    return np.array([run.scores.metrics[figure.key] for run in runs], dtype=float)


def _metric_panel(
    figure: Quantity,
    across: ChartAxis,
    places: np.ndarray,
    names: Sequence[str],
    values: np.ndarray,
    engaged: np.ndarray,
    *,
    joined: bool,
) -> Panel:
    """
    Return lines through engaged runs; a cross marks another run, at the edge if it is far away.

    Names have no order, so that runs at names are not `joined`: each has a short line of its own,
    by whose dash its controller is known. An engaged run without a value is a ring at the lower
    edge. `values` and `engaged` are (controllers, places).
    """
    low, high = _range(values[engaged], values)
    nothing = np.empty(0)
    items: list[Item] = [
        Marks(nothing, nothing, NEUTRAL, OTHER, 'x', size=9.0),
    ]
    if np.any(engaged & ~np.isfinite(values)):
        items.append(Marks(nothing, nothing, NEUTRAL, NO_VALUE, filled=False, size=9.0))
    for name, look, each, good in zip(names, looks(len(names)), values, engaged, strict=True):
        items += _of_controller(name, look, places, each, good, (low, high), joined=joined)
    label = ', '.join(filter(None, (figure.symbol, unit_text(figure.unit))))
    return Panel(tuple(items), across, ChartAxis(label, (low, high)), height_px=_PANEL_PX)


def _of_controller(
    name: str,
    look: LineLook,
    places: np.ndarray,
    values: np.ndarray,
    engaged: np.ndarray,
    span: tuple[float, float],
    *,
    joined: bool,
) -> Iterator[Item]:
    """Yield the line of a controller through its (n,) values, and the marks of its runs."""
    shown = np.where(engaged, values, np.nan)
    if joined:
        yield Line(places, values, LineLook(look.colour), width=0.8, opacity=0.5)
        yield Line(places, shown, look, name)
    else:
        apart = places[:, np.newaxis] + np.array([-_HALF_LINE, 0.0, _HALF_LINE, np.nan])
        yield Line(apart.ravel(), np.repeat(shown, apart.shape[1]), look, name)
    yield Marks(places, shown, look.colour, size=5.0, mark=look.mark or 'circle')
    at = np.clip(np.nan_to_num(values, nan=span[0]), *span)
    for chosen, meaning, mark in (
        (~engaged, OTHER, 'x'),
        (engaged & ~np.isfinite(values), NO_VALUE, 'circle'),
    ):
        if chosen.any():
            yield Marks(
                places[chosen],
                at[chosen],
                look.colour,
                mark=mark,
                filled=False,
                size=9.0,
                hint=f'{name}: {meaning}',
                whole=True,
            )


def _lanes(
    across: ChartAxis, places: np.ndarray, names: Sequence[str], states: np.ndarray
) -> Panel:
    """Return the (controllers, places) states, a lane per controller, the first on top."""
    rows = np.arange(len(names), dtype=float)
    cells = state_cells((edges_of(places), edges_of(rows)), states.tolist())
    ticks = dict(zip(rows.tolist(), names, strict=True))
    span = (-0.5, len(names) - 0.5)
    height = _LANES_PX + _LANE_PX * len(names)
    return Panel(
        (cells,), across, ChartAxis('state', span, ticks=ticks), '', height, downward=True
    )


def _maps(sweep: Sweep, names: Sequence[str], states: np.ndarray) -> tuple[Panel, ...]:
    """Return a map of states per controller, the first axis across, the second up."""
    across, up = sweep.axes
    edges = (edges_of(places_of(across)), edges_of(places_of(up)))
    return tuple(
        Panel(
            (state_cells(edges, each.reshape(len(across.values), -1).T.tolist()),),
            chart_axis(across),
            chart_axis(up),
            name,
            _MAP_PX,
        )
        for name, each in zip(names, states, strict=True)
    )


def _range(engaged: np.ndarray, every: np.ndarray) -> tuple[float, float]:
    """Return the range of a panel: the values of engaged runs, and of others near them."""
    every, engaged = every[np.isfinite(every)], engaged[np.isfinite(engaged)]
    if len(engaged):
        low, high = np.min(engaged), np.max(engaged)
        far = _FARTHEST * max(high - low, 0.5 * abs(high))
        every = every[(every >= low - far) & (every <= high + far)]
    if not len(every):
        return 0.0, 1.0
    low, high = float(np.min(every)), float(np.max(every))
    margin = _MARGIN * (high - low) or 0.5 * abs(high) or 0.5
    return low - margin, high + margin
