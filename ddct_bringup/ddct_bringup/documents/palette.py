# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Looks of lines: the runs of a page get the first free ones, in order.

The colours are those of Okabe and Ito (`Colorblind` of Bokeh) and Paul Tol (`Bright`) that differ
for all kinds of colour vision, and that have enough contrast on a light and on a dark page.
"""

from dataclasses import dataclass
from itertools import cycle, islice, product

from markupsafe import Markup

from ddct_controllers.design.drawing.line_styles import COLOURS, DASHES

MARKS = ('circle', 'square', 'star', 'plus')
"""
Shapes of marks on a line, by Bokeh's names.

Triangles and diamonds are absent: they mark events and printed values.
"""
NEUTRAL = '#808080'
"""Colour of what belongs to no run. It is readable on a light and on a dark page."""
_MARK_PATHS = {
    'circle': 'M14 6a4 4 0 1 0 8 0a4 4 0 1 0 -8 0z',
    'square': 'M14.5 2.5h7v7h-7z',
    'star': 'M18 1l1.5 3.4 3.7 .3-2.8 2.4.9 3.6-3.3-1.9-3.3 1.9.9-3.6-2.8-2.4 3.7-.3z',
    'plus': 'M16.6 1.5h2.8v3.1h3.1v2.8h-3.1v3.1h-2.8v-3.1h-3.1v-2.8h3.1z',
    'diamond': 'M18 1l4 5-4 5-4-5z',
    'triangle': 'M18 1.5l4.6 8h-9.2z',
    'inverted_triangle': 'M18 10.5l4.6-8h-9.2z',
    'x': 'M14.5 2.5l7 7m0-7l-7 7',
}
"""SVG path of each mark, centred at (18, 6), in pixels."""


@dataclass(frozen=True)
class LineLook:
    """Look of a line: colour, dash and marks."""

    colour: str
    """Colour on every page, as #rrggbb."""
    dash: tuple[int, ...] = ()
    """Lengths of line and gap in pixels, one of `DASHES`; empty for a solid line."""
    mark: str = ''
    """Shape of the marks, one of `MARKS`; empty for a line without marks."""


_LOOKS = tuple(
    LineLook(colour, dash, mark) for mark, dash, colour in product(('', *MARKS), DASHES, COLOURS)
)
"""All looks: first the colours, solid; then the colours with each dash; then with marks too."""


def looks(count: int) -> list[LineLook]:
    """Return the looks of the lines of a page, in order; after 150 they start again."""
    return list(islice(cycle(_LOOKS), count))


def point_mark(position: int) -> str:
    """Return the shape of points without a line, by the position of their run from 0 on."""
    return MARKS[position // len(COLOURS) % len(MARKS)]


def sample_svg(look: LineLook) -> Markup:
    """Return a sample of the line, 36 by 12 pixels, as an SVG element."""
    dash = f' stroke-dasharray="{" ".join(map(str, look.dash))}"' if look.dash else ''
    line = f'<line x1="1" y1="6" x2="35" y2="6" stroke="{look.colour}"{dash}/>'
    return _sample(line + (mark_path(look.mark, look.colour) if look.mark else ''))


def mark_svg(mark: str, colour: str, *, filled: bool = True) -> Markup:
    """Return a sample of a mark without a line as an SVG element of the same size."""
    return _sample(mark_path(mark, colour, filled=filled))


def mark_path(mark: str, colour: str, *, filled: bool = True) -> str:
    """Return a mark as a path of the sample's SVG element."""
    fill = colour if filled else 'none'
    return f'<path d="{_MARK_PATHS[mark]}" stroke="{colour}" fill="{fill}"/>'


def patch_svg(colour: str, opacity: float = 1.0) -> Markup:
    """Return a sample of an area as an SVG element of the same size."""
    return _sample(
        f'<rect x="4" y="1" width="28" height="10" fill="{colour}" fill-opacity="{opacity:g}"/>'
    )


def _sample(shapes: str) -> Markup:
    return Markup(f'<svg class="sample" viewBox="0 0 36 12" aria-hidden="true">{shapes}</svg>')
