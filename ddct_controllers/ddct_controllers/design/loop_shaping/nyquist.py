"""The Nyquist criterion P_cl = P_ol + N for a loop that may have poles on the imaginary axis."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ddct_controllers.design.analysis.loops import ContinuousLoop
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.linear.lti import FactoredTransferFunction

_INDENTATION = 1e-7
"""
Radius of an indentation, relative to the slowest pole or zero.

A closed-loop pole within it would be missed: one that the loop hardly moves off the axis.
"""
_REACH = 1e3
"""End of the contour, relative to the fastest pole or zero."""
_POINTS = 400
"""Points per part of the contour before it is refined."""
_LARGEST_TURN = math.pi / 12.0
"""Of 1 + L between two points of the refined contour, in rad."""
_REFINEMENTS = 60
"""Halvings of a step; after them 1 + L jumps, which means that it passes through 0."""

_Path = Callable[[np.ndarray], np.ndarray]
"""A part of the contour: s for a parameter that runs from 0 to 1."""


@dataclass(frozen=True)
class NyquistCount:
    """What the Nyquist curve of a loop tells of its closed loop (Section 2.2.1)."""

    open_loop_unstable: int
    """P_ol, poles of L with positive real part."""
    encirclements: int
    """N, of -1 by the curve for w from -inf to inf: clockwise less counterclockwise."""

    @property
    def closed_loop_unstable(self) -> int:
        """P_cl, roots of 1 + L with positive real part."""
        return self.open_loop_unstable + self.encirclements


def nyquist_count(loop: ContinuousLoop) -> NyquistCount:
    """
    Count the encirclements of -1 by a strictly proper L, with its dead time if it has one.

    The contour runs up the imaginary axis and passes every pole on it by a small half circle on
    the right, so that those poles count as stable. Raise ParameterError when L is not strictly
    proper, DdctError when the curve passes through -1.
    """
    factored = loop.transfer_function
    if len(factored.zeros) >= len(factored.poles):
        raise ParameterError('Nyquist count: L(s) must have more poles than zeros')
    # The lower half of the contour mirrors the upper, which starts and ends where L is real.
    turned = sum(_turn(loop, path) for path in _upper_half(factored))
    half_turns = -turned / math.pi
    if abs(half_turns - round(half_turns)) > 0.01:
        raise DdctError(f'Nyquist count: {half_turns:.3f} half turns are no whole number')
    return NyquistCount(int(np.count_nonzero(factored.poles.real > 0.0)), round(half_turns))


def stabilising_sign(plant: FactoredTransferFunction, integrators: int) -> int:
    """
    Return the only sign of K_c in K_c/s^mu times networks that can stabilise the loop, +1 or -1.

    On the positive real axis a network is positive, so L(s) = K_c/s^mu R(s) G(s) has one sign
    from some s down to 0. If it is negative there, 1 + L goes from minus infinity to 1 and has a
    positive root, and P_cl is odd, whatever the networks: then K_c has the wrong sign.
    """
    corners = np.abs(np.concatenate([plant.zeros, plant.poles]))
    slow = _INDENTATION * np.min(corners[corners > 0.0], initial=1.0)
    value = plant * FactoredTransferFunction(1.0, (), (0.0,) * integrators)
    return 1 if value.at(np.array(slow)).real > 0.0 else -1


def _upper_half(factored: FactoredTransferFunction) -> list[_Path]:
    """Return the contour from the positive real axis near 0 to far up the imaginary axis."""
    corners = np.concatenate([factored.poles, factored.zeros])
    poles = factored.poles
    on_axis = np.unique(poles[(poles.real == 0.0) & (poles.imag >= 0.0)])
    others = np.abs(corners[np.abs(corners) > 0.0])
    radius = _INDENTATION * float(np.min(others, initial=1.0))
    paths: list[_Path] = []
    start = radius
    if on_axis.size and on_axis[0] == 0.0:
        paths.append(_arc(0.0, radius, 0.0))
    for centre in on_axis[on_axis.imag > 0.0].imag:
        paths += [_axis(start, centre - radius), _arc(centre, radius, -math.pi / 2.0)]
        start = centre + radius
    return [*paths, _axis(start, _REACH * float(np.max(others, initial=1.0)))]


def _arc(centre: float, radius: float, first_angle: float) -> _Path:
    span = math.pi / 2.0 - first_angle
    return lambda share: 1j * centre + radius * np.exp(1j * (first_angle + span * share))


def _axis(first: float, last: float) -> _Path:
    return lambda share: 1j * first * (last / first) ** share


def _turn(loop: ContinuousLoop, path: _Path) -> float:
    """Return by what angle 1 + L turns along the path, counterclockwise, in rad."""
    share = np.linspace(0.0, 1.0, _POINTS)
    for _ in range(_REFINEMENTS):
        s = path(share)
        values = 1.0 + loop.transfer_function.at(s) * np.exp(-s * loop.delay_s)
        steps = np.angle(values[1:] / values[:-1])
        large = np.flatnonzero(np.abs(steps) > _LARGEST_TURN)
        if not large.size:
            return float(np.sum(steps))
        share = np.insert(share, large + 1, 0.5 * (share[large] + share[large + 1]))
    raise DdctError('Nyquist count: L(jw) passes through -1: change the gain a little')
