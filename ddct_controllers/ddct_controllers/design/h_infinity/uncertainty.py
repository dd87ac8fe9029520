# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
W_u, the size of the uncertainty that clutch wear makes (Section 3.2.1.3), and weighted peaks.

Section 3.2.2 judges a controller by the peaks of S and T under their weights and W_u.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from ddct_controllers.design.analysis.loop_curve import LoopCurve
from ddct_controllers.design.analysis.loops import (
    IDENTIFIED_DRIVELINE,
    WEAR_RANGE,
    ContinuousLoop,
    plant_in_rpm,
)
from ddct_controllers.design.h_infinity.weights import ComplementaryWeight, SensitivityWeight
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace
from ddct_plant.models.parameters import DrivelineParameters

PRINTED_W_U = FactoredTransferFunction(0.2987, (3913.0 / 0.2987,), (13030.0,))
"""
Weight W_u as printed, made with `ginput`.

It falls from 0.3003 to 0.2987, short of the error 0.3.
"""
OMEGA = np.geomspace(1e-2, 1e6, 241)
"""Frequencies in rad/s at which the family is evaluated."""


def shortfall_from_rad_s(weight: FactoredTransferFunction, error: float) -> float | None:
    """Return the frequency from which a falling |W_u| is below a constant error, or None."""

    def excess(omega: float) -> float:
        return float(np.abs(weight.frequency_response(np.array([omega])))[0]) - error

    if excess(OMEGA[-1]) >= 0.0:
        return None
    if excess(OMEGA[0]) < 0.0:
        return 0.0
    return float(scipy.optimize.brentq(excess, OMEGA[0], OMEGA[-1]))


def wear_family(
    parameters: DrivelineParameters = IDENTIFIED_DRIVELINE,
) -> tuple[FactoredTransferFunction, ...]:
    """Return G_a P_2 30/pi at both ends of the range of K_usura."""
    return tuple(plant_in_rpm(parameters, gain) for gain in WEAR_RANGE)


def relative_error(
    nominal: FactoredTransferFunction,
    family: Sequence[FactoredTransferFunction],
    omega: np.ndarray,
) -> np.ndarray:
    """Return max |(G_p - G_pn) / G_pn| over the family, (n,), inequality (3.3)."""
    at_nominal = nominal.frequency_response(omega)
    errors = [np.abs(member.frequency_response(omega) / at_nominal - 1.0) for member in family]
    return np.max(errors, axis=0)


def fit_first_order(omega: np.ndarray, error: np.ndarray) -> FactoredTransferFunction:
    """
    Return the first-order W_u that covers `error`, (n,), with the least excess anywhere.

    For each pole of a grid, |W|^2 (w^2 + pole^2) = p_1 w^2 + p_0 makes "at least the error, at
    most t times it" a linear program in p_1, p_0 and t^2. Of equally good poles the fastest is
    taken: a constant error then gives a constant, with a pole and a zero that cancel.
    """
    poles = np.geomspace(omega[0], omega[-1], 2 * len(omega) // 5)
    fits = [(*_least_excess(omega, error, pole), pole) for pole in poles]
    least = min(fit[0] for fit in fits)
    _, slope, level, pole = [fit for fit in fits if fit[0] <= least * (1.0 + 1e-6)][-1]
    gain = math.sqrt(slope)
    return FactoredTransferFunction(gain, (math.sqrt(level) / gain,), (float(pole),))


def _least_excess(omega: np.ndarray, error: np.ndarray, pole: float) -> tuple[float, float, float]:
    """Return t^2, p_1 and p_0."""
    target = error**2 * (omega**2 + pole**2)
    shape = np.column_stack([omega**2, np.full_like(omega, pole**2)]) / target[:, None]
    none = np.zeros((len(omega), 1))
    found = scipy.optimize.linprog(
        [0.0, 0.0, 1.0],
        np.vstack([np.hstack([-shape, none]), np.hstack([shape, none - 1.0])]),
        np.concatenate([-np.ones(len(omega)), np.zeros(len(omega))]),
        bounds=[(1e-12, None), (0.0, None), (1.0, None)],
    )
    slope, level, excess = found.x
    return float(excess), float(slope), float(level * pole**2)


@dataclass(frozen=True)
class WeightedNorms:
    """Peaks over frequency; a requirement is met by a peak below 1."""

    sensitivity: float
    """Norm ||W_s S||, with the poles of W_s at 0."""
    complementary: float
    """Norm ||W_t T||."""
    uncertainty: float
    """Norm ||W_u T||: robust stability for all K_usura."""
    stack: float
    """Norm ||[W_s S; W_t T]||."""


def weighted_norms(
    loop: ContinuousLoop | StateSpace,
    w_s: SensitivityWeight,
    w_t: ComplementaryWeight,
    w_u: FactoredTransferFunction,
) -> WeightedNorms:
    """Return the norms of a stable loop, on a grid that is dense around the poles."""
    curve = LoopCurve(loop)
    sensitivity = np.abs(1.0 / (1.0 + curve.values))
    complementary = np.abs(curve.values) * sensitivity
    first = sensitivity * np.abs(w_s.transfer_function().frequency_response(curve.omega))
    second = complementary * np.abs(w_t.transfer_function().frequency_response(curve.omega))
    third = complementary * np.abs(w_u.frequency_response(curve.omega))
    return WeightedNorms(
        *(float(np.max(x)) for x in (first, second, third, np.hypot(first, second)))
    )
