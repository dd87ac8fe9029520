"""The region of the parameters in which the nine figures are within tolerance: centre and rim."""

from collections.abc import Callable, Sequence
from functools import lru_cache

import numpy as np
import scipy

from ddct_bringup.reproduction.calibration.parameters import LOWER, PARAMETERS, RANGE, Values
from ddct_bringup.reproduction.calibration.problem import Problem

RIM = 0.98
"""Largest scaled residual on the rim: rounding of the values and curvature may take the rest."""
_STEPS = 40
_PRECISION = 1e-3
"""Change of what is sought, in tolerances or in shares of a range, at which a search ends."""


def centre(problem: Problem, start: Values) -> tuple[float, ...]:
    """
    Return the (6,) values near (6,) start values whose largest scaled residual t is the least.

    Sequential quadratic programming: least t with |residuals| <= t.
    """
    figures = _Figures(problem)
    ones = np.ones((2 * figures.count, 1))
    shares = _shares(start)
    least = _least(
        np.append(np.zeros(len(PARAMETERS)), 1.0),
        np.append(shares, np.max(np.abs(figures.residuals(shares)))),
        lambda at: at[-1] + figures.both_signs(at[:-1]),
        lambda at: np.hstack([figures.both_signs_jacobian(at[:-1]), ones]),
    )
    return _values(least[:-1])


def rim(problem: Problem, start: Values, direction: Sequence[float]) -> tuple[float, ...]:
    """
    Return the (6,) values with all |residuals| <= RIM that goes the farthest along a direction.

    `start` (6,) is a point of the region, `direction` (6,) is in shares of the ranges.
    """
    figures = _Figures(problem)
    return _values(
        _least(
            -np.array(direction, dtype=float),
            _shares(start),
            lambda at: RIM + figures.both_signs(at),
            figures.both_signs_jacobian,
        )
    )


_Function = Callable[[np.ndarray], np.ndarray]


class _Figures:
    """The residuals of a problem as functions of the parameters' (6,) shares of their ranges."""

    def __init__(self, problem: Problem) -> None:
        """Keep what was computed last: each is asked for twice at a point."""
        self.count = 3 * len(problem.rows)
        self._residuals = lru_cache(lambda *values: problem.residuals(values))
        self._jacobian = lru_cache(lambda *values: problem.jacobian(values))

    def residuals(self, shares: np.ndarray) -> np.ndarray:
        """Return the (9,) scaled residuals r."""
        found: np.ndarray = self._residuals(*_values(shares))
        return found

    def both_signs(self, shares: np.ndarray) -> np.ndarray:
        """Return (-r, r), (18,)."""
        found = self.residuals(shares)
        return np.concatenate([-found, found])

    def both_signs_jacobian(self, shares: np.ndarray) -> np.ndarray:
        """Return the derivatives of (-r, r), (18, 6)."""
        found = self._jacobian(*_values(shares))
        return np.vstack([-found, found])


def _shares(values: Values) -> np.ndarray:
    return (np.asarray(values, dtype=float) - LOWER) / RANGE


def _values(shares: np.ndarray) -> tuple[float, ...]:
    """Return the values; SLSQP leaves the bounds by the last digits."""
    return tuple((LOWER + np.clip(shares, 0.0, 1.0) * RANGE).tolist())


def _least(
    gain: np.ndarray, start: np.ndarray, limits: _Function, limits_jacobian: _Function
) -> np.ndarray:
    """
    Return where gain @ at is least with all `limits` at least zero, by SLSQP.

    The first of `at` are shares of the parameters' ranges, from 0 to 1; what follows is positive.
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
