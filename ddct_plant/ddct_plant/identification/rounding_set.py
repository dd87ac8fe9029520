"""What the rounding of the printed coefficients allows: hard bounds, next to the fit's spread."""

import numpy as np
import scipy

from ddct_plant.base.errors import DdctError
from ddct_plant.identification.coefficients import FITTED, PrintedCoefficients

_ROUNDS = 4
"""Linear programs in a row, each about the last one's answer; the change is 1e-9 by the fourth."""
_SCALE = 1e-3
"""Size of a typical change of a logarithm, so that the program's numbers are near 1."""


def smallest_worst_residual(
    coefficients: PrintedCoefficients, start: np.ndarray
) -> tuple[float, np.ndarray]:
    """
    Return the least possible largest |residual| in half-units, and the logarithms that reach it.

    Up to 1, one driveline rounds to every printed number. Above 1 the programs need not settle:
    the value is then reached, but perhaps not the least.
    """
    goal = np.zeros(len(FITTED) + 1)
    goal[-1] = 1.0
    logarithms = _descend(coefficients, start, goal, worst=None)
    return float(np.abs(coefficients.residuals(logarithms)).max()), logarithms


def parameter_ranges(coefficients: PrintedCoefficients, centre: np.ndarray) -> np.ndarray:
    """
    Return the least and largest value of each fitted parameter, (7, 2), that the print allows.

    These are the ends of the set in which every residual is within one half-unit; `centre` are
    logarithms inside that set.
    """
    ranges = np.empty((len(FITTED), 2))
    for index in range(len(FITTED)):
        for column, sign in enumerate((1.0, -1.0)):
            goal = np.zeros(len(FITTED) + 1)
            goal[index] = sign
            ranges[index, column] = np.exp(_descend(coefficients, centre, goal, worst=1.0)[index])
    return ranges


def _descend(
    coefficients: PrintedCoefficients, start: np.ndarray, goal: np.ndarray, worst: float | None
) -> np.ndarray:
    """
    Return the logarithms that minimise goal . (logarithms, t), |residuals| <= t <= worst.

    Sequential linear programming on the residuals, which are nearly linear over their rounding.
    """
    logarithms = start
    bounds = [(None, None)] * len(FITTED) + [(0.0, worst)]
    ones = np.ones((len(coefficients.numbers), 1))
    for _ in range(_ROUNDS):
        residuals = coefficients.residuals(logarithms)
        jacobian = coefficients.jacobian(logarithms) * _SCALE
        rows = np.block([[jacobian, -ones], [-jacobian, -ones]])
        answer = scipy.optimize.linprog(
            goal, rows, np.concatenate([-residuals, residuals]), bounds=bounds
        )
        if not answer.success:
            raise DdctError(f'bounds of the driveline parameters: {answer.message}')
        logarithms = logarithms + _SCALE * answer.x[:-1]
    return logarithms
