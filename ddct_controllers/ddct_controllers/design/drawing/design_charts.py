"""The charts of a designed controller: Nyquist, Nichols with the bounds, step response."""

import math
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from ddct_controllers.design.analysis.loop_curve import LoopCurve
from ddct_controllers.design.analysis.loops import ContinuousLoop, continuous_loop, sampled_loop
from ddct_controllers.design.analysis.step_response import step_response
from ddct_controllers.design.drawing.chart_style import (
    BLACK,
    BOUND_LINE,
    ORANGE,
    chart_style,
    line_styles,
    new_chart,
    save_chart,
)
from ddct_controllers.design.drawing.charts import draw_nichols, draw_step_response
from ddct_controllers.design.loop_shaping.nichols import nichols_curve
from ddct_controllers.design.loop_shaping.specifications import TimeSpecifications
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace
from ddct_plant.models.parameters import DrivelineParameters

CHARTS = ('nyquist', 'nichols', 'step')
"""Each is written as NAME_<chart>.png."""
_STEP_RISE_TIMES = 8.0
"""Length of the step chart in rise times asked for."""


def chart_path(folder: Path, name: str, chart: str) -> Path:
    """Return where a chart of the controller called `name` goes."""
    return folder / f'{name}_{chart}.png'


def write_design_charts(
    folder: Path,
    name: str,
    controller: FactoredTransferFunction,
    sampled: StateSpace,
    specifications: TimeSpecifications,
    parameters: DrivelineParameters,
) -> None:
    """
    Draw the loop as designed and as run into `folder`; raise DdctError when it cannot be written.

    Both are shown: the continuous loop without delay, which the thesis judges, and that of the
    `sampled` controller with hold and delay.
    """
    loops: dict[str, ContinuousLoop | StateSpace] = {
        'continuous, no delay': continuous_loop(controller, parameters),
        'as run: sampled, hold and delay': sampled_loop(sampled, parameters),
    }
    curves = {label: LoopCurve(loop) for label, loop in loops.items()}
    duration_s = _STEP_RISE_TIMES * specifications.rise_time_s
    titles = {
        'nyquist': 'Nyquist plot around -1 + j0',
        'nichols': 'Nichols chart with the bounds S_p and T_p',
        'step': 'Step response of the closed loop',
    }
    with chart_style():
        for chart in CHARTS:
            figure, (axes,) = new_chart(f'{name}: {titles[chart]}')
            if chart == 'nyquist':
                _draw_nyquist(axes, curves, specifications)
            elif chart == 'nichols':
                charted = {label: nichols_curve(curve.values) for label, curve in curves.items()}
                draw_nichols(axes, charted, specifications)
            else:
                _draw_bounds(axes, specifications)
                draw_step_response(
                    axes,
                    {label: step_response(loop, duration_s) for label, loop in loops.items()},
                )
            save_chart(figure, chart_path(folder, name, chart))


def _draw_nyquist(
    axes: Axes, curves: dict[str, LoopCurve], specifications: TimeSpecifications
) -> None:
    for (label, curve), style in zip(curves.items(), line_styles(), strict=False):
        axes.plot(curve.values.real, curve.values.imag, label=label, **style)
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
