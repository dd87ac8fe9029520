# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The nine printed coefficients of P2 and P3 as functions of the driveline parameters."""

import numpy as np

from ddct_plant.base.errors import ParameterError
from ddct_plant.models.driveline_model import clutch_to_slip, load_to_slip
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.models.printed import (
    CLUTCH_TO_SLIP,
    CLUTCH_TO_SLIP_AS_PRINTED,
    LOAD_TO_SLIP,
    PrintedNumber,
    PrintedTransferFunction,
)

FITTED = (
    'engine_inertia',
    'shaft_inertia',
    'shaft_damping',
    'halfshaft_damping',
    'halfshaft_stiffness',
    'total_ratio',
    'vehicle_inertia',
)
"""Names of the seven parameters that the coefficients determine; c_m is 0, as P1 = 4/s shows."""
_STEP = 1e-5
"""Central-difference step in the logarithm of a parameter: relative error about 1e-10."""


class PrintedCoefficients:
    """
    Coefficients in the order gain, zeros, poles of P2, then gain and zero of P3.

    P3's poles are P2's and P2's pole at 0 is exact, so nine numbers remain for seven parameters.
    Vectors of parameters are natural logarithms in the order of FITTED: all are positive.
    """

    def __init__(
        self,
        p2: PrintedTransferFunction,
        p3: PrintedTransferFunction = LOAD_TO_SLIP,
        p2_with_errata: PrintedTransferFunction | None = None,
    ) -> None:
        """
        Use the printed P_2 and P_3; raise ParameterError when their poles differ.

        `p2_with_errata` is P_2 as printed where `p2` has its errata corrected.
        """
        if p2.denominator != ('0', *p3.denominator):
            raise ParameterError(f'{p2.name} and {p3.name} must share their poles, apart from s')
        self.numbers: tuple[tuple[str, PrintedNumber], ...] = tuple(
            [(p2.name, number) for number in p2.numbers()]
            + [(p3.name, number) for number in p3.numbers()[:2]]
        )
        """Name of the transfer function and number of each coefficient, errata corrected, (9,)."""
        as_printed = (*(p2_with_errata or p2).numbers(), *p3.numbers()[:2])
        self.texts = tuple(number.text for number in as_printed)
        """Digits of each coefficient as printed, errata included, (9,)."""
        self._values = np.array([number.value for _, number in self.numbers])
        self._half_units = np.array([number.half_unit for _, number in self.numbers])

    def residuals(self, logarithms: np.ndarray) -> np.ndarray:
        """Return computed less printed, (9,), in half-units of the last printed digit."""
        return (computed_coefficients(with_fitted(logarithms)) - self._values) / self._half_units

    def jacobian(self, logarithms: np.ndarray) -> np.ndarray:
        """Return d residuals / d logarithms, (9, 7)."""
        columns = [
            (self.residuals(logarithms + step) - self.residuals(logarithms - step)) / (2 * _STEP)
            for step in _STEP * np.eye(len(FITTED))
        ]
        return np.column_stack(columns)

    def start(self) -> np.ndarray:
        """
        Return the logarithms of a closed-form estimate, exact but for c_prim c_sa in one term.

        With n and d the cubics of P2's zeros and poles, d_0/n_0 = (J_m + J_p)/J_p,
        d_1 = X + Y/J_p and n_1 = X + Y/(J_m + J_p), where X = k_sa/J_v and Y = k_sa/tau^2.
        """
        gain, n_a, n_b, n_c, d_a, d_b, d_c, gain_3, corner = self._values
        ratio = d_a * d_c / (n_a * n_c)
        n_1, d_1 = n_c + n_a * n_b, d_c + d_a * d_b
        engine = -ratio / gain
        shaft = engine / (ratio - 1.0)
        y = (d_1 - n_1) / (1.0 / shaft - 1.0 / (shaft + engine))
        x = d_1 - y / shaft
        tau = x / (corner * gain_3 * shaft)
        stiffness = y * tau**2
        vehicle = stiffness / x
        damping = d_a * d_c * shaft * vehicle / stiffness
        return np.log([engine, shaft, damping, stiffness / corner, stiffness, tau, vehicle])


PRINTED = PrintedCoefficients(CLUTCH_TO_SLIP, p2_with_errata=CLUTCH_TO_SLIP_AS_PRINTED)
"""Printed coefficients of the thesis, with the erratum corrected."""


def with_fitted(logarithms: np.ndarray) -> DrivelineParameters:
    """Return the driveline with the fitted parameters exp(`logarithms`), (7,), and c_m = 0."""
    values = np.exp(logarithms).tolist()
    return DrivelineParameters.from_values(
        {'engine_damping': 0.0, **dict(zip(FITTED, values, strict=True))}
    )


def computed_coefficients(parameters: DrivelineParameters) -> np.ndarray:
    """Return the nine coefficients, (9,), of a driveline with c_m = 0."""
    p2, p3 = clutch_to_slip(parameters), load_to_slip(parameters)
    return np.hstack([p2.gain, *p2.numerator, *p2.denominator[1:], p3.gain, *p3.numerator])
