# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Source of the H-infinity optima: Nehari's theorem, without states and Riccati equations.

The stack [W_s S, W_t T] is at most g where S lies in a disc about c = |W_t|^2 / q of radius r, q =
|W_s|^2 + |W_t|^2 and r^2 = (g^2 - |W_s W_t|^2 / q) / q. S is 1 - B h: B has the plant's zeros in
the right half-plane, h is any stable function. So the stack can be at most g if and only if B* (1
- c) / R is within 1 of a stable function, R outer with |R| = r: the Hankel operator of its Fourier
coefficients on the unit circle has a norm of at most 1. Nothing else of the plant counts: its pole
at 0 requires S(0) = 0, which is inside the disc there.
"""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import scipy
from scipy.linalg import hankel
from typed_loops import DT, driveline, g_a

from ddct_controllers.design.analysis.loops import continuous_loop
from ddct_controllers.design.h_infinity.design import generalised_plant
from ddct_controllers.design.h_infinity.recipes import make_weights
from ddct_controllers.design.h_infinity.synthesis.gamma_iteration import synthesise
from ddct_controllers.design.h_infinity.uncertainty import PRINTED_W_U, weighted_norms
from ddct_controllers.synthesised import synthesised_design

POINTS = 2**13
COEFFICIENTS = 60
RATE = 20.0
"""
Rate of the bilinear map in rad/s.

