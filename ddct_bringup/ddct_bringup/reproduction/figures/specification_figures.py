"""Figures 2.2 to 2.6: the prototype's rise time, the sign of K_c, and the two networks."""

import numpy as np

from ddct_bringup.reproduction.figures.thesis_figure import Drawing, ThesisFigure
from ddct_controllers.design.analysis.loops import continuous_loop
from ddct_controllers.design.drawing.chart_style import (
    BLACK,
    BLUE,
    SKY,
    VERMILLION,
    line_styles,
    new_chart,
)
from ddct_controllers.design.drawing.charts import decibel
from ddct_controllers.design.loop_shaping.design import NETWORK_SPECIFICATIONS
from ddct_controllers.design.loop_shaping.networks import integrators, lag_network, lead_network
from ddct_controllers.design.loop_shaping.nyquist import nyquist_count
from ddct_controllers.design.loop_shaping.specifications import rise_time_crossover_product

_PRINTED_PRODUCT = 2.02
"""t_r w_c that Section 2.2 reads off the curve for its zeta."""
_RATIOS = (2.0, 3.0, 4.0, 6.0, 10.0, 16.0)
"""m_d and m_i of the normalised networks; the thesis's G_c1 has 16."""
_SLOWEST_RAD_S, _FASTEST_RAD_S = 1e-3, 1e4
_INDENTATION = np.exp(0.5j * np.pi * np.linspace(0.0, 1.0, 200))
"""s / radius on the quarter circle that passes the poles at 0 on the right."""


def _draw_rise_time_crossover(heading: str) -> Drawing:
    figure, (axes,) = new_chart(heading)
    damping = np.linspace(0.1, 0.95, 341)
    product = np.array([rise_time_crossover_product(value) for value in damping])
    axes.plot(damping, product, color=BLUE, label='second-order prototype')
    wanted = NETWORK_SPECIFICATIONS.damping
    computed = rise_time_crossover_product(wanted)
    printed_at = float(np.interp(_PRINTED_PRODUCT, product, damping))
    axes.plot(wanted, computed, 'o', color=BLUE, label=f'ζ = {wanted:.2f}: {computed:.2f}')
    axes.plot(
        *(wanted, _PRINTED_PRODUCT, 'x'),
        color=VERMILLION,
        markersize=9,
        markeredgewidth=2,
        label=f'read off in Section 2.2: {_PRINTED_PRODUCT:.2f}',
    )
    axes.set(xlabel='Damping ratio ζ', ylabel='t_r ω_c, rad', xlim=(0.1, 0.95))
    axes.legend(loc='upper left')
    return Drawing(
        figure,
        f'At the ζ = {wanted:.2f} of the specifications the curve gives {computed:.2f}; the '
        f'{_PRINTED_PRODUCT:.2f} that the thesis reads off belongs to ζ = {printed_at:.2f}.',
    )


def _draw_nyquist(heading: str, gain: float, printed_encirclements: int) -> Drawing:
    figure, (whole, zoom) = new_chart(heading, panels=2)
    loop = continuous_loop(integrators(gain, 1))
    values = loop.response(np.geomspace(_SLOWEST_RAD_S, _FASTEST_RAD_S, 6000))
    around_zero = loop.transfer_function.at(_SLOWEST_RAD_S * _INDENTATION)
    for axes, path in ((whole, _compressed), (zoom, np.asarray)):
        upper, closure = path(values), path(around_zero)
        axes.plot(upper.real, upper.imag, color=BLUE, label='ω > 0')
        axes.plot(upper.real, -upper.imag, color=SKY, linestyle='--', label='ω < 0')
        label = 'past the poles at s = 0'
        for side in (1.0, -1.0):
            axes.plot(closure.real, side * closure.imag, color=BLACK, linestyle=':', label=label)
            label = '_'
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
    return Drawing(
        figure,
        f'N = {count.encirclements}, P_ol = {count.open_loop_unstable}, so '
        f'P_cl = {count.closed_loop_unstable}; the thesis counts N = {printed_encirclements}.',
    )


def _compressed(values: np.ndarray) -> np.ndarray:
    """Return the values with their size replaced by log10(1 + size), so that all is in sight."""
    size = np.abs(values)
    return values / size * np.log10(1.0 + size)


def _draw_network(heading: str, kind: str) -> Drawing:
    figure, panels = new_chart(heading, panels=2)
    normalised = np.geomspace(0.01, 1000.0, 500)
    for ratio, style in zip(_RATIOS, line_styles(), strict=False):
        network = lead_network(1.0, ratio) if kind == 'd' else lag_network(1.0, ratio)
        response = network.frequency_response(normalised)
        for axes, values in zip(panels, (decibel(response), _degrees(response)), strict=True):
            axes.semilogx(normalised, values, label=f'm_{kind} = {ratio:g}', **style)
    frequency = 'ω/z_d' if kind == 'd' else 'ω/p_i'
    for axes, quantity in zip(panels, ('Magnitude, dB', 'Phase, °'), strict=True):
        axes.set(xlabel=f'Normalised frequency {frequency}', ylabel=quantity, xlim=(0.01, 1000.0))
    panels[0].legend(loc='best')
    largest = float(np.max(np.abs(_degrees(response))))
    change = 'lead' if kind == 'd' else 'lag'
    return Drawing(
        figure,
        f'For the m_{kind} = {_RATIOS[-1]:g} of G_c1 the {change} is {largest:.0f}° at most. The '
        'thesis names the magnitude only, but also reads the phase off its chart.',
    )


def _degrees(response: np.ndarray) -> np.ndarray:
    return np.degrees(np.angle(response))


SPECIFICATION_FIGURES = (
    ThesisFigure('2.2', 't_r ω_c over the damping ratio ζ', _draw_rise_time_crossover),
    ThesisFigure('2.3', 'Nyquist plot with K_c = 1', lambda title: _draw_nyquist(title, 1.0, 1)),
    ThesisFigure('2.4', 'Nyquist plot with K_c = -1', lambda title: _draw_nyquist(title, -1.0, 2)),
    ThesisFigure('2.5', 'Contribution of a lead network', lambda title: _draw_network(title, 'd')),
    ThesisFigure('2.6', 'Contribution of a lag network', lambda title: _draw_network(title, 'i')),
)
"""Those of Sections 2.2, 2.2.1 and 2.2.2."""
