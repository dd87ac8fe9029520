"""Which figures of the thesis can be drawn here, and why the others are not."""

import importlib.metadata
from collections.abc import Iterable

from ddct_controllers.design.thesis_figures.h_infinity_figures import H_INFINITY_FIGURES
from ddct_controllers.design.thesis_figures.loop_shaping_figures import LOOP_SHAPING_FIGURES
from ddct_controllers.design.thesis_figures.specification_figures import SPECIFICATION_FIGURES
from ddct_controllers.design.thesis_figures.thesis_figure import ThesisFigure, figure_order
from ddct_controllers.entry_points import load_entry_point
from ddct_plant.errors import DdctError

ENTRY_POINT_GROUP = 'ddct.thesis_figures'
"""Other packages add a tuple of ThesisFigure here; ours need no closed-loop run."""
OWN_FIGURES = (*SPECIFICATION_FIGURES, *LOOP_SHAPING_FIGURES, *H_INFINITY_FIGURES)
"""Figures of this package."""
_LAST_FIGURES = {1: 27, 2: 28, 3: 19, 4: 8, 5: 1}
"""Number of figures by chapter."""
_PICTURE = 'a photograph or a scheme: nothing to compute'
_DIAGRAM = 'a block diagram: nothing to compute'
_NOT_DRAWN = {
    **{f'1.{place}': _PICTURE for place in range(1, 9)},
    **{f'1.{place}': _DIAGRAM for place in (9, 10, 11, 13, 15, 16, 17, *range(20, 23))},
    **{f'1.{place}': _DIAGRAM for place in range(24, 27)},
    '1.18': _PICTURE,
    '1.19': 'a table that names the driveline parameters without their values',
    **dict.fromkeys(('2.1', '3.1', '3.2', '3.4', '4.2'), _DIAGRAM),
    '4.1': 'explains the horizons: nothing to compute',
}
_LEFT_OUT = 'its package is not installed: build the workspace and source install/setup.bash'


def collect_figures() -> list[ThesisFigure]:
    """Return every figure that can be drawn, in order; raise DdctError for a bad entry point."""
    found = {figure.number: figure for figure in OWN_FIGURES}
    for point in importlib.metadata.entry_points(group=ENTRY_POINT_GROUP):
        for figure in _loaded(point):
            found.setdefault(figure.number, figure)
    return sorted(found.values(), key=lambda figure: figure_order(figure.number))


def figures_not_drawn(drawn: set[str]) -> dict[str, str]:
    """Return the reason by number, in order, for every figure of the thesis not in `drawn`."""
    return {
        number: _NOT_DRAWN.get(number, _LEFT_OUT)
        for chapter, last in _LAST_FIGURES.items()
        for number in (f'{chapter}.{place}' for place in range(1, last + 1))
        if number not in drawn
    }


def _loaded(point: importlib.metadata.EntryPoint) -> tuple[ThesisFigure, ...]:
    figures = load_entry_point(point, 'figures')
    if not isinstance(figures, Iterable) or not all(
        isinstance(figure, ThesisFigure) for figure in figures
    ):
        raise DdctError(f'figures {point.name!r}: {point.value} must be a tuple of ThesisFigure')
    return tuple(figures)
