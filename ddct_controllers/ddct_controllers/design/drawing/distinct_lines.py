"""
Lines of one chart that no two share: each has a colour and a dash of its own.

A line keeps what it has where no other has it, so a controller looks alike from chart to chart as
far as its neighbours let it.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, TypeVar

from ddct_controllers.design.drawing.chart_style import GREY, LINE_WIDTH, dash_style
from ddct_controllers.design.drawing.line_looks import DASHES, DOTS, LIGHT_COLOURS

_COLOURS = (*LIGHT_COLOURS, '#c77400', GREY)
_DASHES = (*DASHES, DOTS, (16, 3, 7, 3))
"""Lengths of line and gap in points, as on the screen in pixels."""
_SOLID, _DASHED = DASHES[:2]
_NAMED: Mapping[Any, tuple[int, ...]] = {'-': _SOLID, '--': _DASHED}
"""What matplotlib has names for; its dashed line is much like ours."""
Part = TypeVar('Part')


def told_apart(styles: Mapping[str, Mapping[str, Any]]) -> dict[str, dict[str, Any]]:
    """
    Return the keywords of each line by name, with neither colour nor dash twice.

    What is dashed by its kind, as a reference, goes first, then solid lines, then the others. Of
    more than eight lines the last keep what they have; marks may tell them apart.
    """
    apart: dict[str, dict[str, Any]] = {}
    own_colours = [style['color'] for style in styles.values()]
    own_dashes = list(map(_dash, styles.values()))
    for name in sorted(styles, key=lambda name: _rank(styles[name])):
        style, others = dict(styles[name]), apart.values()
        colours = [other['color'] for other in others]
        style['color'] = _free(style['color'], colours, _COLOURS, own_colours)
        dash = _free(_dash(style), list(map(_dash, others)), _DASHES, own_dashes)
        if dash != _dash(style):
            style['linestyle'] = dash_style(dash)
        if 'markerfacecolor' in style and style['markerfacecolor'] != 'white':
            style['markerfacecolor'] = style['color']
        apart[name] = style
    return {name: apart[name] for name in styles}


def _rank(style: Mapping[str, Any]) -> int:
    if style.get('linestyle') == '--':
        return 0
    return 1 if _dash(style) == _SOLID else 2


def _dash(style: Mapping[str, Any]) -> tuple[int, ...]:
    """Return the dash of a line in points."""
    line = style.get('linestyle', '-')
    return _NAMED[line] if line in _NAMED else tuple(round(LINE_WIDTH * each) for each in line[1])


def _free(
    own: Part, taken: Sequence[Part], choices: Iterable[Part], wanted: Sequence[Part]
) -> Part:
    """Return what a line has if it is free, else the first that is, best one that none wants."""
    if own not in taken:
        return own
    free = [choice for choice in choices if choice not in taken]
    return next((choice for choice in free if choice not in wanted), next(iter(free), own))
