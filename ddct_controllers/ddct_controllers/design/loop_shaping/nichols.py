"""The Nichols chart: curves of constant |T| and |S|, the loop, and where it is inside them."""

import math
from dataclasses import dataclass

import numpy as np

from ddct_controllers.design.analysis.loop_curve import (
    LoopCurve,
    Measure,
    complementary,
    sensitivity,
)
from ddct_controllers.design.loop_shaping.specifications import TimeSpecifications
from ddct_plant.base.errors import require_number

_CURVE_POINTS = 720
_SMALLEST_SIZE = 1e-4
"""Of |T| on a curve of constant phase."""


@dataclass(frozen=True, eq=False)
class NicholsCurve:
    """A curve of L in the chart's coordinates."""

    phase_deg: np.ndarray
    """arg L, (n,)."""
    magnitude_db: np.ndarray
    """20 log10 |L|, (n,)."""


@dataclass(frozen=True)
class Contour:
    """A closed curve that L has to stay out of, and what L does there."""

    name: str
    """S or T."""
    level: float
    """S_p or T_p."""
    peak: float
    """M_s or M_t of the loop."""
    peak_rad_s: float
    """Frequency of the peak."""
    inside_rad_s: tuple[tuple[float, float], ...]
    """First and last frequency of every stretch of L inside the curve, as far as L is known."""

    @property
    def respected(self) -> bool:
        """Whether L stays out."""
        return not self.inside_rad_s


def constant_m_curve(level: float) -> NicholsCurve:
    """Return where |T| = |L/(1 + L)| is `level` (an M-circle), from L = T/(1 - T)."""
    closed = require_number('level of |T|', level, above=0.0) * _unit_circle()
    return nichols_curve(closed / (1.0 - closed), unwrap=False)


def constant_n_curve(phase_deg: float) -> NicholsCurve:
    """Return where arg T = arg(L/(1 + L)) is `phase_deg`, from L = T/(1 - T); it is not closed."""
    sizes = np.geomspace(_SMALLEST_SIZE, 1.0 / _SMALLEST_SIZE, _CURVE_POINTS)
    closed = sizes * np.exp(1j * math.radians(phase_deg))
    return nichols_curve(closed / (1.0 - closed), unwrap=False)


def constant_s_curve(level: float) -> NicholsCurve:
    """Return where |S| = 1/|1 + L| is `level`, from L = 1/S - 1."""
    closed = require_number('level of |S|', level, above=0.0) * _unit_circle()
    return nichols_curve(1.0 / closed - 1.0, unwrap=False)


def nichols_curve(values: np.ndarray, *, unwrap: bool = True) -> NicholsCurve:
    """
    Return L's values in the coordinates of the chart.

    The phase starts in (-360, 0] degrees and is continuous from there, or stays there with
    `unwrap=False`.
    """
    phase = np.angle(values)
    if unwrap:
        phase = np.unwrap(phase)
        phase = phase - math.tau * np.ceil(phase[:1] / math.tau)
    else:
        phase = np.where(phase > 0.0, phase - math.tau, phase)
    return NicholsCurve(np.degrees(phase), 20.0 * np.log10(np.abs(values)))


def contours(curve: LoopCurve, specifications: TimeSpecifications) -> tuple[Contour, Contour]:
    """Return what L does at the S_p and the T_p curve of the specifications."""
    return (
        _contour(curve, 'S', specifications.sensitivity_peak, sensitivity),
        _contour(curve, 'T', specifications.complementary_peak, complementary),
    )


def _contour(curve: LoopCurve, name: str, level: float, measure: Measure) -> Contour:
    def excess(values: np.ndarray) -> np.ndarray:
        return measure(values) - level

    first, last = float(curve.omega[0]), float(curve.omega[-1])
    bounds = list(curve.crossings(excess))
    if excess(curve.values[:1])[0] > 0.0:
        bounds.insert(0, first)
    if len(bounds) % 2:
        bounds.append(last)
    stretches = tuple(zip(bounds[0::2], bounds[1::2], strict=True))
    return Contour(name, level, *curve.peak(measure), stretches)


def _unit_circle() -> np.ndarray:
    """Return points of it, symmetric, none of them at 1, where L is infinite or 0."""
    return np.exp(2j * math.pi * (np.arange(_CURVE_POINTS) + 0.5) / _CURVE_POINTS)
