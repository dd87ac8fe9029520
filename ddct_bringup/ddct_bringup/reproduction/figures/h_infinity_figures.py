# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Figures 3.3 and 3.5 to 3.9: the uncertainty, S_n and T_n with their bounds, and G_c's loop."""

from functools import cache, partial
from typing import TYPE_CHECKING

import numpy as np
import scipy

from ddct_bringup.reproduction.figures.thesis_figure import (
    ThesisFigure,
    nichols_figure,
    step_figure,
)
from ddct_controllers.design.analysis.loops import (
    WEAR_RANGE,
    ContinuousLoop,
    continuous_loop,
    plant_in_rpm,
)
from ddct_controllers.design.drawing.charts import draw_bound
from ddct_controllers.design.drawing.line_styles import BLACK, BOUND_LINE, SKY, LineStyle
from ddct_controllers.design.h_infinity.recipes import PRINTED_WEIGHTS, THESIS_SPECIFICATIONS
from ddct_controllers.design.h_infinity.uncertainty import (
    PRINTED_W_U,
    WeightedNorms,
    relative_error,
    shortfall_from_rad_s,
    wear_family,
    weighted_norms,
)
from ddct_controllers.printed import H_INFINITY_CONTROLLERS
from ddct_plant.linear.lti import FactoredTransferFunction

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_G_C = H_INFINITY_CONTROLLERS['hinf1']
_W_S, _W_T = PRINTED_WEIGHTS.sensitivity, PRINTED_WEIGHTS.complementary
_ERROR_LINES: tuple[LineStyle, ...] = (
    {'color': SKY, 'linestyle': '-', 'linewidth': 4.0},
    {'color': BLACK, 'linestyle': ':'},
)
"""Line styles for the two ends of the wear, whose lines overlap."""
_PRINTED_SENSITIVITY_NORM = 0.97
_NORMS = {'W_s': 'sensitivity', 'W_t': 'complementary', 'W_u': 'uncertainty'}
"""Fields of `WeightedNorms` by weight: the peak of the weight times its function."""


def _loop(factor: float) -> ContinuousLoop:
    """Return the loop with a multiple of the printed G_c."""
    return continuous_loop(FactoredTransferFunction(factor) * _G_C)


def _norms(factor: float) -> WeightedNorms:
    return weighted_norms(_loop(factor), _W_S, _W_T, PRINTED_W_U)


@cache
def _gain_of_the_printed_norms() -> float:
    """Return the smallest factor on the gain that gives the printed norm of W_s S_n."""
    return scipy.optimize.brentq(
        lambda factor: _norms(factor).sensitivity - _PRINTED_SENSITIVITY_NORM, 1.0, 3.0, xtol=1e-6
    )


def _draw_bounded(
    axes: 'Axes', function: str, name: str, weight: FactoredTransferFunction, printed_norm: float
) -> str:
    """Draw S_n or T_n of the loop with G_c, and the bound: the inverse of the weight `name`."""
    omega = np.geomspace(0.01, 1000.0, 800)
    factor = _gain_of_the_printed_norms()
    curves, norms = {}, []
    for label, times in (('H∞1', 1.0), (f'{factor:.2f} H∞1', factor)):
        response = _loop(times).response(omega)
        numerator = 1.0 if function == 'S_n' else response
        curves[f'|{function}|, G_c = {label}'] = numerator / (1.0 + response)
        norms.append(getattr(_norms(times), _NORMS[name]))
    draw_bound(axes, omega, curves, (f'|{name}^-1|', 1.0 / weight.frequency_response(omega)))
    verdict = 'stays below' if norms[0] <= 1.0 else 'exceeds'
    return (
        f'{function} {verdict} its bound: the norm of {name} {function} is {norms[0]:.2f}, '
        f'printed is {printed_norm:g}. With {factor:.2f} times the printed gain, which gives the '
        f'printed norm of W_s S_n, it is {norms[1]:.2f}.'
    )


def _draw_uncertainty(axes: 'Axes') -> str:
    omega = np.geomspace(1.0, 1e6, 600)
    nominal, family = plant_in_rpm(), wear_family()
    for wear_gain, worn, style in zip(WEAR_RANGE, family, _ERROR_LINES, strict=True):
        error = relative_error(nominal, (worn,), omega)
        axes.semilogx(omega, error, label=f'error, K_usura = {wear_gain:g}', **style)
    weight = np.abs(PRINTED_W_U.frequency_response(omega))
    axes.semilogx(omega, weight, label='|W_u|', **BOUND_LINE)
    axes.set(xlim=(omega[0], omega[-1]), xlabel='Frequency, rad/s', ylabel='Magnitude')
    axes.legend(loc='lower left')
    highest = relative_error(nominal, family, omega)
    return (
        f'Both errors are {highest[0]:.2f} at all frequencies. |W_u| covers them up to '
        f'{shortfall_from_rad_s(PRINTED_W_U, float(highest.max())):.0f} rad/s; above it is up to '
        f'{100.0 * (1.0 - np.min(weight / highest)):.1f} % short of inequality (3.3).'
    )


H_INFINITY_FIGURES = (
    ThesisFigure('3.3', 'Errors by wear, and W_u', _draw_uncertainty),
    *(
        ThesisFigure(
            number,
            f'{function}(s) and its bound {name}^-1(s)',
            partial(_draw_bounded, function=function, name=name, weight=weight, printed_norm=norm),
        )
        for number, function, name, weight, norm in (
            ('3.5', 'S_n', 'W_s', _W_S.transfer_function(), _PRINTED_SENSITIVITY_NORM),
            ('3.6', 'T_n', 'W_t', _W_T.transfer_function(), 0.997),
            ('3.7', 'T_n', 'W_u', PRINTED_W_U, 0.32),
        )
    ),
    step_figure(
        *('3.8', 'Step response of the system with G_c(s)'),
        name='G_c = H∞1',
        controller=_G_C,
        printed=(0.3, 0.08),
    ),
    nichols_figure(
        *('3.9', 'Nichols plot with G_c(s)'),
        name='L with G_c = H∞1',
        controller=_G_C,
        specifications=THESIS_SPECIFICATIONS,
        thesis_claim='the requirements are met',
    ),
)
"""Figures of Section 3.2."""
