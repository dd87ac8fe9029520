# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Draw block diagrams as SVG: blocks, sums and points on a grid, and the signals between them."""

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

_UNIT = 20
"""Step of the grid in pixels."""
_HEIGHT = 2.4
_RADIUS = 0.7
_STYLE = """\
  <style>
    :root { color: #1f2933; }
    @media (prefers-color-scheme: dark) { :root { color: #dfe5ec; } }
    .box { fill: #3572b0; fill-opacity: .14; stroke: #3572b0; stroke-width: 1.6; }
    .sum { fill: none; stroke: currentColor; stroke-width: 1.4; }
    .dot { fill: currentColor; }
    text { fill: currentColor; text-anchor: middle; }
    .signal { font-style: italic; }
    .line { fill: none; stroke: currentColor; stroke-width: 1.3; }
    .tip { marker-end: url(#tip); }
  </style>
  <defs>
    <marker id="tip" viewBox="0 0 10 10" refX="9" refY="5" markerWidth="8" markerHeight="8"
        orient="auto"><path d="M0 0 L10 5 L0 10 z" fill="#8793a1"/></marker>
  </defs>
"""


@dataclass(frozen=True)
class Place:
    """Block with its text, sum, or end or branch of a signal, by its centre."""

    x: float
    y: float
    text: str = ''
    kind: str = 'box'
    """Kind of the place: box, sum, dot (a branch) or end (nothing is drawn)."""

    @property
    def half(self) -> tuple[float, float]:
        """Half of its width and half of its height."""
        if self.kind == 'box':
            return max(1.6, 0.165 * len(self.text) + 0.5), _HEIGHT / 2
        return (_RADIUS, _RADIUS) if self.kind == 'sum' else (0.0, 0.0)


@dataclass(frozen=True)
class Signal:
    """Arrow from one place to another, with at most one bend, with its name and sign."""

    source: str
    target: str
    name: str = ''
    sign: str = ''
    across_first: bool = True
    """Whether the arrow leaves its source horizontally, with the bend beside the source."""


def box(x: float, y: float, text: str) -> Place:
    """Return a block."""
    return Place(x, y, text)


def sum_at(x: float, y: float) -> Place:
    """Return a sum."""
    return Place(x, y, kind='sum')


def branch(x: float, y: float) -> Place:
    """Return the branch point of a signal."""
    return Place(x, y, kind='dot')


def end(x: float, y: float) -> Place:
    """Return the end of a signal."""
    return Place(x, y, kind='end')


def svg(title: str, places: dict[str, Place], signals: Sequence[Signal]) -> str:
    """Return the drawing of a diagram."""
    width = max(each.x + each.half[0] for each in places.values()) + 1
    height = max(each.y + each.half[1] for each in places.values()) + 1
    parts = [_drawn(each) for each in places.values()]
    parts += [_arrow(each, places[each.source], places[each.target]) for each in signals]
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_px(width)} {_px(height)}" '
        f'width="{_px(width)}" '
        f'font-family="Helvetica, Arial, sans-serif" font-size="13" role="img" '
        f'aria-label="{escape(title)}">\n{_STYLE}' + ''.join(f'  {part}\n' for part in parts)
    ) + '</svg>\n'


def _drawn(place: Place) -> str:
    x, y = _px(place.x), _px(place.y)
    if place.kind == 'sum':
        return f'<circle class="sum" cx="{x}" cy="{y}" r="{_px(_RADIUS)}"/>'
    if place.kind == 'dot':
        return f'<circle class="dot" cx="{x}" cy="{y}" r="2.5"/>'
    if place.kind == 'end':
        return ''
    half_x, half_y = place.half
    return (
        f'<rect class="box" x="{_px(place.x - half_x)}" y="{_px(place.y - half_y)}" '
        f'width="{_px(2 * half_x)}" height="{_px(2 * half_y)}" rx="6"/>'
        f'<text x="{x}" y="{_px(place.y + 0.22)}">{escape(place.text)}</text>'
    )


def _arrow(signal: Signal, source: Place, target: Place) -> str:
    straight = source.x == target.x or source.y == target.y
    bend = (target.x, source.y) if signal.across_first else (source.x, target.y)
    first = (target.x, target.y) if straight else bend
    last = (source.x, source.y) if straight else bend
    points = [_edge(source, first), *([] if straight else [bend]), _edge(target, last)]
    path = ' '.join(f'{_px(x)},{_px(y)}' for x, y in points)
    tip = '' if target.kind == 'dot' else ' tip'
    drawn = f'<polyline class="line{tip}" points="{path}"/>'
    if signal.name:
        (x, y), (to_x, to_y) = points[:2]
        level = y == to_y
        x, y = (x + to_x) / 2 + (0 if level else 1.1), (y + to_y) / 2 - (0.35 if level else -0.2)
        drawn += f'<text class="signal" x="{_px(x)}" y="{_px(y)}">{escape(signal.name)}</text>'
    if signal.sign:
        x, y = points[-1]
        from_left, from_above = x < target.x, y < target.y
        x += -0.4 if from_left else 0.5
        y += -0.3 if from_left or from_above else 0.7
        drawn += f'<text x="{_px(x)}" y="{_px(y)}">{signal.sign}</text>'
    return drawn


def _edge(place: Place, towards: tuple[float, float]) -> tuple[float, float]:
    """Return the point where a horizontal or vertical line from `place` leaves it."""
    half_x, half_y = place.half
    across, along = towards[0] - place.x, towards[1] - place.y
    if across:
        return place.x + (half_x if across > 0 else -half_x), place.y
    return place.x, place.y + (half_y if along > 0 else -half_y)


def _px(length: float) -> str:
    return f'{_UNIT * length:g}'
