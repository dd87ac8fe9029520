# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Figure of the thesis that can be computed, and kinds of figure that several chapters have."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ddct_controllers.design.analysis.loop_curve import LoopCurve
from ddct_controllers.design.analysis.loops import continuous_loop
from ddct_controllers.design.analysis.margins import loop_margins
from ddct_controllers.design.analysis.step_response import overshoot, rise_time_s, step_response
from ddct_controllers.design.drawing.chart_style import new_chart
from ddct_controllers.design.drawing.charts import (
    draw_nichols,
    draw_step_response,
    label_time_axis,
)
from ddct_controllers.design.drawing.line_styles import LineStyle, line_styles
from ddct_controllers.design.drawing.nichols import nichols_curve
from ddct_controllers.design.loop_shaping.specifications import TimeSpecifications
from ddct_controllers.design.loop_shaping.verification import contours
from ddct_plant.linear.lti import FactoredTransferFunction

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_STEP_DURATION_S = 4.0


@dataclass(frozen=True)
class ThesisFigure:
    """One figure of the thesis that can be computed."""

    number: str
    """Number as in the thesis, such as '2.10'."""
    title: str
    """Subject of the figure."""
    draw_on: Callable[..., str]
    """
    Function that draws on one axes per panel and returns a remark on the agreement with the
    thesis.
    """
    panels: int = 1

    @property
    def heading(self) -> str:
        """Title with the figure's number."""
        return f'Figure {self.number}: {self.title}'

    def draw(self) -> 'tuple[Figure, str]':
        """Return the drawing and the remark."""
        figure, axes = new_chart(self.heading, self.panels)
        return figure, self.draw_on(*axes)


def figure_order(number: str) -> tuple[int, int]:
    """Return the chapter and the position of a number such as '2.10'."""
    chapter, _, place = number.partition('.')
    return int(chapter), int(place)


def draw_over_time(
    axes: 'Axes',
    quantity: str,
    range_s: tuple[float, float],
    lines: Mapping[str, tuple[np.ndarray, np.ndarray]],
    styles: Mapping[str, LineStyle],
) -> None:
    """
    Draw (time, values) by name; lines without a style in `styles` get the next free one.

    None of these has the dash of a line in `styles`.
    """
    taken = [style.get('linestyle', '-') for style in styles.values()]
    others = (style for style in line_styles() if style['linestyle'] not in taken)
    for name, (time, values) in lines.items():
        axes.plot(time, values, label=name, **(styles.get(name) or next(others)))
    label_time_axis(axes, quantity, range_s)


def nichols_figure(
    number: str,
    title: str,
    *,
    name: str,
    controller: FactoredTransferFunction,
    specifications: TimeSpecifications,
    thesis_claim: str,
) -> ThesisFigure:
    """Return the Nichols chart of L, without hold and delay, with the bounds of its design."""

    def draw(axes: 'Axes') -> str:
        loop = continuous_loop(controller)
        curve = LoopCurve(loop)
        draw_nichols(axes, {name: nichols_curve(curve.values)}, specifications)
        margins = loop_margins(loop)
        if not margins.stable:
            return f'The closed loop is unstable. Thesis: {thesis_claim}.'
        crossed = [
            f'enters the {found.name} curve (peak {found.peak:.2f}, allowed {found.level:.2f})'
            for found in contours(curve, specifications)
            if not found.respected
        ]
        return (
            f'Crossover {margins.crossover_rad_s:.2f} rad/s, phase margin '
            f'{margins.phase_margin_deg:.0f}°, gain margin {margins.gain_margin_db:.0f} dB; L '
            f'{" and ".join(crossed) or "stays out of both curves"}. Thesis: {thesis_claim}.'
        )

    return ThesisFigure(number, title, draw)


def step_figure(
    number: str,
    title: str,
    *,
    name: str,
    controller: FactoredTransferFunction,
    printed: tuple[float, float],
) -> ThesisFigure:
    """Return the step response of one loop; `printed` are the thesis's t_r in s and overshoot."""

    def draw(axes: 'Axes') -> str:
        time, output = step_response(continuous_loop(controller), _STEP_DURATION_S)
        draw_step_response(axes, {name: (time, output)})
        return (
            f'Computed t_r = {rise_time_s(time, output):.2f} s and overshoot '
            f'{100.0 * overshoot(time, output):.0f} %; the thesis prints {printed[0]:.2f} s and '
            f'{100.0 * printed[1]:.0f} %.'
        )

    return ThesisFigure(number, title, draw)
