# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Checks of the identified driveline against the print, and ranges that the rounding allows."""

from dataclasses import dataclass

import numpy as np
import scipy

from ddct_bringup.identification.coefficients import FITTED, PrintedCoefficients
from ddct_bringup.identification.fit import ROUNDING_VARIANCE, Identification, predict_left_out
from ddct_plant.base.errors import DdctError
from ddct_plant.models.printed import ENGINE_TO_SLIP

_SIGMAS = 3.0
_CONFIDENCE = 0.99
_ROUNDS = 4
"""Number of successive linear programs; the fourth changes the solution by 1e-9."""
_SCALE = 1e-3
"""Typical change of a logarithm, which scales the linear programs to numbers near 1."""
ZERO_PAIR = ('P2', 'zero c')
"""Transfer function and label of the coefficient that Section 1.6.2 prints as 334.4."""


@dataclass(frozen=True)
class IdentificationCheck:
    """One check of the fit: its name, its value and the range that the value must lie in."""

    name: str
    value: float
    lowest: float
    highest: float

    @property
    def passed(self) -> bool:
        """Whether the value is in its range."""
        return self.lowest <= self.value <= self.highest


def check_identification(
    identification: Identification, coefficients: PrintedCoefficients, worst: float
) -> tuple[IdentificationCheck, ...]:
    """
    Return the checks of a fit to `coefficients`; P_1 took no part in it.

    `worst` is their `smallest_worst_residual`.
    """
    return (
        _engine_gain(identification),
        IdentificationCheck(
            f'chi-square of {identification.degrees_of_freedom} degrees of freedom',
            identification.chi_square,
            0.0,
            float(scipy.stats.chi2.ppf(_CONFIDENCE, identification.degrees_of_freedom)),
        ),
        IdentificationCheck('least possible worst residual, half-units', worst, 0.0, 1.0),
        _zero_pair(coefficients),
    )


def _engine_gain(identification: Identification) -> IdentificationCheck:
    printed = float(ENGINE_TO_SLIP.gain)
    gain = 1.0 / identification.parameters.engine_inertia
    margin = _SIGMAS * gain * float(identification.relative_std[0])
    return IdentificationCheck('gain of P1 = 1 / J_m', gain, printed - margin, printed + margin)


def _zero_pair(coefficients: PrintedCoefficients) -> IdentificationCheck:
    printed = next(
        number for name, number in coefficients.numbers if (name, number.label) == ZERO_PAIR
    )
    predicted, std = predict_left_out(coefficients, *ZERO_PAIR)
    margin = _SIGMAS * float(np.hypot(std, printed.half_unit * np.sqrt(ROUNDING_VARIANCE)))
    name = f'{" ".join(ZERO_PAIR)} from the other eight, taken as {printed.text}'
    return IdentificationCheck(name, predicted, printed.value - margin, printed.value + margin)


def smallest_worst_residual(
    coefficients: PrintedCoefficients, start: np.ndarray
) -> tuple[float, np.ndarray]:
    """
    Return the least possible largest |residual| in half-units, and the logarithms that reach it.

    Up to 1, one driveline rounds to every printed number. Above 1 the programs need not settle:
    the value is then reached, but perhaps not the least.
    """
    goal = np.eye(len(FITTED) + 1)[-1]
    logarithms = _descend(coefficients, start, goal, worst=None)
    return float(np.abs(coefficients.residuals(logarithms)).max()), logarithms


def parameter_ranges(coefficients: PrintedCoefficients, centre: np.ndarray) -> np.ndarray:
    """
    Return the least and largest value of each fitted parameter, (7, 2), that the print allows.

    These are the ends of the set in which every residual is within one half-unit; `centre` are
    logarithms inside that set.
    """
    ranges = np.empty((len(FITTED), 2))
    for index, goal in enumerate(np.eye(len(FITTED), len(FITTED) + 1)):
        ends = [_descend(coefficients, centre, way * goal, worst=1.0) for way in (1.0, -1.0)]
        ranges[index] = np.exp([end[index] for end in ends])
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
