"""The charts of a designed controller: Nyquist, Nichols with the bounds, step response."""

import math
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from ddct_controllers.design.analysis.loop_curve import LoopCurve
from ddct_controllers.design.analysis.loops import ContinuousLoop, continuous_loop, sampled_loop
from ddct_controllers.design.analysis.step_response import step_response
from ddct_controllers.design.drawing.chart_files import save_figure
from ddct_controllers.design.drawing.chart_style import (
    BLACK,
    BOUND_LINE,
    ORANGE,
    chart_style,
    line_styles,
    new_chart,
)
from ddct_controllers.design.drawing.charts import draw_nichols, draw_step_response
from ddct_controllers.design.loop_shaping.nichols import nichols_curve
from ddct_controllers.design.loop_shaping.specifications import TimeSpecifications
from ddct_controllers.from_file.designed import DesignedController
from ddct_plant.linear.lti import StateSpace

_STEP_RISE_TIMES = 8.0
"""Length of the step chart in rise times asked for."""


def write_design_charts(
    folder: Path, designed: DesignedController, specifications: TimeSpecifications
) -> None:
    """
    Write NAME_nyquist, NAME_nichols and NAME_step as .png, .svg and .csv, or raise DdctError.

    The loop is shown as designed, continuous without delay, which the thesis judges, and as run:
    sampled with hold and delay.
    """
    loops: dict[str, ContinuousLoop | StateSpace] = {
        'continuous, no delay': continuous_loop(designed.transfer_function),
        'as run: sampled, hold and delay': sampled_loop(designed.sampled()),
    }
    curves = {label: LoopCurve(loop).values for label, loop in loops.items()}
    charted = {label: nichols_curve(values) for label, values in curves.items()}
    duration_s = _STEP_RISE_TIMES * specifications.rise_time_s
    responses = {label: step_response(loop, duration_s) for label, loop in loops.items()}
    with chart_style():
        nyquist, (axes,) = new_chart(f'{designed.name}: Nyquist plot around -1 + j0')
        _draw_nyquist(axes, curves, specifications)
        nichols, (axes,) = new_chart(f'{designed.name}: Nichols chart with the bounds S_p and T_p')
        draw_nichols(axes, charted, specifications)
        step, (axes,) = new_chart(f'{designed.name}: Step response of the closed loop')
        _draw_bounds(axes, specifications)
        draw_step_response(axes, responses)
        for chart, figure in (('nyquist', nyquist), ('nichols', nichols), ('step', step)):
            save_figure(figure, folder, f'{designed.name}_{chart}')


def _draw_nyquist(
    axes: Axes, curves: dict[str, np.ndarray], specifications: TimeSpecifications
) -> None:
    for (label, values), style in zip(curves.items(), line_styles(), strict=False):
        axes.plot(values.real, values.imag, label=label, **style)
    circle = np.exp(1j * np.linspace(0.0, math.tau, 361)) / specifications.sensitivity_peak - 1.0
    level = f'|S| = S_p = {specifications.sensitivity_peak:.2f}'
    axes.plot(circle.real, circle.imag, color=ORANGE, linestyle='--', label=level)
    axes.plot(-1.0, 0.0, '+', color=BLACK, markersize=11, markeredgewidth=2)
    axes.set(xlim=(-2.0, 1.0), ylim=(-1.75, 0.75), aspect='equal')
    axes.set(xlabel='Re L', ylabel='Im L')
    axes.legend(loc='upper right')


def _draw_bounds(axes: Axes, specifications: TimeSpecifications) -> None:
    highest = 1.0 + specifications.overshoot
    axes.axhline(highest, label='specifications', **BOUND_LINE)
    axes.axvline(specifications.rise_time_s, **BOUND_LINE)
