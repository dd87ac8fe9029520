# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The Nyquist curve of a loop on a grid: its crossings, peaks and critical gains."""

import math
from collections.abc import Callable
from functools import partial

import numpy as np

from ddct_controllers.design.analysis.loops import ContinuousLoop
from ddct_controllers.design.analysis.refinement import maxima, zeros
from ddct_controllers.design.loop_stack import LoopStack
from ddct_controllers.design.state_space import close_loop, frequency_response, poles_rad_s
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import StateSpace

Measure = Callable[[np.ndarray], np.ndarray]
"""Real function of L(j omega), elementwise."""
_GRID_POINTS = 1500
_SLOWEST_RAD_S = 1e-5
_FASTEST_RAD_S = 1e5
"""
Ends of the grid of a continuous loop in rad/s.

A sampled one ends at half its sampling rate.
"""
_DISTANCES = np.geomspace(1e-4, 0.1, 12)
"""Distances of further grid points from every pole's frequency, relative, on both sides."""
_NEAR_THE_PEAK = 0.95
"""Share of the highest value on the grid from which a local maximum is refined too."""


class LoopCurve:
    """L(j omega) or L(exp(j omega T)) on a grid that is dense around the poles of L and of T."""

    def __init__(self, loop: ContinuousLoop | StateSpace) -> None:
        """Evaluate the loop on its grid, which contains the poles of T without a dead time."""
        if isinstance(loop, ContinuousLoop):
            system = loop.transfer_function.to_state_space()
            self._response = loop.response
        else:
            system = loop
            self._response = partial(frequency_response, loop)
        self._sampled = system.period_s is not None
        last = math.pi / system.period_s if system.period_s else _FASTEST_RAD_S
        poles = poles_rad_s(system)
        self._integrates = bool(np.min(np.abs(poles), initial=math.inf) < _SLOWEST_RAD_S)
        self.omega = _grid(np.concatenate([poles, poles_rad_s(close_loop(system))]), last)
        """Frequencies in rad/s, rising, (n,)."""
        self.values = (
            LoopStack.joined([system]).responses(self.omega)[0]
            if system.period_s == PERIOD_S
            else self._response(self.omega)
        )
        """Values of L at these frequencies, (n,) complex."""

    def at(self, omega: float) -> complex:
        """Return L at one frequency in rad/s."""
        return complex(self._response(np.array([omega]))[0])

    def crossings(self, measure: Measure) -> list[float]:
        """Return the frequencies in rad/s, rising, at which `measure` of L changes its sign."""
        measured = measure(self.values)
        signs = measured > 0.0
        first = np.flatnonzero(signs[1:] != signs[:-1])
        ends = self.omega[first], self.omega[first + 1], measured[first], measured[first + 1]
        return zeros(self._measured(measure), *ends).tolist()

    def peak(self, measure: Measure) -> tuple[float, float]:
        """Return the maximum of `measure` of L over frequency, and its frequency in rad/s."""
        return self.peaks(measure)[0]

    def peaks(self, *measures: Measure) -> list[tuple[float, float]]:
        """Return the `peak` of each of some measures."""
        found, brackets = [], []
        for measure in measures:
            measured = measure(self.values)
            best = int(np.argmax(measured))
            found.append((float(measured[best]), float(self.omega[best])))
            inner = measured[1:-1]
            local = (inner >= measured[:-2]) & (inner >= measured[2:])
            brackets.append(np.flatnonzero(local & (inner >= _NEAR_THE_PEAK * measured[best])))
        ends = np.cumsum([each.size for each in brackets])
        first = np.concatenate(brackets)

        def measured_at(omega: np.ndarray) -> np.ndarray:
            parts = np.split(self._response(omega), ends[:-1], axis=-1)
            return np.concatenate([of(part) for of, part in zip(measures, parts, strict=True)], -1)

        refined = maxima(measured_at, self.omega[first], self.omega[first + 2])
        for i, (omega, value) in enumerate(zip(*refined, strict=True)):
            which = int(np.searchsorted(ends, i, side='right'))
            if value > found[which][0]:
                found[which] = float(value), float(omega)
        return found

    def critical_gains(self) -> list[float]:
        """Return every factor that puts L through -1: -1/L where L is real and negative."""
        crossings = self.crossings(lambda values: values.imag / np.abs(values))
        # L is real at rest and at half the sampling rate too, without a change of sign.
        at_rest = () if self._integrates else (0.0,)
        at_half_rate = self.omega[-1:] if self._sampled else ()
        values = self._response(np.array([*crossings, *at_rest, *at_half_rate]))
        return [float(-1.0 / value) for value in values.real if value < 0.0]

    def _measured(self, measure: Measure) -> Callable[[np.ndarray], np.ndarray]:
        """Return `measure` of L as a function of frequencies in rad/s."""
        return lambda omega: measure(self._response(omega))


def sensitivity(values: np.ndarray) -> np.ndarray:
    """Return |S| = 1/|1 + L| of values of L, elementwise."""
    return 1.0 / np.abs(1.0 + values)


def complementary(values: np.ndarray) -> np.ndarray:
    """Return |T| = |L/(1 + L)| of values of L, elementwise."""
    return np.abs(values / (1.0 + values))


def _grid(poles: np.ndarray, last: float) -> np.ndarray:
    near = np.concatenate([1.0 + _DISTANCES, 1.0 / (1.0 + _DISTANCES)])
    around = np.outer(np.abs(poles[np.isfinite(poles)]), near).ravel()
    inside = around[(around > _SLOWEST_RAD_S) & (around < last)]
    return np.unique(np.concatenate([np.geomspace(_SLOWEST_RAD_S, last, _GRID_POINTS), inside]))
