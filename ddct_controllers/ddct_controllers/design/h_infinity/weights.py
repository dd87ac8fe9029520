# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Weights on S, T and the torque of an H-infinity design (Section 3.2.1)."""

import math
from dataclasses import dataclass

import numpy as np

from ddct_plant.base.errors import ParameterError, require_number
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace

BUTTERWORTH = math.sqrt(0.5)
"""Damping of a second-order Butterworth polynomial; the thesis rounds 2 x this to 1.414."""
OFFSET_RATIO = 0.01
"""
Ratio of epsilon to w_1, where the thesis has 0.01 w_c.

Its printed controller has the pair of epsilon = 0.0095 rad/s, and no loop of Chapter 3 crosses
over at 0.95 rad/s; from 0.001 to 0.03 the ratio moves gamma by less than 1 %.
"""


@dataclass(frozen=True)
class SensitivityWeight:
    """
    W_s = (1 + 2 zeta s/w_1 + (s/w_1)^2) / (K s^2), so that |S| may be K w^2 and S_p at most.

    The two poles at 0 are mu + p, one of the controller and one of the plant.
    """

    low_frequency_gain: float
    """Factor K = |S(0)*| of |S| = K w^2 at low frequency, in s^2."""
    peak: float
    """Bound S_p of |S|."""

    def __post_init__(self) -> None:
        """Check both; raise ParameterError that names a bad one."""
        require_number('K, the low-frequency gain of S,', self.low_frequency_gain, above=0.0)
        _require_peak(
            'S_p',
            '|S|',
            self.peak,
            above=1.0,
            why='the loop falls off twice, so |S| exceeds 1 somewhere (Bode)',
        )

    @property
    def corner_rad_s(self) -> float:
        """Corner frequency w_1 = sqrt(S_p / K) in rad/s."""
        return math.sqrt(self.peak / self.low_frequency_gain)

    @property
    def offset_rad_s(self) -> float:
        """Distance epsilon in rad/s of the poles of `shifted` from 0."""
        return OFFSET_RATIO * self.corner_rad_s

    def transfer_function(self, offset_rad_s: float = 0.0) -> FactoredTransferFunction:
        """Return W_s with its poles at 0, or at minus an offset."""
        corner = self.corner_rad_s
        numerator = ((2.0 * BUTTERWORTH * corner, corner**2),)
        return FactoredTransferFunction(1.0 / self.peak, numerator, (offset_rad_s, offset_rad_s))

    def shifted(self) -> FactoredTransferFunction:
        """Return W_1* = W_s s^2 / (s + epsilon)^2, the stable stand-in of Section 3.2.2."""
        return self.transfer_function(self.offset_rad_s)


@dataclass(frozen=True)
class ComplementaryWeight:
    """W_t = (1 + 2 zeta s/w_2 + (s/w_2)^2) / T_p: |T| may be T_p, and falls off beyond w_2."""

    peak: float
    """Bound T_p of |T|."""
    corner_rad_s: float
    """Corner frequency w_2 in rad/s."""
    damping: float = BUTTERWORTH
    """Damping zeta; 1 makes the double real zero of two calls of `sderiv` with [1/w_2 1]."""

    def __post_init__(self) -> None:
        """Check all; raise ParameterError that names a bad one."""
        _require_peak(
            'T_p',
            '|T|',
            self.peak,
            at_least=1.0,
            why='with an integrator in the loop T is 1 at rest',
        )
        require_number('w_2', self.corner_rad_s, above=0.0)
        require_number('damping of W_t', self.damping, above=0.0)

    def transfer_function(self) -> FactoredTransferFunction:
        """Return W_t, a polynomial of second order."""
        corner = self.corner_rad_s
        numerator = ((2.0 * self.damping * corner, corner**2),)
        return FactoredTransferFunction(1.0 / (self.peak * corner**2), numerator)

    def rolled_off(self, ratio: float) -> FactoredTransferFunction:
        """Return W_t / (1 + s/(ratio w_2))^2, which is proper."""
        far = ratio * self.corner_rad_s
        return self.transfer_function() * FactoredTransferFunction(far**2, (), (far, far))


@dataclass(frozen=True)
class EffortWeight:
    """W_c on the torque request: it costs 1 at `torque_n_m_per_rpm`, and more beyond a corner."""

    torque_n_m_per_rpm: float
    """Torque in N m that costs 1, per rpm of the reference."""
    corner_rad_s: float
    """Frequency in rad/s from which the weight rises, up to 100 times higher."""

    def __post_init__(self) -> None:
        """Check both; raise ParameterError that names a bad one."""
        require_number('the torque of the effort weight', self.torque_n_m_per_rpm, above=0.0)
        require_number('the corner of the effort weight', self.corner_rad_s, above=0.0)

    def transfer_function(self) -> FactoredTransferFunction:
        """Return (1 + s/w_c) / (1 + s/(100 w_c)) over the torque."""
        corner, far = self.corner_rad_s, 100.0 * self.corner_rad_s
        return FactoredTransferFunction(100.0 / self.torque_n_m_per_rpm, (corner,), (far,))


def stable_weight(name: str, weight: FactoredTransferFunction) -> StateSpace:
    """Return a realisation; raise ParameterError for a weight that is not proper and stable."""
    if weight.zeros.size > weight.poles.size:
        raise ParameterError(
            f'{name} has {weight.zeros.size} zeros and {weight.poles.size} poles: '
            'make it proper, with a pole far beyond the crossover for each zero too many',
            key=name,
        )
    if np.any(weight.poles.real >= 0.0):
        worst = weight.poles[np.argmax(weight.poles.real)]
        raise ParameterError(
            f'{name} has a pole at {worst:.4g} rad/s: no feedback can move a pole of a weight; '
            'replace s by s + epsilon, or reflect the pole to the left',
            key=name,
        )
    return weight.to_state_space()


def _require_peak(
    name: str,
    function: str,
    peak: float,
    *,
    above: float | None = None,
    at_least: float | None = None,
    why: str,
) -> None:
    """Raise ParameterError with the reason `why` for a bound of a function that is too low."""
    try:
        require_number(f'{name}, the bound on {function},', peak, above=above, at_least=at_least)
    except ParameterError as error:
        raise ParameterError(f'{error}: {why}', key=name) from error
