# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The Nyquist criterion by a contour of our own, which takes a dead time as it is."""

import math
from collections.abc import Callable

import numpy as np

from ddct_controllers.design.analysis.loops import ContinuousLoop
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
"""Largest turn of 1 + L between two points of the refined contour, in rad."""
_REFINEMENTS = 60
"""Number of halvings of a step; after them 1 + L jumps, so it passes through 0."""

_Path = Callable[[np.ndarray], np.ndarray]
"""A part of the contour: s for a parameter that runs from 0 to 1."""


def unstable_by_contour(loop: ContinuousLoop) -> int:
    """
    Return P_ol + N of a strictly proper L, with its dead time if it has one.

    The contour runs up the imaginary axis and passes every pole on it by a small half circle on
    the right, so that those poles count as stable.
    """
    factored = loop.transfer_function
    # The lower half of the contour mirrors the upper, which starts and ends where L is real.
    half_turns = -sum(_turn(loop, path) for path in _upper_half(factored)) / math.pi
    assert abs(half_turns - round(half_turns)) < 0.01
    return int(np.count_nonzero(factored.poles.real > 0.0)) + round(half_turns)


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
    """Return the angle in rad by which 1 + L turns along the path, counterclockwise."""
    share = np.linspace(0.0, 1.0, _POINTS)
    for _ in range(_REFINEMENTS):
        s = path(share)
        values = 1.0 + loop.transfer_function.at(s) * np.exp(-s * loop.delay_s)
        steps = np.angle(values[1:] / values[:-1])
        large = np.flatnonzero(np.abs(steps) > _LARGEST_TURN)
        if not large.size:
            return float(np.sum(steps))
        share = np.insert(share, large + 1, 0.5 * (share[large] + share[large + 1]))
    raise AssertionError('L(jw) passes through -1')
