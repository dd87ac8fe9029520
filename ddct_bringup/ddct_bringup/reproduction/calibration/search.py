# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Searches of the calibration.

The first is for the best fit, over the end of the score window, the two kinds of PI, and starts.
The others are for the centre and the rim of the region of the parameters in which the nine values
are within tolerance.
"""

import itertools
import math
from collections.abc import Callable, Sequence
from functools import lru_cache

import numpy as np
import scipy

from ddct_bringup.reproduction.calibration.parameters import (
    BASE,
    DURATION_S,
    LOWER,
    PARAMETERS,
    RANGE,
    TARGETS,
    Values,
)
from ddct_bringup.reproduction.calibration.problem import Fit, Problem, fit
from ddct_plant.base.errors import DdctError

Progress = Callable[[str], None]

_SLOWEST_S = BASE.control_start_s + max(row['engagement_time_s'] for row in TARGETS.values())
WINDOW_ENDS_S = tuple(
    tenths / 10.0 for tenths in range(math.ceil(10.0 * _SLOWEST_S), round(10.0 * DURATION_S) + 1)
)
"""
Ends of the score window in s: tenths from the end of the slowest printed engagement to the end of
the run.
"""

STARTS = tuple(
    (*torques, rise_end, 105.0, *gains)
    for torques, rise_end, gains in itertools.product(
        ((5.0, 300.0), (40.0, 250.0)),  # start and end of C_m
        (0.53, 0.40),  # end of its rise
        ((0.10, 0.02), (0.02, 0.12)),  # K_p and K_i: mostly proportional, mostly integral
    )
)
"""Start values, all with one slope, for the chosen window; the first two serve every window."""
RIM = 0.98
"""Largest scaled residual on the rim; the rest is a margin for rounded values and curvature."""
_STEPS = 40
_PRECISION = 1e-3
"""Change of the objective, in tolerances or in shares of a range, at which a search ends."""


def search(progress: Progress) -> tuple[list[Fit], list[Fit]]:
    """
    Return the best optimum of each kind of PI for each window end, and one from each of STARTS.

    The window ends are searched from two starts each; then all starts are used for the window with
    the lowest objective of a stable PI loop.
    """
    windows: list[Fit] = []
    for end in WINDOW_ENDS_S:
        progress(f'score window to {end:g} s')
        windows += _one_of_each_kind([fit(Problem(end), x) for x in STARTS[:2]])
    chosen_window = lowest_stable(windows).problem
    starts = []
    for number, start in enumerate(STARTS, 1):
        progress(f'start {number} of {len(STARTS)} for the window to the chosen end')
        starts.append(fit(chosen_window, start))
    return windows, starts


def lowest_stable(optima: Sequence[Fit]) -> Fit:
    """Return the fit with the lowest objective and a stable PI; raise DdctError without one."""
    stable = [one for one in optima if one.pi_stable]
    if not stable:
        raise DdctError(f'none of {len(optima)} fits has a stable PI loop: narrow the bounds')
    return min(stable, key=lambda one: one.objective)


def _one_of_each_kind(optima: Sequence[Fit]) -> list[Fit]:
    best: dict[str, Fit] = {}
    for one in sorted(optima, key=lambda one: one.objective):
        best.setdefault(one.pi_kind, one)
    return [best[kind] for kind in sorted(best, reverse=True)]


def centre(problem: Problem, start: Values) -> tuple[float, ...]:
    """
    Return the (6,) values near (6,) start values with the smallest largest scaled residual t.

    Sequential quadratic programming: minimise t with |residuals| <= t.
    """
    both_signs, jacobian = _both_signs(problem)
    shares = _shares(start)
    first = both_signs(shares)
    ones = np.ones((len(first), 1))
    least = _least(
        np.append(np.zeros(len(PARAMETERS)), 1.0),
        np.append(shares, np.max(first)),
        lambda at: at[-1] + both_signs(at[:-1]),
        lambda at: np.hstack([jacobian(at[:-1]), ones]),
    )
    return _values(least[:-1])


def rim(problem: Problem, start: Values, direction: Sequence[float]) -> tuple[float, ...]:
    """
    Return the (6,) values with all |residuals| <= RIM that are farthest along a direction.

    `start` (6,) is a point of the region, `direction` (6,) is in shares of the ranges.
    """
    both_signs, jacobian = _both_signs(problem)
    gain = -np.array(direction, dtype=float)
    return _values(_least(gain, _shares(start), lambda at: RIM + both_signs(at), jacobian))


_Function = Callable[[np.ndarray], np.ndarray]


def _both_signs(problem: Problem) -> tuple[_Function, _Function]:
    """
    Return (-r, r), (18,), of the scaled residuals r and its derivatives, (18, 6).

    They are functions of the parameters' (6,) shares of their ranges, and cache their values: the
    solver evaluates each twice at a point.
    """

    @lru_cache
    def values(*at: float) -> np.ndarray:
        residuals = problem.residuals(at)
        return np.concatenate([-residuals, residuals])

    @lru_cache
    def derivatives(*at: float) -> np.ndarray:
        jacobian = problem.jacobian(at)
        return np.vstack([-jacobian, jacobian])

    return lambda at: values(*_values(at)), lambda at: derivatives(*_values(at))


def _shares(values: Values) -> np.ndarray:
    return (np.asarray(values, dtype=float) - LOWER) / RANGE


def _values(shares: np.ndarray) -> tuple[float, ...]:
    """Return the values within the bounds, which SLSQP exceeds by the last digits."""
    return tuple((LOWER + np.clip(shares, 0.0, 1.0) * RANGE).tolist())


def _least(
    gain: np.ndarray, start: np.ndarray, limits: _Function, limits_jacobian: _Function
) -> np.ndarray:
    """
    Return the minimiser of gain @ x with all `limits` at least zero, by SLSQP.

    The first elements of x are shares of the parameters' ranges, from 0 to 1; the others are
    positive.
    """
    further = len(start) - len(PARAMETERS)
    answer = scipy.optimize.minimize(
        lambda at: gain @ at,
        start,
        jac=lambda at: gain,
        bounds=[(0.0, 1.0)] * len(PARAMETERS) + [(0.0, None)] * further,
        constraints={'type': 'ineq', 'fun': limits, 'jac': limits_jacobian},
        method='SLSQP',
        options={'maxiter': _STEPS, 'ftol': _PRECISION},
    )
    found: np.ndarray = answer.x
    return found
