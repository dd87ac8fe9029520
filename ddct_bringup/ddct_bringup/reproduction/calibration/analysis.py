"""What the nine numbers say about the fitted parameters, and what the fit predicts by itself."""

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
    Record,
    Values,
    residual_rows,
)
from ddct_bringup.reproduction.calibration.problem import Fit, Problem, fit, row_figures
from ddct_bringup.reproduction.calibration.search import STARTS, Progress
from ddct_plant.scenario.scenario import Scenario

FITTED_NUMBERS = len(PARAMETERS) + 1
"""p: the parameters and the end of the score window."""


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
    """Student's t: how many std make a 95 % interval with so few degrees of freedom."""
    singular_values: np.ndarray
    """(6,) of J, largest first."""
    directions: np.ndarray
    """(6, 6), row i belongs to singular value i, in shares of the ranges."""
    std: np.ndarray
    """(6,) in the parameters' units."""
    std_given_start: np.ndarray
    """(6,) with C_m start held, which has 0."""
    correlation_given_start: np.ndarray
    """(5, 5) of all but C_m start, which is held."""
    covariance_root: np.ndarray
    """(6, 6) R with R R^T the covariance in the parameters' units."""
    covariance_root_given_start: np.ndarray
    """(6, 5) the same with C_m start held."""

    def std_of(self, gradient: ArrayLike) -> tuple[float, float]:
        """
        Return the std of a function of the parameters, free and with C_m start held.

        `gradient` (6,) is that of the function, per unit of each parameter.
        """
        roots = (self.covariance_root, self.covariance_root_given_start)
        free, held = (float(np.linalg.norm(np.asarray(gradient) @ root)) for root in roots)
        return free, held

    @property
    def weakest(self) -> np.ndarray:
        """(6,) change of the parameters, in their units, that the residuals show least."""
        change = self.directions[-1] * RANGE
        return change / change[np.argmax(np.abs(self.directions[-1]))]


def identifiability(optimum: Fit) -> Identifiability:
    """Return the analysis of a fit to all three rows."""
    jacobian = optimum.problem.jacobian(optimum.values)
    degrees = len(optimum.residuals) - FITTED_NUMBERS
    variance = float(np.sum(optimum.residuals**2)) / degrees
    _, singular_values, directions = np.linalg.svd(jacobian)
    held = np.linalg.inv(jacobian[:, 1:].T @ jacobian[:, 1:]) * variance
    held_std = np.sqrt(np.diag(held))
    # By the SVD: J^T J would lose the digits of the weakest direction.
    root = np.sqrt(variance) * directions.T / singular_values
    std = np.sqrt(np.sum(root**2, axis=1))
    held_root = np.vstack([np.zeros(len(held)), np.linalg.cholesky(held)])
    return Identifiability(
        degrees_of_freedom=degrees,
        residual_std=float(np.sqrt(variance)),
        coverage_95=float(scipy.stats.t.ppf(0.975, degrees)),
        singular_values=singular_values,
        directions=directions,
        std=std * RANGE,
        std_given_start=np.array([0.0, *(held_std * RANGE[1:])]),
        correlation_given_start=held / np.outer(held_std, held_std),
        covariance_root=RANGE[:, None] * root,
        covariance_root_given_start=RANGE[:, None] * held_root,
    )


def leave_one_row_out(optimum: Fit, progress: Progress) -> list[Record]:
    """
    Fit each two rows, for the window that all three chose, and return what they say of the third.

    No row but that of the PI depends on its gains: they are fitted to the row itself, which is
    marked as `gains_from_row`.
    """
    results = []
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
        figures = row_figures(problem.scenario(best.values), row)
        results.append(
            {
                'row': row,
                'gains_from_row': row == 'pi',
                **best.as_record(),
                'figures': residual_rows({row: figures}),
            }
        )
    return results


def _best_fit(problem: Problem, values: Values, free: tuple[int, ...]) -> Fit:
    """Return the best of the fits from the optimum and from two other starts."""
    is_free = np.isin(range(len(PARAMETERS)), free)
    starts = [np.where(is_free, start, values) for start in (values, STARTS[0], STARTS[2])]
    return min((fit(problem, start, free) for start in starts), key=lambda one: one.objective)


def changed_assumptions() -> dict[str, Scenario]:
    """Return other values of what the calibration assumes, by what is changed."""
    load, initial = BASE.load, BASE.initial
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
            initial=dataclasses.replace(
                initial, engine_speed_rad_s=speed, shaft_speed_rad_s=speed
            ),
        )
        for speed in (120.0, 200.0)
    }


def vary_assumptions(optimum: Fit, progress: Progress) -> list[Record]:
    """Return the refit with each of the changed assumptions."""
    fits = []
    for change, base in changed_assumptions().items():
        progress(change)
        refit = fit(dataclasses.replace(optimum.problem, base=base), optimum.values)
        fits.append({'change': change, **refit.as_record()})
    return fits
