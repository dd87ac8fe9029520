# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Nichols chart: coordinates, curves of constant |T|, |S| and arg T, and the grid."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ddct_controllers.design.drawing.line_styles import LineStyle
from ddct_plant.base.errors import require_number

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_CURVE_POINTS = 720
_UNIT_CIRCLE = np.exp(2j * math.pi * (np.arange(_CURVE_POINTS) + 0.5) / _CURVE_POINTS)
"""Points on the unit circle, (720,), symmetric; none is 1, where L is infinite or 0."""
_SMALLEST_SIZE = 1e-4
"""Smallest |T| on a curve of constant arg T; the largest is its reciprocal."""
TURN_DEG = 360.0
_MAGNITUDES_DB = (6.0, 3.0, 1.0, 0.0, -1.0, -3.0, -6.0, -12.0, -20.0)
"""Levels of |T| in dB that the grid has."""
_PHASES_DEG = (-30.0, -60.0, -90.0, -120.0, -150.0, -210.0, -240.0, -270.0, -300.0, -330.0)
"""Levels of arg T in degrees that the grid has."""
_LINE: LineStyle = {
    'color': '#c4c4c4',
    'linewidth': 0.7,
    'linestyle': (0, (1, 1)),
    'zorder': 1.2,
}
_PHASE_LINE: LineStyle = _LINE | {'linestyle': (0, (4, 4))}
_LABEL = 'closed loop: |T| in dB, arg T in °'
_INSET = 0.045
"""Distance of a label from the edge of the chart, as a share of its height or width."""


@dataclass(frozen=True, eq=False)
class NicholsCurve:
    """Curve of L in the coordinates of the chart."""

    phase_deg: np.ndarray
    """Phase arg L in degrees, (n,)."""
    magnitude_db: np.ndarray
    """Magnitude 20 log10 |L| in dB, (n,)."""


def constant_m_curve(level: float) -> NicholsCurve:
    """Return the curve of L with |T| = |L/(1 + L)| = `level`, an M-circle, from L = T/(1 - T)."""
    closed = require_number('level of |T|', level, above=0.0) * _UNIT_CIRCLE
    return nichols_curve(closed / (1.0 - closed), unwrap=False)


def constant_n_curve(phase_deg: float) -> NicholsCurve:
    """Return the open curve of L with arg T = arg(L/(1 + L)) = `phase_deg`, from L = T/(1 - T)."""
    sizes = np.geomspace(_SMALLEST_SIZE, 1.0 / _SMALLEST_SIZE, _CURVE_POINTS)
    closed = sizes * np.exp(1j * math.radians(phase_deg))
    return nichols_curve(closed / (1.0 - closed), unwrap=False)


def constant_s_curve(level: float) -> NicholsCurve:
    """Return the curve of L with |S| = 1/|1 + L| = `level`, from L = 1/S - 1."""
    closed = require_number('level of |S|', level, above=0.0) * _UNIT_CIRCLE
    return nichols_curve(1.0 / closed - 1.0, unwrap=False)


def nichols_curve(values: np.ndarray, *, unwrap: bool = True) -> NicholsCurve:
    """
    Return the complex values of L in the coordinates of the chart.

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


def draw_nichols_grid(
    axes: 'Axes', phase_deg: tuple[float, float], magnitude_db: tuple[float, float]
) -> None:
    """Draw the contours of |T| and arg T within the range of the chart, each with its value."""
    axes.plot([], [], label=_LABEL, **_LINE)
    bottom = magnitude_db[0] + _INSET * (magnitude_db[1] - magnitude_db[0])
    for level in _PHASES_DEG:
        curve = constant_n_curve(level)
        draw_turns(axes, curve, phase_deg, closed=False, **_PHASE_LINE)
        order = np.argsort(curve.magnitude_db)
        at = np.interp(bottom, curve.magnitude_db[order], curve.phase_deg[order])
        _label(axes, at, bottom, f'{level:.0f}°', phase_deg)
    top = magnitude_db[1] - _INSET * (magnitude_db[1] - magnitude_db[0])
    for level in _MAGNITUDES_DB:
        curve = constant_m_curve(10.0 ** (level / 20.0))
        draw_turns(axes, curve, phase_deg, **_LINE)
        _label(axes, *_place(level, curve, top), f'{level:.0f} dB', phase_deg)


def draw_turns(
    axes: 'Axes',
    curve: NicholsCurve,
    phase_deg: tuple[float, float],
    label: str | None = None,
    *,
    closed: bool = True,
    **style: Any,
) -> None:
    """Draw a curve, which repeats every 360 degrees, at each repetition in the range of phases."""
    phase, magnitude = curve.phase_deg, curve.magnitude_db
    if closed:
        phase, magnitude = (np.append(values, values[0]) for values in (phase, magnitude))
    jumps = np.flatnonzero(np.abs(np.diff(phase)) > 0.5 * TURN_DEG) + 1
    phase, magnitude = np.insert(phase, jumps, np.nan), np.insert(magnitude, jumps, np.nan)
    for turn in _turns(phase_deg):
        axes.plot(phase + turn * TURN_DEG, magnitude, label=label, **style)
        label = None


def _place(level_db: float, curve: NicholsCurve, top_db: float) -> tuple[float, float]:
    """
    Return the phase in degrees and the magnitude in dB of the label of a level of |T|.

    A closed contour has its label at its highest point. A contour below 0 dB crosses the whole
    chart and has its label near phase 0; the contour of 0 dB has it near the top.
    """
    if level_db > 0.0:
        highest = int(np.argmax(curve.magnitude_db))
        return -0.5 * TURN_DEG, float(curve.magnitude_db[highest])
    if level_db == 0.0:
        near = int(
            np.argmin(np.abs(curve.magnitude_db - top_db) + (curve.phase_deg < -180.0) * 1e3)
        )
    else:
        near = int(np.argmin(np.abs(curve.phase_deg + _INSET * TURN_DEG)))
    return float(curve.phase_deg[near]), float(curve.magnitude_db[near])


def _label(
    axes: 'Axes', at_deg: float, at_db: float, text: str, phase_deg: tuple[float, float]
) -> None:
    for turn in _turns(phase_deg):
        if phase_deg[0] < at_deg + turn * TURN_DEG < phase_deg[1]:
            axes.text(
                at_deg + turn * TURN_DEG,
                at_db,
                text.replace('-', '−'),
                color='#6e6e6e',
                fontsize=7.5,
                clip_on=True,
                zorder=1.5,
                horizontalalignment='center',
                verticalalignment='center',
                bbox={'facecolor': 'white', 'edgecolor': 'none', 'pad': 0.6},
            )


def _turns(phase_deg: tuple[float, float]) -> range:
    """Return the indices of the turns that the range covers; turn 0 is from -360 to 0 degrees."""
    first, last = math.floor(phase_deg[0] / TURN_DEG), math.ceil(phase_deg[1] / TURN_DEG)
    return range(first + 1, last + 1)
