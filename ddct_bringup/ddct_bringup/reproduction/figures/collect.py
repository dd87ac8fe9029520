"""Which figures of the thesis can be drawn here, and why the others are not."""

from ddct_bringup.reproduction.figures.h_infinity_figures import H_INFINITY_FIGURES
from ddct_bringup.reproduction.figures.loop_shaping_figures import LOOP_SHAPING_FIGURES
from ddct_bringup.reproduction.figures.run_figures import RUN_FIGURES
from ddct_bringup.reproduction.figures.scenario_figures import SCENARIO_FIGURES
from ddct_bringup.reproduction.figures.specification_figures import SPECIFICATION_FIGURES
from ddct_bringup.reproduction.figures.thesis_figure import ThesisFigure, figure_order

FIGURES = (
    *SPECIFICATION_FIGURES,
    *LOOP_SHAPING_FIGURES,
    *H_INFINITY_FIGURES,
    *RUN_FIGURES,
    *SCENARIO_FIGURES,
)
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


def collect_figures() -> list[ThesisFigure]:
    """Return every figure that can be drawn, in order."""
    return sorted(FIGURES, key=lambda figure: figure_order(figure.number))


def figures_not_drawn() -> dict[str, str]:
    """Return, for every figure that cannot be drawn, the reason by its number, in order."""
    return {number: _NOT_DRAWN[number] for number in sorted(_NOT_DRAWN, key=figure_order)}
