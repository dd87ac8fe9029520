# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Distinct lines within one chart: no two lines have the same colour or the same dash.

A line keeps its colour and its dash unless another line of the chart has it. So a controller's
line changes between charts only where another line of the chart requires it.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import TypeVar

from ddct_controllers.design.drawing.line_looks import DASHES, DOTS, LIGHT_COLOURS
from ddct_controllers.design.drawing.line_styles import GREY, LINE_WIDTH, LineStyle, dash_style

_COLOURS = (*LIGHT_COLOURS, '#c77400', GREY)
_DASHES = (*DASHES, DOTS, (16, 3, 7, 3))
"""Dashes of lines, as lengths of line and gap in points; a page has them in pixels."""
_SOLID, _DASHED = DASHES[:2]
_NAMED: Mapping[str, tuple[int, ...]] = {'-': _SOLID, '--': _DASHED}
"""Dash for each named `linestyle` of matplotlib, whose dashed line is nearly ours."""
Part = TypeVar('Part')


def distinct_styles(styles: Mapping[str, LineStyle]) -> dict[str, LineStyle]:
    """
    Return matplotlib keywords of each line by name, with no colour and no dash used twice.

    Lines with matplotlib's own dash, such as a reference, choose first, then solid lines, then the
    others. Of more than eight lines the last keep their colour and dash; marks may distinguish
    them.
    """
    apart: dict[str, LineStyle] = {}
    own_colours = [style['color'] for style in styles.values()]
    own_dashes = list(map(_dash, styles.values()))
    for name in sorted(styles, key=lambda name: _rank(styles[name])):
        style, others = styles[name].copy(), apart.values()
        colours = [other['color'] for other in others]
        style['color'] = _free(style['color'], colours, _COLOURS, own_colours)
        dash = _free(_dash(style), list(map(_dash, others)), _DASHES, own_dashes)
        if dash != _dash(style):
            style['linestyle'] = dash_style(dash)
        if 'markerfacecolor' in style and style['markerfacecolor'] != 'white':
            style['markerfacecolor'] = style['color']
        apart[name] = style
    return {name: apart[name] for name in styles}


def _rank(style: LineStyle) -> int:
    if style.get('linestyle') == '--':
        return 0
    return 1 if _dash(style) == _SOLID else 2


def _dash(style: LineStyle) -> tuple[int, ...]:
    """Return the dash of a line, as lengths of line and gap in points."""
    line = style.get('linestyle', '-')
    if isinstance(line, str):
        return _NAMED[line]
    return tuple(round(LINE_WIDTH * each) for each in line[1])


def _free(
    own: Part, taken: Sequence[Part], choices: Iterable[Part], originals: Sequence[Part]
) -> Part:
    """
    Return a line's own colour or dash unless it is taken; otherwise the first free choice.

    Choices that are the original one of another line come last; without a free one it is `own`.
    """
    if own not in taken:
        return own
    free = [choice for choice in choices if choice not in taken]
    return next((choice for choice in free if choice not in originals), next(iter(free), own))
