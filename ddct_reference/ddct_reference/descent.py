# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Descents of the slip reference from control start on, most of them to zero."""

import math
from abc import ABC, abstractmethod

from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.scenario.control import SlipProfile

TANH_STEEPNESS = 3.0
"""
Steepness kappa of the tanh, without unit.

Its end slopes, kappa sech^2 kappa / tanh kappa, are 3 % of the mean.
"""


class Descent(ABC):
    """A function of time that starts at any value and ends at zero, or a given profile."""

    @abstractmethod
    def at(self, start: float, time_s: float) -> tuple[float, float]:
        """
        Return the value and its rate per second, `time_s` seconds after control start.

        `start` is the value there; the unit of both is its unit.
        """


class CrfRamp(Descent):
    """CRF's ramp: constant slope to zero from either side (Section 1.4.1, Figures 1.11, 1.12)."""

    def __init__(self, slope: float) -> None:
        """Take the slope in rad/s^2, positive."""
        self._slope = slope

    def at(self, start: float, time_s: float) -> tuple[float, float]:
        """Return sign(start) (|start| - slope t), and 0 from there on."""
        size = abs(start) - self._slope * time_s
        if size <= 0.0:
            return 0.0, 0.0
        return math.copysign(size, start), -math.copysign(self._slope, start)


def tanh_shape(x: float) -> tuple[float, float]:
    """
    Return f(x) of the thesis's new reference, smoother than the ramp (Section 1.6.3), and f'(x).

    f(x) = [1 - tanh(kappa (2 x - 1)) / tanh(kappa)] / 2. The thesis prints a figure and no
    formula; this one starts and ends exactly, nearly without a slope at both ends.
    """
    argument, scale = TANH_STEEPNESS * (2.0 * x - 1.0), math.tanh(TANH_STEEPNESS)
    return (
        0.5 * (1.0 - math.tanh(argument) / scale),
        -TANH_STEEPNESS / (scale * math.cosh(argument) ** 2),
    )


def polynomial_shape(x: float) -> tuple[float, float]:
    """
    Return the cubic f(x) = (1 - x)^2 (1 + 2 x), without any slope at both ends, and f'(x).

    It is not in the thesis, but the polynomial of least degree with f(0) = 1, f(1) = 0, f'(0) =
    f'(1) = 0. The end without slope is the no-lurch condition of Glielmo and Vasca: with dw_d/dt =
    0 where w_d becomes 0 both plates accelerate alike when the clutch locks.
    """
    return (1.0 - x) ** 2 * (1.0 + 2.0 * x), -6.0 * x * (1.0 - x)


SHAPES = {'tanh': tanh_shape, 'polynomial': polynomial_shape}
"""Functions f of 0 <= x < 1 with f(0) = 1 and f(1) = 0, by the name of the reference's shape."""


class TimedDescent(Descent):
    """A descent start f(x) that takes a given time from any start."""

    def __init__(self, duration_s: float, shape: str) -> None:
        """Take the time in s from control start to zero, x = t / duration, and one of SHAPES."""
        self._duration_s = duration_s
        self._shape = SHAPES[shape]

    def at(self, start: float, time_s: float) -> tuple[float, float]:
        """Return start f(x) and its rate, and 0 from x = 1 on."""
        if time_s >= self._duration_s:
            return 0.0, 0.0
        value, slope = self._shape(time_s / self._duration_s)
        return start * value, start * slope / self._duration_s


class ProfileDescent(Descent):
    """The scenario's profile of the slip speed over time, whatever the slip at control start."""

    def __init__(self, profile: SlipProfile, start_s: float) -> None:
        """Take the profile, and the scenario time of control start in s."""
        self._profile = profile
        self._start_s = start_s

    def at(self, start: float, time_s: float) -> tuple[float, float]:
        """Return the profile's value and its mean rate over the coming period."""
        time = self._start_s + time_s
        value = self._profile.at(time)
        return value, (self._profile.at(time + PERIOD_S) - value) / PERIOD_S
