# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Driveline parameters from the printed transfer functions, by weighted least squares."""

from dataclasses import dataclass

import numpy as np
import scipy

from ddct_bringup.identification.coefficients import (
    FITTED,
    PRINTED,
    PrintedCoefficients,
    computed_coefficients,
    with_fitted,
)
from ddct_plant.base.errors import DdctError
from ddct_plant.models.parameters import DrivelineParameters

ROUNDING_VARIANCE = 1.0 / 3.0
"""Variance of a rounding error, uniform within one half-unit, in half-units squared."""
_SINGULAR = 1e8
"""Condition number above which some combination of parameters is not determined."""


@dataclass(frozen=True)
class CoefficientFit:
    """One printed coefficient, and its value for the identified driveline."""

    transfer_function: str
    """Name of the transfer function, such as 'P2'."""
    coefficient: str
    """Label of the coefficient, such as 'zero c'."""
    printed: str
    """Number as printed, an erratum included."""
    taken: str
    """Number that the fit takes: the printed one, or an erratum corrected."""
    computed: float
    """Value for the identified driveline."""
    residual_half_units: float
    """Residual: computed less taken, in half-units of the last printed digit."""


@dataclass(frozen=True, eq=False)
class Identification:
    """The weighted least-squares fit; vectors of parameters are in the order of FITTED."""

    parameters: DrivelineParameters
    """Parameters of the best fit, not rounded."""
    relative_std: np.ndarray
    """Standard deviation of each fitted parameter over its value, (7,)."""
    condition: float
    """Condition number of the weighted Jacobian with respect to the logarithms."""
    weakest_direction: np.ndarray
    """Unit vector of relative parameter changes that moves the coefficients least, (7,)."""
    coefficients: tuple[CoefficientFit, ...]

    @property
    def residuals(self) -> np.ndarray:
        """Residuals in half-units of the last printed digit, (9,)."""
        return np.array([fit.residual_half_units for fit in self.coefficients])

    @property
    def degrees_of_freedom(self) -> int:
        """Degrees of freedom: number of coefficients less number of parameters."""
        return len(self.coefficients) - len(FITTED)

    @property
    def chi_square(self) -> float:
        """
        Chi-square of the fit: the sum of squared residuals over the variance of rounding.

        Rounding is uniform rather than normal, so comparing it with the chi-square distribution
        of `degrees_of_freedom` is approximate.
        """
        return float(self.residuals @ self.residuals / ROUNDING_VARIANCE)

    @property
    def logarithms(self) -> np.ndarray:
        """Natural logarithms of the fitted parameters, (7,)."""
        values = self.parameters.values()
        return np.log([values[name] for name in FITTED])


def identify_driveline(coefficients: PrintedCoefficients = PRINTED) -> Identification:
    """
    Return the driveline of Section 1.5 whose P_2 and P_3 come closest to the printed ones.

    Each coefficient weighs by the half-unit of its last printed digit; c_m = 0. The covariance is
    (J^T J)^-1 times the variance of rounding: print rounding is taken as the only error, uniform
    and independent. Raise DdctError when the fit does not converge.
    """
    logarithms, covariance = _fit(coefficients, slice(None))
    std = np.sqrt(np.diag(covariance))
    singular = np.linalg.svd(coefficients.jacobian(logarithms))
    parameters = with_fitted(logarithms)
    rows = zip(
        coefficients.numbers,
        coefficients.texts,
        computed_coefficients(parameters).tolist(),
        coefficients.residuals(logarithms).tolist(),
        strict=True,
    )
    return Identification(
        parameters=parameters,
        relative_std=std,
        condition=float(singular.S[0] / singular.S[-1]),
        weakest_direction=singular.Vh[-1],
        coefficients=tuple(
            CoefficientFit(name, number.label, text, number.text, computed, residual)
            for (name, number), text, computed, residual in rows
        ),
    )


def predict_left_out(
    coefficients: PrintedCoefficients, name: str, coefficient: str
) -> tuple[float, float]:
    """
    Return one coefficient as the other eight predict it, and its standard deviation.

    Raise DdctError for a coefficient that is not among the nine, or that the others do not
    determine: each of the two gains alone determines the size of its transfer function.
    """
    labels = [(function, number.label) for function, number in coefficients.numbers]
    if (name, coefficient) not in labels:
        raise DdctError(f'{name} has no coefficient {coefficient!r} to leave out', key=name)
    index = labels.index((name, coefficient))
    kept = np.arange(len(labels)) != index
    if np.linalg.cond(coefficients.jacobian(coefficients.start())[kept]) > _SINGULAR:
        raise DdctError(f'the other coefficients do not determine {name} {coefficient}', key=name)
    logarithms, covariance = _fit(coefficients, kept)
    gradient = coefficients.jacobian(logarithms)[index]
    half_unit = coefficients.numbers[index][1].half_unit
    std = half_unit * np.sqrt(gradient @ covariance @ gradient)
    return float(computed_coefficients(with_fitted(logarithms))[index]), float(std)


def _fit(
    coefficients: PrintedCoefficients, kept: np.ndarray | slice
) -> tuple[np.ndarray, np.ndarray]:
    """Return the (7,) logarithms that fit the coefficients `kept`, and their covariance."""
    answer = scipy.optimize.least_squares(
        lambda logarithms: coefficients.residuals(logarithms)[kept],
        coefficients.start(),
        jac=lambda logarithms: coefficients.jacobian(logarithms)[kept],
        x_scale='jac',
        xtol=1e-14,
        ftol=1e-14,
        gtol=1e-14,
    )
    if not answer.success:
        raise DdctError(f'identification of the driveline does not converge: {answer.message}')
    jacobian = coefficients.jacobian(answer.x)[kept]
    return answer.x, np.linalg.inv(jacobian.T @ jacobian) * ROUNDING_VARIANCE
