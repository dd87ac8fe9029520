"""What a figure of the thesis is here: its number, its subject and the function that draws it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ddct_controllers.design.drawing.chart_style import line_styles, new_chart
from ddct_controllers.design.drawing.charts import label_time_axis
from ddct_plant.base.errors import ParameterError


@dataclass(frozen=True)
class ThesisFigure:
    """One figure of the thesis that can be computed."""

    number: str
    """As the thesis has it, such as '2.10'."""
    title: str
    """What it shows."""
    draw_on: Callable[..., str]
    """Draws on one axes per panel; returns what agrees with the thesis and what does not."""
    panels: int = 1

    @property
    def heading(self) -> str:
        """The title with the figure's number."""
        return f'Figure {self.number}: {self.title}'

    def draw(self) -> tuple[Figure, str]:
        """Return the chart and the line about it."""
        figure, axes = new_chart(self.heading, self.panels)
        return figure, self.draw_on(*axes)


def figure_order(number: str) -> tuple[int, int]:
    """Return the chapter and the place of a number such as '2.10'; raise ParameterError."""
    chapter, _, place = number.partition('.')
    if not (chapter.isdecimal() and place.isdecimal()):
        raise ParameterError(f'figure {number!r}: give numbers such as 2.10, separated by commas')
    return int(chapter), int(place)


def draw_over_time(
    axes: Axes,
    quantity: str,
    range_s: tuple[float, float],
    lines: Mapping[str, tuple[np.ndarray, np.ndarray]],
    styles: Mapping[str, dict[str, Any]],
) -> None:
    """Draw (time, values) by name; lines without a style in `styles` get one after the other."""
    others = line_styles()
    for name, (time, values) in lines.items():
        axes.plot(time, values, label=name, **(styles.get(name) or next(others)))
    label_time_axis(axes, quantity, range_s)
