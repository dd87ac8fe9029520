# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Matplotlib keywords of lines: of a controller, of a reference, of a bound, of a curve.

The colours are distinct for colour-blind readers.
"""

from collections.abc import Iterator
from itertools import cycle
from typing import TYPE_CHECKING, TypedDict

from ddct_controllers.design.drawing.line_looks import DASHES, DOTS, LineLook, controller_look

if TYPE_CHECKING:
    from matplotlib.transforms import Transform

Dash = str | tuple[int, tuple[float, ...]]
"""Matplotlib's `linestyle`: its name, or offset with lengths of line and gap in line widths."""


class LineStyle(TypedDict, total=False):
    """Matplotlib keywords of one line."""

    color: str
    """Colour as #rrggbb."""
    linestyle: Dash
    linewidth: float
    """Width in points."""
    marker: str
    markersize: float
    """Size of a mark in points."""
    markevery: tuple[float, float] | None
    """First mark and distance of marks, as shares of the chart's diagonal; None for each point."""
    markerfacecolor: str
    markeredgewidth: float
    """Width of the edge of a mark in points."""
    zorder: float
    """Order of drawing; a larger one is in front."""
    transform: 'Transform'
    """Transform of the points, where it is not that of the axes' data."""


BLACK = '#000000'
GREY = '#7f7f7f'
BLUE = '#0072b2'
VERMILLION = '#d55e00'
GREEN = '#009e73'
PURPLE = '#cc79a7'
ORANGE = '#e69f00'
SKY = '#56b4e9'
_COLOURS = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY)
"""Colours of lines: the palette of Okabe and Ito without its yellow, which is faint on white."""
_DASHES = (DASHES[0], *DASHES[2:], DOTS)
"""
Dashes of lines, as lengths of line and gap in points, empty for a solid line.

There are as many as colours, so that lines differ in a grey print; none is the dash of references.
"""
REFERENCE_LINE: LineStyle = {'color': BLACK, 'linestyle': '--', 'linewidth': 1.3}
"""Matplotlib keywords of the line of a reference, which a signal should follow."""
BOUND_LINE: LineStyle = {'color': VERMILLION, 'linestyle': '--', 'linewidth': 1.6}
"""Matplotlib keywords of the line of a bound, which a signal should not exceed."""
LINE_WIDTH = 1.5
"""Width of a line in points; matplotlib's dash lengths are multiples of it."""
_MARKERS = {'circle': 'o', 'square': 's', 'star': '*', 'plus': 'P'}


def line_styles() -> Iterator[LineStyle]:
    """Yield matplotlib keywords of one line after the other, without end."""
    pairs = zip(cycle(_COLOURS), cycle(_DASHES), strict=False)
    return ({'color': colour, 'linestyle': dash_style(dash)} for colour, dash in pairs)


def dash_style(dash: tuple[int, ...]) -> Dash:
    """Return matplotlib's `linestyle` for these lengths of line and gap in points."""
    return (0, tuple(length / LINE_WIDTH for length in dash)) if dash else '-'


def controller_style(name: str, repeat: int = 0) -> LineStyle:
    """Return matplotlib keywords of a controller's line, see `controller_look`."""
    return look_style(controller_look(name, repeat))


def look_style(look: LineLook) -> LineStyle:
    """Return matplotlib keywords of a line with this look."""
    style: LineStyle = {'color': look.light, 'linestyle': dash_style(look.dash)}
    if look.mark:
        style |= {'marker': _MARKERS[look.mark], 'markersize': 6.0, 'markevery': (0.06, 0.17)}
        style['markerfacecolor'] = look.light if look.filled else 'white'
    return style
