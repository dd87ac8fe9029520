# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Identifiability of the fitted parameters from the nine numbers, and predictions of the fit."""

import dataclasses
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike

from ddct_bringup.reproduction.calibration.parameters import (
    BASE,
    PARAMETERS,
    PI_ONLY,
    RANGE,
    ROWS,
    Values,
    residual_rows,
)
from ddct_bringup.reproduction.calibration.problem import Fit, Problem, fit, row_values
from ddct_bringup.reproduction.calibration.record_types import AssumptionEntry, LeftOutEntry
from ddct_bringup.reproduction.calibration.search import STARTS, Progress
from ddct_plant.scenario.scenario import Scenario

FITTED_NUMBERS = len(PARAMETERS) + 1
"""Number p of fitted numbers: the parameters and the end of the score window."""


@dataclass(frozen=True)
class Identifiability:
    """
    Linear analysis at the optimum, with the Jacobian J per range of each parameter.

    The variance of a scaled residual is their sum of squares over 9 - p degrees of freedom. It
    measures how far the model is from the print, not noise.
    """

    degrees_of_freedom: int
    residual_std: float
    coverage_95: float
    """Half-width of a 95 % interval in std, from Student's t with these degrees of freedom."""
    singular_values: np.ndarray
    """Singular values of J, (6,), largest first."""
    directions: np.ndarray
    """Right singular vectors, (6, 6), in shares of the ranges; row i has singular value i."""
    std: np.ndarray
    """Standard deviations of the parameters, (6,), in their units."""
    std_given_start: np.ndarray
    """
    Standard deviations for a fixed C_m start, (6,), in the parameters' units; that of C_m start is
    0.
    """
    correlation_given_start: np.ndarray
    """Correlations of all parameters but C_m start for a fixed C_m start, (5, 5)."""
    covariance_root: np.ndarray
    """Root R of the covariance R R^T of the parameters, (6, 6), in their units."""
    covariance_root_given_start: np.ndarray
    """Root of the covariance for a fixed C_m start, (6, 5), in the parameters' units."""

    def std_of(self, gradient: ArrayLike) -> tuple[float, float]:
        """
        Return the std of a function of the parameters, with C_m start free and fixed.

        `gradient` (6,) is the gradient of the function, per unit of each parameter.
        """
        roots = (self.covariance_root, self.covariance_root_given_start)
        free, fixed = (float(np.linalg.norm(np.asarray(gradient) @ root)) for root in roots)
        return free, fixed

    @property
    def weakest(self) -> np.ndarray:
        """Change of the parameters with the least effect on residuals, (6,), in their units."""
        change = self.directions[-1] * RANGE
        return change / change[np.argmax(np.abs(self.directions[-1]))]


def identifiability(optimum: Fit) -> Identifiability:
    """Return the analysis of a fit to all three rows."""
    jacobian = optimum.problem.jacobian(optimum.values)
    degrees = len(optimum.residuals) - FITTED_NUMBERS
    variance = float(np.sum(optimum.residuals**2)) / degrees
    _, singular_values, directions = np.linalg.svd(jacobian)
    fixed = np.linalg.inv(jacobian[:, 1:].T @ jacobian[:, 1:]) * variance
    fixed_std = np.sqrt(np.diag(fixed))
    # The SVD keeps the digits of the weakest direction, which J^T J would lose.
    root = np.sqrt(variance) * directions.T / singular_values
    std = np.sqrt(np.sum(root**2, axis=1))
    fixed_root = np.vstack([np.zeros(len(fixed)), np.linalg.cholesky(fixed)])
    return Identifiability(
        degrees_of_freedom=degrees,
        residual_std=float(np.sqrt(variance)),
        coverage_95=float(scipy.stats.t.ppf(0.975, degrees)),
        singular_values=singular_values,
        directions=directions,
        std=std * RANGE,
        std_given_start=np.array([0.0, *(fixed_std * RANGE[1:])]),
        correlation_given_start=fixed / np.outer(fixed_std, fixed_std),
        covariance_root=RANGE[:, None] * root,
        covariance_root_given_start=RANGE[:, None] * fixed_root,
    )


def leave_one_row_out(optimum: Fit, progress: Progress) -> list[LeftOutEntry]:
    """
    Fit each two rows, with the window of the fit to all three; return predictions of the third.

    Only the row of the PI depends on its gains: where it is left out they are fitted to the row
    itself, which is marked as `gains_from_row`.
    """
    results: list[LeftOutEntry] = []
    for row in ROWS:
        progress(f'without the row of {row}')
        problem = dataclasses.replace(
            optimum.problem, rows=tuple(kept for kept in ROWS if kept != row)
        )
        free = tuple(
            index for index in range(len(PARAMETERS)) if row != 'pi' or index not in PI_ONLY
        )
        best = _best_fit(problem, optimum.values, free)
        if row == 'pi':
            alone = dataclasses.replace(problem, rows=('pi',))
            gains = _best_fit(alone, best.values, PI_ONLY)
            best = dataclasses.replace(best, values=gains.values)
        figures = row_values(problem.scenario(best.values), row)
        results.append(
            LeftOutEntry(
                row=row,
                gains_from_row=row == 'pi',
                fit=best.as_record(),
                figures=residual_rows({row: figures}),
            )
        )
    return results


def _best_fit(problem: Problem, values: Values, free: tuple[int, ...]) -> Fit:
    """Return the best of the fits from the optimum and from two other starts."""
    is_free = np.isin(range(len(PARAMETERS)), free)
    starts = [np.where(is_free, start, values) for start in (values, STARTS[0], STARTS[2])]
    return min((fit(problem, start, free) for start in starts), key=lambda one: one.objective)


def changed_assumptions() -> dict[str, Scenario]:
    """Return scenarios with one changed assumption of the calibration each, by name."""
    load, initial = BASE.load, BASE.given_initial
    return {
        f'road load times {factor:g}': dataclasses.replace(
            BASE,
            load=dataclasses.replace(
                load,
                rolling_coefficient=factor * load.rolling_coefficient,
                drag_coefficient=factor * load.drag_coefficient,
            ),
        )
        for factor in (0.5, 1.5)
    } | {
        f'both plates at {speed:g} rad/s': dataclasses.replace(
            BASE,
            given_initial=dataclasses.replace(
                initial, engine_speed_rad_s=speed, shaft_speed_rad_s=speed
            ),
        )
        for speed in (120.0, 200.0)
    }


def vary_assumptions(optimum: Fit, progress: Progress) -> list[AssumptionEntry]:
    """Return the refit with each of the changed assumptions."""
    fits: list[AssumptionEntry] = []
    for change, base in changed_assumptions().items():
        progress(change)
        refit = fit(dataclasses.replace(optimum.problem, base=base), optimum.values)
        fits.append(AssumptionEntry(change, refit.as_record()))
    return fits
