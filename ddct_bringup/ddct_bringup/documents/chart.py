# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
A chart as data: panels with lines, points, areas and cells.

It is drawn by Bokeh on pages (`bokeh_charts`), and by matplotlib into PNG and SVG files and for
Python (`chart_files`): Bokeh cannot write a file without a browser.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ddct_bringup.documents.palette import NEUTRAL, LineLook


@dataclass(frozen=True)
class ChartAxis:
    """One axis of a panel."""

    label: str = ''
    """Quantity with its unit."""
    span: tuple[float, float] | None = None
    """First and last value shown; None for all."""
    logarithmic: bool = False
    ticks: Mapping[float, str] | None = None
    """Text by place, where the axis has ticks of its own."""


@dataclass(frozen=True)
class Line:
    """A line through the points (x, y), each (n,); NaN is a gap."""

    x: np.ndarray
    y: np.ndarray
    look: LineLook
    label: str = ''
    """Name in the legend and at the pointer; empty for a line that the legend leaves out."""
    width: float = 1.8
    """Width in pixels."""
    opacity: float = 1.0
    steps: bool = False
    """Whether a value holds until the next one."""


@dataclass(frozen=True)
class Marks:
    """Marks at the points (x, y), each (n,)."""

    x: np.ndarray
    y: np.ndarray
    colour: str
    label: str = ''
    mark: str = 'circle'
    filled: bool = True
    size: float = 7.0
    """Diameter in pixels."""
    opacity: float = 1.0
    hint: str = ''
    """Text at the pointer, the label unless given."""
    whole: bool = False
    """Whether marks at the edge of the panel are drawn whole."""


@dataclass(frozen=True)
class Area:
    """The area between two lines over x, each (n,)."""

    x: np.ndarray
    low: np.ndarray
    high: np.ndarray
    label: str = ''
    colour: str = NEUTRAL
    opacity: float = 0.25


@dataclass(frozen=True)
class Cells:
    """A map of (m, n) names between n + 1 edges across and m + 1 edges up, a colour for each."""

    across: np.ndarray
    up: np.ndarray
    names: Sequence[Sequence[str]]
    colours: Mapping[str, str]
    """Colour by name; the legend has the names that occur, in this order."""


Item = Line | Marks | Area | Cells


@dataclass(frozen=True)
class Panel:
    """One coordinate system."""

    items: tuple[Item, ...]
    x: ChartAxis = field(default_factory=ChartAxis)
    y: ChartAxis = field(default_factory=ChartAxis)
    title: str = ''
    height_px: int = 260
    downward: bool = False
    """Whether the y axis goes down."""


@dataclass(frozen=True)
class Chart:
    """Panels with one title and one legend."""

    title: str
    panels: tuple[Panel, ...]
    conditions: str = ''
    """What all panels share, below the title."""
    columns: int = 1
    """Number of panels beside each other where there is room."""
    same_x: bool = False
    """Whether all panels have the same x axis."""
    same_y: bool = False


@dataclass(frozen=True)
class Key:
    """One entry of a legend: its text, and what it looks like."""

    label: str
    item: Item
    """Item of this label; of cells one with this colour alone."""


def legend(chart: Chart) -> Iterator[Key]:
    """Yield the entries of a chart's legend, each label once: lines and points, then cells."""
    items = [item for panel in chart.panels for item in panel.items]
    labels: set[str] = set()
    for item in items:
        if not isinstance(item, Cells) and item.label and item.label not in labels:
            labels.add(item.label)
            yield Key(item.label, item)
    cells = [item for item in items if isinstance(item, Cells)]
    found = {name for item in cells for row in item.names for name in row}
    for name, colour in {key: c for item in cells for key, c in item.colours.items()}.items():
        if name in found:
            one = Cells(np.empty(0), np.empty(0), [[name]], {name: colour})
            yield Key(name.replace('_', ' '), one)
