# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Matplotlib keywords of lines: of a curve, of a reference, of a bound.

The colours are distinct for colour-blind readers, on a light and on a dark page.
"""

from collections.abc import Iterator
from itertools import cycle
from typing import TYPE_CHECKING, TypedDict

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
WINE = '#aa3377'
COLOURS = (BLUE, VERMILLION, GREEN, PURPLE, WINE)
"""
Colours of lines, in order, from the palettes of Okabe and Ito, and of Paul Tol (`Bright`).

They differ for all kinds of colour vision, with a contrast of 3 to a light and to a dark page.
"""
DASHES: tuple[tuple[int, ...], ...] = (
    (),
    (7, 3),
    (2, 2),
    (9, 3, 2, 3),
    (14, 4),
    (9, 3, 2, 3, 2, 3),
)
"""
Dashes of lines, as lengths of line and gap in pixels or points, empty for a solid line.

They distinguish lines in a grey print, and more lines than there are colours.
"""
_COLOURS_ON_PAPER = (*COLOURS, ORANGE, SKY)
_DASHES_ON_PAPER = (DASHES[0], *DASHES[2:], (2, 5), (16, 3, 7, 3))
"""As many dashes as colours, so that lines differ in a grey print; none is that of references."""
REFERENCE_LINE: LineStyle = {'color': BLACK, 'linestyle': '--', 'linewidth': 1.3}
"""Matplotlib keywords of the line of a reference, which a signal should follow."""
BOUND_LINE: LineStyle = {'color': VERMILLION, 'linestyle': '--', 'linewidth': 1.6}
"""Matplotlib keywords of the line of a bound, which a signal should not exceed."""
LINE_WIDTH = 1.5
"""Width of a line in points; matplotlib's dash lengths are multiples of it."""


def line_styles() -> Iterator[LineStyle]:
    """Yield matplotlib keywords of one line after the other, without end."""
    pairs = zip(cycle(_COLOURS_ON_PAPER), cycle(_DASHES_ON_PAPER), strict=False)
    return ({'color': colour, 'linestyle': dash_style(dash)} for colour, dash in pairs)


def dash_style(dash: tuple[int, ...]) -> Dash:
    """Return matplotlib's `linestyle` for these lengths of line and gap in points."""
    return (0, tuple(length / LINE_WIDTH for length in dash)) if dash else '-'
