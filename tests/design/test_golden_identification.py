# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Source of the identification's numbers: P_2 and P_3 by Cramer's rule, fitted by scipy.

The nine printed numbers are typed from Section 1.6.2, with 339.4 for 334.4 as a zero of P_2.
Nothing here is computed by the product.
"""

import numpy as np
import pytest
import scipy

from ddct_plant.models.parameters import DrivelineParameters

P = DrivelineParameters()
PRINTED = np.array([-103.43, 0.005905, 5.344, 339.4, 0.006733, 121.4, 7696.0, 7.2217, 63.99])
HALF_UNITS = np.array([5e-3, 5e-7, 5e-4, 5e-2, 5e-7, 5e-2, 5e-1, 5e-5, 5e-3])
MISPRINT = 3
"""Index, among the printed numbers, of c of P_2's zeros."""
ROUNDED = np.log([0.25, 0.010057, 0.0120, 105.0, 6720.0, 9.344, 154.7])
"""Natural logarithms of J_m, J_p, c_prim, c_sa, k_sa, tau and J_v, rounded."""


def coefficients(logarithms: np.ndarray) -> np.ndarray:
    """Return P_2's gain, zeros and poles, P_3's gain and zero, by Cramer's rule on s I - A."""
    j_m, j_p, c_p, c, k, tau, j_v = np.exp(logarithms)
    # Rows of [w_p, w_r, theta]: characteristic polynomial, and minors for C_f and C_load.
    a = np.array(
        [
            [-(c / tau**2 + c_p) / j_p, c / (j_p * tau), -k / (j_p * tau)],
            [c / (j_v * tau), -c / j_v, k / j_v],
            [1.0 / tau, -1.0, 0.0],
        ]
    )
    poles = np.poly(a)
    minor = np.poly(a[1:, 1:])
    # P_2 = -1/(J_m s) - minor/(J_p poles).
    zeros = np.polyadd(poles / j_m, np.append(minor, 0.0) / j_p)
    real, pair = split(zeros / zeros[0])
    slow, fast = split(poles)
    return np.array(
        [
            -(1 / j_m + 1 / j_p),
            real,
            *pair,
            slow,
            *fast,
            c / (j_p * tau * j_v),
            k / c,
        ]
    )


def split(cubic: np.ndarray) -> tuple[float, np.ndarray]:
    """Return a and (b, c) of (s + a)(s^2 + b s + c)."""
    roots = np.roots(cubic)
    slow = roots[np.argmin(np.abs(roots))].real
    return -slow, np.polydiv(cubic, [1.0, -slow])[0][1:]


def residuals(logarithms: np.ndarray, printed: np.ndarray = PRINTED) -> np.ndarray:
    """Return computed less printed, in half-units of the last digit."""
    return (coefficients(logarithms) - printed) / HALF_UNITS


def fit(
    printed: np.ndarray = PRINTED, left_out: int | None = None
) -> 'scipy.optimize.OptimizeResult':
    kept = [index for index in range(9) if index != left_out]
    return scipy.optimize.least_squares(
        lambda x: residuals(x, printed)[kept],
        ROUNDED,
        x_scale='jac',
        xtol=1e-14,
        ftol=1e-14,
        gtol=1e-14,
    )


def test_the_best_driveline_misses_the_print_by_a_chi_square_of_3_556():
    """
    Fitted by scipy from the rounded parameters, on polynomials made here.

    A rounding error is uniform within a half-unit, so its variance is a third of that squared.
    """
    found = fit()
    assert 3.0 * 2.0 * found.cost == pytest.approx(3.556, abs=0.001)
    identified = [P.engine_inertia, P.shaft_inertia, P.shaft_damping, P.halfshaft_damping]
    identified += [P.halfshaft_stiffness, P.gear.total_ratio, P.vehicle_inertia]
    assert np.exp(found.x) == pytest.approx(identified, rel=1e-4)


def test_the_best_driveline_for_334_4_misses_a_number_by_59_4_half_units():
    as_printed = PRINTED.copy()
    as_printed[MISPRINT] = 334.4
    assert np.abs(fit(as_printed).fun).max() == pytest.approx(59.4, abs=0.1)


def test_the_other_eight_numbers_predict_339_392_with_a_deviation_of_0_024():
    """
    The deviation follows from fits with each number moved up and down by its half-unit.

    Half the difference is the effect of a half-unit, and the deviation of a rounding error is a
    half- unit over sqrt(3).
    """

    def predicted(moved: int, half_units: float) -> float:
        printed = PRINTED + half_units * HALF_UNITS * (np.arange(9) == moved)
        return coefficients(fit(printed, MISPRINT).x)[MISPRINT]

    assert predicted(MISPRINT, 0.0) == pytest.approx(339.392, abs=0.001)
    others = [number for number in range(9) if number != MISPRINT]
    effects = [(predicted(number, 1.0) - predicted(number, -1.0)) / 2.0 for number in others]
    assert np.linalg.norm(effects) / np.sqrt(3.0) == pytest.approx(0.024, abs=5e-4)


def test_no_driveline_misses_every_number_by_less_than_0_810_half_units():
    """
    By duality: the least largest |r + J x| is the largest |y'r| over y'J = 0 with |y|_1 = 1.

    The nine residuals have a plane of such y, which is swept. The least squares are so near that
    the bend of the residuals is below the tolerance.
    """
    best = fit().x
    steps = 1e-6 * np.eye(7)
    jacobian = np.transpose([(residuals(best + e) - residuals(best - e)) / 2e-6 for e in steps])
    null = np.linalg.svd(jacobian.T)[2][7:]
    assert np.abs(null @ jacobian).max() < 1e-6 * np.abs(jacobian).max()
    angles = np.linspace(0.0, np.pi, 10_000)
    y = np.column_stack([np.cos(angles), np.sin(angles)]) @ null
    bounds = np.abs(y @ residuals(best)) / np.abs(y).sum(axis=1)
    assert bounds.max() == pytest.approx(0.810, abs=0.001)
