# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Charts of a design: Nichols, Nyquist, step, magnitude; the files of a designed controller."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ddct_controllers.design.analysis.loop_curve import LoopCurve
from ddct_controllers.design.analysis.loops import (
    IDENTIFIED_DRIVELINE,
    ContinuousLoop,
    continuous_loop,
    sampled_loop,
)
from ddct_controllers.design.analysis.step_response import overshoot, rise_time_s, step_response
from ddct_controllers.design.drawing.chart_style import chart_style, new_chart, save_figure
from ddct_controllers.design.drawing.line_styles import (
    BLACK,
    BLUE,
    BOUND_LINE,
    DASHES,
    GREEN,
    GREY,
    ORANGE,
    REFERENCE_LINE,
    VERMILLION,
    dash_style,
    line_styles,
)
from ddct_controllers.design.drawing.nichols import (
    TURN_DEG,
    NicholsCurve,
    constant_m_curve,
    constant_s_curve,
    draw_nichols_grid,
    draw_turns,
    nichols_curve,
)
from ddct_controllers.design.loop_shaping.specifications import TimeSpecifications
from ddct_controllers.from_file.designed import DesignedController
from ddct_plant.linear.lti import StateSpace
from ddct_plant.models.actuator import PRINTED_ACTUATOR, ActuatorParameters
from ddct_plant.models.parameters import DrivelineParameters

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_PHASE_DEG, _MAGNITUDE_DB = (-360.0, 0.0), (-40.0, 40.0)
"""Ranges of open-loop phase in degrees and magnitude in dB of a Nichols chart."""
_BOUNDED_LINES = ((BLUE, DASHES[0]), (GREEN, DASHES[2]))
_STEP_RISE_TIMES = 8.0
"""Duration of the step chart as a multiple of the specified rise time."""


def draw_nichols(
    axes: 'Axes',
    curves: Mapping[str, NicholsCurve],
    specifications: TimeSpecifications,
) -> None:
    """
    Draw loops by name in a Nichols chart.

    The chart has the specifications' constant-|S| and constant-|T| curves, which L should not
    enter.
    """
    draw_nichols_grid(axes, _PHASE_DEG, _MAGNITUDE_DB)
    s_p, t_p = specifications.sensitivity_peak, specifications.complementary_peak
    for name, curve, colour, line in (
        (f'|S| = S_p = {s_p:.2f}', constant_s_curve(s_p), ORANGE, '-.'),
        (f'|T| = T_p = {t_p:.2f}', constant_m_curve(t_p), VERMILLION, '--'),
    ):
        draw_turns(axes, curve, _PHASE_DEG, name, color=colour, linestyle=line)
    for (name, curve), style in zip(curves.items(), line_styles(), strict=False):
        axes.plot(curve.phase_deg, curve.magnitude_db, label=name, **style)
    critical = np.arange(-180.0, _PHASE_DEG[0] - 1.0, -TURN_DEG)
    axes.plot(critical, 0.0 * critical, '+', color=BLACK, markersize=11, markeredgewidth=2)
    axes.axhline(0.0, color=GREY, linewidth=0.8)
    axes.set(xlim=_PHASE_DEG, ylim=_MAGNITUDE_DB)
    axes.set_xticks(np.arange(_PHASE_DEG[0], _PHASE_DEG[1] + 1.0, 45.0))
    axes.set(xlabel='Open-loop phase arg L, °', ylabel='Open-loop magnitude |L|, dB')
    axes.legend(loc='upper left')


def draw_step_response(
    axes: 'Axes',
    responses: Mapping[str, tuple[np.ndarray, np.ndarray]],
) -> None:
    """Draw (time, output) of unit steps by name, with rise time and overshoot in the legend."""
    drawn = zip(responses.items(), line_styles(), strict=False)
    for (name, (time, output)), style in drawn:
        rise = rise_time_s(time, output)
        values = f'overshoot {100.0 * overshoot(time, output):.1f} %'
        if rise is not None:
            values = f't_r = {rise:.2f} s, {values}'
            axes.plot(rise, 1.0, 'o', color=style['color'])
        axes.plot(time, output, label=f'{name}: {values}', **style)
        highest = int(np.argmax(output))
        axes.plot(time[highest], output[highest], 's', color=style['color'], markersize=5)
    axes.axhline(1.0, label='reference', **REFERENCE_LINE)
    longest = max(time[-1] for time, _ in responses.values())
    label_time_axis(axes, 'w_d / reference', (0.0, longest))


def draw_bound(
    axes: 'Axes',
    omega: np.ndarray,
    functions: Mapping[str, np.ndarray],
    bound: tuple[str, np.ndarray],
) -> None:
    """Draw functions by name in dB over frequency, and their bound, (name, values at omega)."""
    for (name, values), (colour, dash) in zip(functions.items(), _BOUNDED_LINES, strict=False):
        line = dash_style(dash)
        axes.semilogx(omega, decibel(values), color=colour, linestyle=line, label=name)
    bound_name, limits = bound
    axes.semilogx(omega, decibel(limits), label=bound_name, **BOUND_LINE)
    axes.set(xlim=(omega[0], omega[-1]), xlabel='Frequency, rad/s', ylabel='Magnitude, dB')
    axes.legend(loc='best')


def label_time_axis(axes: 'Axes', quantity: str, range_s: tuple[float, float]) -> None:
    """Label axes whose lines are drawn over time, and add the legend."""
    axes.set(xlim=range_s, xlabel='Time, s', ylabel=quantity)
    names = axes.get_legend_handles_labels()[1]
    axes.legend(ncols=2 if len(names) > 5 else 1)


def decibel(values: np.ndarray) -> np.ndarray:
    """Return 20 log10 |values|."""
    return 20.0 * np.log10(np.abs(values))


def write_design_charts(
    folder: Path,
    designed: DesignedController,
    specifications: TimeSpecifications,
    parameters: DrivelineParameters = IDENTIFIED_DRIVELINE,
    actuator: ActuatorParameters = PRINTED_ACTUATOR,
) -> None:
    """
    Write NAME_nyquist, NAME_nichols and NAME_step as .png, .svg and .csv, or raise DdctError.

    The charts have the loop as designed, which is continuous without delay and which the thesis
    judges, and as run: sampled, with hold and delay.
    """
    loops: dict[str, ContinuousLoop | StateSpace] = {
        'continuous, no delay': continuous_loop(designed.transfer_function, parameters),
        'as run: sampled, hold and delay': sampled_loop(
            designed.sampled(), parameters, actuator=actuator
        ),
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
        axes.axhline(1.0 + specifications.overshoot, label='specifications', **BOUND_LINE)
        axes.axvline(specifications.rise_time_s, **BOUND_LINE)
        draw_step_response(axes, responses)
        for chart, figure in (('nyquist', nyquist), ('nichols', nichols), ('step', step)):
            save_figure(figure, folder, f'{designed.name}_{chart}')


def _draw_nyquist(
    axes: 'Axes', curves: dict[str, np.ndarray], specifications: TimeSpecifications
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
