# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Map of the states of runs: coloured cells over values, one colour per state."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ddct_bringup.documents.chart import Cells, ChartAxis
from ddct_bringup.sweep.axis import Axis, value_text
from ddct_bringup.verdict.state import (
    ADDED,
    ENGAGED,
    FLARED,
    INVALID,
    LATE,
    NOT_ENGAGED,
    TIED_UP,
    WITHHELD,
)
from ddct_controllers.design.drawing.line_styles import BLACK, PURPLE, VERMILLION
from ddct_plant.models.engine_limits import OVER_REVVED, STALLED

STATE_COLOURS: Mapping[str, str] = {
    ENGAGED: '#d3e8f5',
    LATE: '#86b8dc',
    WITHHELD: PURPLE,
    ADDED: '#e3a6c9',
    NOT_ENGAGED: VERMILLION,
    STALLED: '#5c3a21',
    OVER_REVVED: '#7a0019',
    TIED_UP: '#3d3d3d',
    FLARED: '#b58900',
    INVALID: BLACK,
}
"""Colours by state: pale blue for engaged runs; darker is worse."""
_MOST_TICKS = 8


def state_cells(edges: tuple[np.ndarray, np.ndarray], states: Sequence[Sequence[str]]) -> Cells:
    """Return (m, n) states as cells between n + 1 edges across and m + 1 edges up."""
    return Cells(*edges, states, STATE_COLOURS)


def places_of(axis: Axis) -> np.ndarray:
    """Return the (n,) positions of an axis's values in the drawing; numbers at their value."""
    return np.array(axis.values, float) if axis.numeric else np.arange(len(axis.values))


def edges_of(places: np.ndarray) -> np.ndarray:
    """Return the (n + 1,) edges of cells around (n,) positions, midway between neighbours."""
    if len(places) == 1:
        return places[0] + np.array([-0.5, 0.5])
    middle = (places[1:] + places[:-1]) / 2.0
    return np.array([2.0 * places[0] - middle[0], *middle, 2.0 * places[-1] - middle[-1]])


def chart_axis(axis: Axis) -> ChartAxis:
    """Return the axis of a chart for an axis of a sweep; few values become the ticks."""
    ticks = None
    if not axis.numeric or len(axis.values) <= _MOST_TICKS:
        ticks = dict(zip(places_of(axis).tolist(), _tick_texts(axis.values), strict=True))
    return ChartAxis(axis.heading, ticks=ticks)


def _tick_texts(values: Sequence[Any]) -> list[str]:
    """Return numbers with four digits, or with all where four do not distinguish them."""
    short = [f'{each:.4g}' if type(each) is float else value_text(each) for each in values]
    return short if len(set(short)) == len(short) else [value_text(each) for each in values]
