# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Figures 2.2 to 2.10: from the specifications to the loops of the loop-shaping design.

They are the prototype's rise time, the sign of K_c, the two networks, and L of each step.
"""

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from ddct_bringup.reproduction.figures.thesis_figure import (
    ThesisFigure,
    nichols_figure,
    step_figure,
)
from ddct_controllers.design.analysis.loops import continuous_loop
from ddct_controllers.design.analysis.nyquist import nyquist_count
from ddct_controllers.design.drawing.charts import decibel
from ddct_controllers.design.drawing.line_styles import BLACK, BLUE, SKY, VERMILLION, line_styles
from ddct_controllers.design.loop_shaping.design import (
    NETWORK_SPECIFICATIONS,
    PLACEMENT_SPECIFICATIONS,
    integrators,
    lag_network,
    lead_network,
)
from ddct_controllers.design.loop_shaping.specifications import rise_time_crossover_product
from ddct_controllers.printed import LOOP_SHAPING_CONTROLLERS
from ddct_plant.linear.lti import FactoredTransferFunction

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_PRINTED_PRODUCT = 2.02
"""Product t_r w_c that Section 2.2 reads off the curve for its zeta."""
_G_C1 = LOOP_SHAPING_CONTROLLERS['ls2']
_G_C2 = LOOP_SHAPING_CONTROLLERS['ls7']
_RATIOS = (2.0, 3.0, 4.0, 6.0, 10.0, 16.0)
"""Ratios m_d and m_i of the normalised networks; G_c1 of the thesis has 16."""
_SLOWEST_RAD_S, _FASTEST_RAD_S = 1e-3, 1e4
_INDENTATION = np.exp(0.5j * np.pi * np.linspace(0.0, 1.0, 200))
"""Values of s / radius on the quarter circle that passes the poles at 0 on the right."""


def _draw_rise_time_crossover(axes: 'Axes') -> str:
    damping = np.linspace(0.1, 0.95, 341)
    product = np.array([rise_time_crossover_product(value) for value in damping])
    axes.plot(damping, product, color=BLUE, label='second-order prototype')
    specified = NETWORK_SPECIFICATIONS.damping
    computed = rise_time_crossover_product(specified)
    printed_at = float(np.interp(_PRINTED_PRODUCT, product, damping))
    axes.plot(specified, computed, 'o', color=BLUE, label=f'ζ = {specified:.2f}: {computed:.2f}')
    axes.plot(
        *(specified, _PRINTED_PRODUCT, 'x'),
        color=VERMILLION,
        markersize=9,
        markeredgewidth=2,
        label=f'read off in Section 2.2: {_PRINTED_PRODUCT:.2f}',
    )
    axes.set(xlabel='Damping ratio ζ', ylabel='t_r ω_c, rad', xlim=(0.1, 0.95))
    axes.legend(loc='upper left')
    return (
        f'At the ζ = {specified:.2f} of the specifications the curve gives {computed:.2f}; the '
        f'{_PRINTED_PRODUCT:.2f} that the thesis reads off belongs to ζ = {printed_at:.2f}.'
    )


def _draw_nyquist(whole: 'Axes', zoom: 'Axes', gain: float, printed_encirclements: int) -> str:
    loop = continuous_loop(integrators(gain, 1))
    values = loop.response(np.geomspace(_SLOWEST_RAD_S, _FASTEST_RAD_S, 6000))
    around_zero = loop.transfer_function.at(_SLOWEST_RAD_S * _INDENTATION)
    for axes, path in ((whole, _compressed), (zoom, np.asarray)):
        upper, closure = path(values), path(around_zero)
        axes.plot(upper.real, upper.imag, color=BLUE, label='ω > 0')
        axes.plot(upper.real, -upper.imag, color=SKY, linestyle='--', label='ω < 0')
        for side, label in ((1.0, 'past the poles at s = 0'), (-1.0, '_')):
            axes.plot(closure.real, side * closure.imag, color=BLACK, linestyle=':', label=label)
        critical = path(np.array([-1.0 + 0.0j]))
        axes.plot(critical.real, critical.imag, '+', color=VERMILLION, markersize=12, mew=2.5)
    whole.set(
        title='whole curve, |L| compressed to log(1 + |L|)',
        xlabel='Re, compressed',
        ylabel='Im, compressed',
        aspect='equal',
    )
    zoom.set(
        title='around -1 + j0',
        xlabel='Re L',
        ylabel='Im L',
        xlim=(-2.0, 1.0),
        ylim=(-1.5, 1.5),
        aspect='equal',
    )
    zoom.legend(loc='lower right')
    count = nyquist_count(loop)
    return (
        f'N = {count.encirclements}, P_ol = {count.open_loop_unstable}, so '
        f'P_cl = {count.closed_loop_unstable}; the thesis counts N = {printed_encirclements}.'
    )


def _compressed(values: np.ndarray) -> np.ndarray:
    """Return the values with magnitude log10(1 + magnitude), so that all are visible."""
    size = np.abs(values)
    return values / size * np.log10(1.0 + size)


def _draw_network(
    *panels: 'Axes',
    name: str,
    ratio_name: str,
    corner: str,
    network: Callable[[float, float], FactoredTransferFunction],
) -> str:
    normalised = np.geomspace(0.01, 1000.0, 500)
    responses = [network(1.0, ratio).frequency_response(normalised) for ratio in _RATIOS]
    quantities = {'Magnitude, dB': decibel, 'Phase, °': _degrees}
    for axes, (quantity, measure) in zip(panels, quantities.items(), strict=True):
        for ratio, response, style in zip(_RATIOS, responses, line_styles(), strict=False):
            label = f'{ratio_name} = {ratio:g}'
            axes.semilogx(normalised, measure(response), label=label, **style)
        frequency = f'Normalised frequency ω/{corner}'
        axes.set(xlabel=frequency, ylabel=quantity, xlim=(0.01, 1000.0))
    panels[0].legend(loc='best')
    largest = float(np.max(np.abs(_degrees(responses[-1]))))
    return (
        f'For the {ratio_name} = {_RATIOS[-1]:g} of G_c1 the {name} is {largest:.0f}° at most. '
        'The thesis names the magnitude only, but also reads the phase off its chart.'
    )


def _degrees(response: np.ndarray) -> np.ndarray:
    return np.degrees(np.angle(response))


LOOP_SHAPING_FIGURES = (
    ThesisFigure('2.2', 't_r ω_c over the damping ratio ζ', _draw_rise_time_crossover),
    ThesisFigure(
        *('2.3', 'Nyquist plot with K_c = 1'),
        partial(_draw_nyquist, gain=1.0, printed_encirclements=1),
        panels=2,
    ),
    ThesisFigure(
        *('2.4', 'Nyquist plot with K_c = -1'),
        partial(_draw_nyquist, gain=-1.0, printed_encirclements=2),
        panels=2,
    ),
    ThesisFigure(
        *('2.5', 'Contribution of a lead network'),
        partial(_draw_network, name='lead', ratio_name='m_d', corner='z_d', network=lead_network),
        panels=2,
    ),
    ThesisFigure(
        *('2.6', 'Contribution of a lag network'),
        partial(_draw_network, name='lag', ratio_name='m_i', corner='p_i', network=lag_network),
        panels=2,
    ),
    nichols_figure(
        *('2.7', 'Nichols chart with G_c(s) = K_c/s, K_c = -1'),
        name='L with G_c = -1/s',
        controller=integrators(-1.0, 1),
        specifications=NETWORK_SPECIFICATIONS,
        thesis_claim='very close to -1, and 70° of phase are missing',
    ),
    nichols_figure(
        *('2.8', 'Nichols chart with G_c1(s)'),
        name='L with G_c1',
        controller=_G_C1,
        specifications=NETWORK_SPECIFICATIONS,
        thesis_claim='far from -1, but crosses the circle',
    ),
    nichols_figure(
        *('2.9', 'Nichols chart with G_c2(s)'),
        name='L with G_c2',
        controller=_G_C2,
        specifications=PLACEMENT_SPECIFICATIONS,
        thesis_claim='the specifications are met; it does not mention the curve',
    ),
    step_figure(
        *('2.10', 'Step response with G_c2(s)'),
        name='G_c2',
        controller=_G_C2,
        printed=(0.52, 0.13),
    ),
)
"""Figures of Section 2.2."""