With twice as many points and coefficients the optimum moves by less than 1e-6.
"""
K, W_2 = 0.15, 28.0
ZETA = math.log(12.5) / math.hypot(math.pi, math.log(12.5))
"""Damping zeta of an overshoot of 8 %, without unit."""
T_P = 1.0 / (2.0 * ZETA * math.sqrt(1.0 - ZETA**2))
J_OMEGA = 1j * np.geomspace(0.1, 10.0, 100_000)
S_P = np.abs(J_OMEGA * (J_OMEGA + 2.0 * ZETA) / (J_OMEGA**2 + 2.0 * ZETA * J_OMEGA + 1.0)).max()
W_1 = math.sqrt(S_P / K)
EPSILON = 0.01 * W_1


def sensitivity_weight(s: np.ndarray) -> np.ndarray:
    return (s**2 + math.sqrt(2.0) * W_1 * s + W_1**2) / (S_P * (s + EPSILON) ** 2)


def complementary_weight(s: np.ndarray, damping: float) -> np.ndarray:
    return (1.0 + 2.0 * damping * s / W_2 + (s / W_2) ** 2) / T_P


def outer(magnitude: np.ndarray) -> np.ndarray:
    """Return the function without zeros in the disc that has this magnitude on the circle."""
    cepstrum = np.fft.fft(np.log(magnitude)) / len(magnitude)
    cepstrum[1 : len(magnitude) // 2] *= 2.0
    cepstrum[len(magnitude) // 2 :] = 0.0
    return np.exp(np.fft.ifft(cepstrum) * len(magnitude))


def optimum(zeros: np.ndarray, w_t: Callable[[np.ndarray], np.ndarray], flat: bool) -> float:
    """
    Return the least norm for zeros in the right half-plane.

    The circle is q = (RATE - s) / (RATE + s). W_t rises like s^2, or levels out if `flat`.
    """
    # Half a step off, so that s = infinity is no point; that turns coefficients, no norm.
    q = np.exp(2j * math.pi * (np.arange(POINTS) + 0.5) / POINTS)
    s = RATE * (1.0 - q) / (1.0 + q)
    first, second = np.abs(sensitivity_weight(s)) ** 2, np.abs(w_t(s)) ** 2
    total = first + second
    inside = (RATE - zeros) / (RATE + zeros)
    blaschke = np.prod([(q - at) / (1.0 - np.conj(at) * q) for at in inside], axis=0)
    # Outer by inspection: takes the sharp bends at epsilon and infinity out of the radius.
    known = ((s + W_1) / (s + EPSILON)) ** 2 * (1.0 if flat else (1.0 + s / W_2) ** 2)

    def excess(level: float) -> float:
        radius = np.sqrt((level**2 - first * second / total) / total)
        symbol = np.conj(blaschke) * first / total * known / outer(radius * np.abs(known))
        coefficients = np.fft.fft(symbol) / POINTS
        negative = coefficients[: -COEFFICIENTS - 1 : -1]
        return float(np.linalg.norm(hankel(negative), 2)) - 1.0

    least = math.sqrt((first * second / total).max())
    return scipy.optimize.brentq(excess, least * (1.0 + 1e-9), 2.0, xtol=1e-7)


def rising(damping: float) -> Callable[[np.ndarray], np.ndarray]:
    return lambda s: complementary_weight(s, damping)


def level_beyond(s: np.ndarray) -> np.ndarray:
    return complementary_weight(s, math.sqrt(0.5)) / (1.0 + s / (10.0 * W_2)) ** 2


def sampled_zeros() -> np.ndarray:
    """Return the zeros beyond the unit circle in the w-plane, and two at infinity."""
    import control

    zeros = control.c2d(driveline() * g_a(), DT, 'zoh').zeros()
    # Hold and delay each put a zero at z = infinity, which is w = 2/T.
    beyond = zeros[np.abs(zeros) > 1.0]
    return 2.0 / DT * np.append((beyond - 1.0) / (beyond + 1.0), [1.0, 1.0])


ACTUATOR_ZEROS = np.roots([1, -161.3, 31340])
WEIGHTS = make_weights('thesis')
DOUBLE = replace(WEIGHTS, complementary=replace(WEIGHTS.complementary, damping=1.0))
SAMPLED = replace(make_weights('sampled'), effort=None)


@pytest.mark.parametrize(
    ('weights', 'zeros', 'w_t', 'flat', 'least'),
    [
        (WEIGHTS, lambda: ACTUATOR_ZEROS, rising(math.sqrt(0.5)), False, 1.1050),
        (DOUBLE, lambda: ACTUATOR_ZEROS, rising(1.0), False, 1.1392),
        (SAMPLED, sampled_zeros, level_beyond, True, 1.1444),
    ],
    ids=['printed', 'double zero of sderiv', 'hold and delay'],
)
def test_the_optimum_is_that_of_nehari(weights, zeros, w_t, flat, least):
    """The optima agree within 2e-4, twice the tolerance of the iteration."""
    expected = optimum(zeros(), w_t, flat)
    assert expected == pytest.approx(least, abs=1e-4)
    assert synthesise(generalised_plant(weights)).optimum == pytest.approx(expected, rel=2e-4)


def test_no_controller_meets_the_printed_weights_with_hold_and_delay_better_than_without():
    """Hold and delay add zeros in the right half-plane, and 0.04 to the optimum."""
    without = optimum(ACTUATOR_ZEROS, rising(math.sqrt(0.5)), flat=False)
    assert optimum(sampled_zeros(), level_beyond, flat=True) > without + 0.03


def test_w_t_t_of_hinf_thesis_is_that_of_a_sweep():
    """It is 1.076 as on the page: the designed controller in the typed plant, typed weight."""
    import control

    design = synthesised_design('hinf_thesis')
    omega = np.geomspace(1e-2, 1e3, 20_000)
    controller = control.zpk(design.cleaned.zeros, design.cleaned.poles, design.cleaned.gain)
    loop = (driveline() * g_a())(1j * omega) * controller(1j * omega)
    weighted = complementary_weight(1j * omega, math.sqrt(0.5)) * loop / (1.0 + loop)
    norms = weighted_norms(
        continuous_loop(design.cleaned), WEIGHTS.sensitivity, WEIGHTS.complementary, PRINTED_W_U
    )
    assert norms.complementary == pytest.approx(np.abs(weighted).max(), rel=1e-4)
    assert 1.0 < norms.complementary < norms.stack
