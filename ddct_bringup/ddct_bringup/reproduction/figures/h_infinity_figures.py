"""Figures 3.3 and 3.5 to 3.9: the uncertainty, S_n and T_n with their bounds, and G_c's loop."""

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from scipy.optimize import brentq

from ddct_bringup.reproduction.figures.loop_shaping_figures import (
    draw_loop_in_nichols,
    draw_step,
)
from ddct_bringup.reproduction.figures.thesis_figure import Drawing, ThesisFigure
from ddct_controllers.design.analysis.loops import ContinuousLoop, continuous_loop, plant_in_rpm
from ddct_controllers.design.drawing.chart_style import BLUE, BOUND_LINE, SKY, new_chart
from ddct_controllers.design.drawing.charts import draw_bound
from ddct_controllers.design.h_infinity.recipes import PRINTED_WEIGHTS, THESIS_SPECIFICATIONS
from ddct_controllers.design.h_infinity.uncertainty import (
    PRINTED_W_U,
    WeightedNorms,
    relative_error,
    wear_family,
    weighted_norms,
)
from ddct_controllers.design.verified_design import WEAR_GAINS
from ddct_controllers.printed import H_INFINITY_CONTROLLERS
from ddct_plant.linear.lti import FactoredTransferFunction

_G_C = H_INFINITY_CONTROLLERS['hinf1']
_ERROR_LINES: tuple[dict[str, Any], ...] = (
    {'color': SKY, 'linestyle': '-', 'linewidth': 4.0},
    {'color': BLUE, 'linestyle': '-'},
)
"""For the two ends of the wear, of which one lies on the other."""
_PRINTED_SENSITIVITY_NORM = 0.97


def _loop(factor: float) -> ContinuousLoop:
    """Return the loop with a multiple of the printed G_c."""
    return continuous_loop(FactoredTransferFunction(factor) * _G_C)


def _norms(factor: float) -> WeightedNorms:
    w_s, w_t = PRINTED_WEIGHTS.sensitivity, PRINTED_WEIGHTS.complementary
    return weighted_norms(_loop(factor), w_s, w_t, PRINTED_W_U)


@cache
def _gain_of_the_printed_norms() -> float:
    """Return the least factor on the gain that gives the printed norm of W_s S_n."""
    return brentq(
        lambda factor: _norms(factor).sensitivity - _PRINTED_SENSITIVITY_NORM, 1.0, 3.0, xtol=1e-6
    )


@dataclass(frozen=True)
class _Bounded:
    """A function of the loop with G_c, and the weight whose inverse bounds it."""

    number: str
    function: str
    """S_n or T_n."""
    weight_name: str
    weight: FactoredTransferFunction
    norm: str
    """Which of `WeightedNorms` is the peak of weight times function."""
    printed_norm: float

    def draw(self, heading: str) -> Drawing:
        """Draw both over frequency."""
        figure, (axes,) = new_chart(heading)
        omega = np.geomspace(0.01, 1000.0, 800)
        factor = _gain_of_the_printed_norms()
        drawn = {'H∞1': 1.0, f'{factor:.2f} H∞1': factor}
        draw_bound(
            axes,
            omega,
            {
                f'|{self.function}|, G_c = {name}': self._values(times, omega)
                for name, times in drawn.items()
            },
            (f'|{self.weight_name}^-1|', 1.0 / self.weight.frequency_response(omega)),
        )
        norm, scaled = (getattr(_norms(times), self.norm) for times in drawn.values())
        verdict = 'stays below' if norm <= 1.0 else 'exceeds'
        return Drawing(
            figure,
            f'{self.function} {verdict} its bound: the norm of {self.weight_name} {self.function} '
            f'is {norm:.2f}, printed is {self.printed_norm:g}. With {factor:.2f} times the '
            f'printed gain, which gives the printed norm of W_s S_n, it is {scaled:.2f}.',
        )

    def _values(self, factor: float, omega: np.ndarray) -> np.ndarray:
        """Return S or T over frequency with the controller's gain times `factor`."""
        response = _loop(factor).response(omega)
        return (1.0 if self.function == 'S_n' else response) / (1.0 + response)


_BOUNDED = (
    _Bounded(
        *('3.5', 'S_n', 'W_s', PRINTED_WEIGHTS.sensitivity.transfer_function(), 'sensitivity'),
        printed_norm=_PRINTED_SENSITIVITY_NORM,
    ),
    _Bounded(
        *('3.6', 'T_n', 'W_t', PRINTED_WEIGHTS.complementary.transfer_function(), 'complementary'),
        printed_norm=0.997,
    ),
    _Bounded('3.7', 'T_n', 'W_u', PRINTED_W_U, 'uncertainty', printed_norm=0.32),
)


def _draw_uncertainty(heading: str) -> Drawing:
    figure, (axes,) = new_chart(heading)
    omega = np.geomspace(1.0, 1e6, 600)
    nominal, family = plant_in_rpm(), wear_family()
    for wear_gain, worn, style in zip(WEAR_GAINS, family, _ERROR_LINES, strict=True):
        error = relative_error(nominal, (worn,), omega)
        axes.semilogx(omega, error, label=f'error, K_usura = {wear_gain:g}', **style)
    weight = np.abs(PRINTED_W_U.frequency_response(omega))
    axes.semilogx(omega, weight, label='|W_u|', **BOUND_LINE)
    axes.set(xlim=(omega[0], omega[-1]), xlabel='Frequency, rad/s', ylabel='Magnitude')
    axes.legend(loc='lower left')
    highest = relative_error(nominal, family, omega)
    short = weight < highest
    return Drawing(
        figure,
        f'Both errors are {highest[0]:.2f} at all frequencies. |W_u| covers them up to '
        f'{omega[short][0]:.0f} rad/s; above it is up to '
        f'{100.0 * (1.0 - np.min(weight / highest)):.1f} % short of inequality (3.3).',
    )


H_INFINITY_FIGURES = (
    ThesisFigure('3.3', 'Errors by wear, and W_u', _draw_uncertainty),
    *(
        ThesisFigure(
            bounded.number,
            f'{bounded.function}(s) and its bound {bounded.weight_name}^-1(s)',
            bounded.draw,
        )
        for bounded in _BOUNDED
    ),
    ThesisFigure(
        '3.8',
        'Step response of the system with G_c(s)',
        lambda heading: draw_step(heading, 'G_c = H∞1', _G_C, (0.3, 0.08)),
    ),
    ThesisFigure(
        '3.9',
        'Nichols plot with G_c(s)',
        lambda heading: draw_loop_in_nichols(
            heading,
            'L with G_c = H∞1',
            _G_C,
            THESIS_SPECIFICATIONS,
            'the requirements are met',
        ),
    ),
)
"""Those of Section 3.2."""
