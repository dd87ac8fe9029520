# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Local fits by `scipy.optimize.least_squares`, and the search over score windows and starts.

scipy is there already, and its trust-region method keeps the bounds; lmfit would only wrap it.
"""

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy

from calibrate.problem import LOWER, PARAMETERS, RANGE, ROWS, Problem, Values, pi_growth_rate
from ddct_bringup.thesis.table_5_1 import ROW_OF
from ddct_plant.base.errors import DdctError
from ddct_plant.scenario.scenario import Scenario

STARTS = tuple(
    (*torques, rise_end, 105.0, *gains)
    for torques, rise_end, gains in itertools.product(
        ((5.0, 300.0), (40.0, 250.0)),  # start and end of C_m
        (0.53, 0.40),  # end of its rise
        ((0.10, 0.02), (0.02, 0.12)),  # K_p and K_i: mostly proportional, mostly integral
    )
)
"""Start values, all with one slope, for the chosen window; the first two serve every window."""
_STEP = 1e-4
"""Difference step of the Jacobian, about that share of each parameter's range."""
_PRECISION = 1e-5
"""Relative change of the objective or the parameters at which a fit ends."""


@dataclass(frozen=True)
class Fit:
    """A local optimum."""

    problem: Problem
    values: np.ndarray
    """Values of the parameters, (6,), in the order of PARAMETERS."""
    residuals: np.ndarray
    """Scaled residuals, (9,)."""
    jacobian: np.ndarray
    """Derivatives of the residuals per range of each parameter, (9, 6)."""

    @property
    def objective(self) -> float:
        """Half the sum of the squared scaled residuals."""
        return 0.5 * float(np.sum(self.residuals**2))

    @cached_property
    def pi_growth_rate(self) -> float:
        """Growth rate of the PI's slip loop in 1/s, negative when it is stable."""
        return pi_growth_rate(self.problem.base.driveline, *self.values[4:])

    def standard_errors(self) -> np.ndarray:
        """
        Return the standard errors of all parameters but C_m start, which is held, (5,).

        The variance of a scaled residual is their sum of squares over nine less the seven fitted
        numbers, of which one is the end of the score window. It measures how far the model is
        from the print, not noise.
        """
        jacobian = self.jacobian[:, 1:]
        variance = 2.0 * self.objective / (len(self.residuals) - len(PARAMETERS) - 1)
        shares: np.ndarray = np.sqrt(np.diag(np.linalg.inv(jacobian.T @ jacobian)) * variance)
        return shares * RANGE[1:]


def fit(problem: Problem, start: Values) -> Fit:
    """Return the local optimum within the bounds from (6,) start values."""
    # One is added to each share of a range: scipy takes its steps in proportion to the unknown.
    answer = scipy.optimize.least_squares(
        lambda unknown: problem.residuals(LOWER + (unknown - 1.0) * RANGE),
        1.0 + np.clip((np.asarray(start) - LOWER) / RANGE, 1e-6, 1.0 - 1e-6),
        bounds=(1.0, 2.0),
        diff_step=_STEP,
        ftol=_PRECISION,
        xtol=_PRECISION,
        gtol=_PRECISION,
        max_nfev=60,
    )
    return Fit(problem, LOWER + (answer.x - 1.0) * RANGE, answer.fun, answer.jac)


def search(base: Scenario, progress: Callable[[str], None]) -> list[Fit]:
    """Return every fit: for each window end from two starts, then from the others for the best."""
    fits = []
    for end in window_ends(base):
        progress(f'score window to {end:g} s')
        fits += [fit(Problem(base, end), start) for start in STARTS[:2]]
    chosen = lowest_stable(fits).problem
    progress(f'other starts, score window to {chosen.window_end_s:g} s')
    return fits + [fit(chosen, start) for start in STARTS[2:]]


def window_ends(base: Scenario) -> list[float]:
    """Return tenths of a second from the slowest printed engagement to the end of the run."""
    slowest = base.control_start_s + max(ROW_OF[row].engagement_time_s for row in ROWS)
    tenths = range(math.ceil(10.0 * slowest), round(10.0 * base.duration_s) + 1)
    return [end / 10.0 for end in tenths]


def lowest_stable(fits: Sequence[Fit]) -> Fit:
    """Return the fit with the lowest objective and a stable PI; raise DdctError without one."""
    stable = [one for one in fits if one.pi_growth_rate < 0.0]
    if not stable:
        raise DdctError(f'none of {len(fits)} fits has a stable PI loop: narrow the bounds')
    return min(stable, key=lambda one: one.objective)
