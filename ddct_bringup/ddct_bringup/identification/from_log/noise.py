# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Noise model of the speeds of a log: an autoregressive model of the residuals of a fit."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

MOST_LAGS = 10
"""Largest order of a noise model."""
WHITE_LAGS = 10
"""Number of lags of the autocorrelations in the test of whiteness."""
_LEAST_VARIANCE = 1e-10
"""Least variance of a speed, over the sum of all: noise of zero variance cannot be whitened."""


@dataclass(frozen=True, eq=False)
class NoiseModel:
    """r_k = a_1 r_(k-1) + ... + a_p r_(k-p) + e_k for each speed, e white of covariance S."""

    lags: np.ndarray
    """Coefficients a_1, ..., a_p of each of the three speeds, (3, p)."""
    factor: np.ndarray
    """Lower triangular L with L L^T = S, (3, 3)."""

    @property
    def order(self) -> int:
        """Number of lags p."""
        return self.lags.shape[1]

    def white(self, values: np.ndarray) -> np.ndarray:
        """Return L^-1 e of residuals, (n, 3) or (n, 3, m), from the sample p on."""
        order, samples = self.order, len(values)
        left = values[order:].copy()
        for lag, share in enumerate(self.lags.T, start=1):
            share = share.reshape(3, *(1,) * (values.ndim - 2))
            left -= share * values[order - lag : samples - lag]
        whitened = np.tensordot(left, np.linalg.inv(self.factor), (1, 1))
        return np.moveaxis(whitened, -1, 1)


def fit_noise(residuals: Sequence[np.ndarray], fitted: int) -> NoiseModel:
    """
    Return the model of residuals (n, 3) of several stretches, its order by Akaike's criterion.

    `fitted` is the number of fitted values behind the residuals, by which the covariance is
    corrected.
    """
    models = [_of_order(residuals, order, fitted) for order in range(MOST_LAGS + 1)]
    return min(models, key=lambda model: model[0])[1]


def _of_order(
    residuals: Sequence[np.ndarray], order: int, fitted: int
) -> tuple[float, NoiseModel]:
    """Return Akaike's criterion, over the same samples for every order, and the model."""
    now = np.vstack([each[MOST_LAGS:] for each in residuals])
    lags, left = np.zeros((3, order)), now.copy()
    for output in range(3) if order else ():
        before = np.vstack(
            [
                np.column_stack(
                    [each[MOST_LAGS - lag : -lag, output] for lag in range(1, order + 1)]
                )
                for each in residuals
            ]
        )
        lags[output] = np.linalg.lstsq(before, now[:, output], rcond=None)[0]
        left[:, output] -= before @ lags[output]
    samples = len(now)
    covariance = left.T @ left / samples
    covariance += np.eye(3) * max(_LEAST_VARIANCE * np.trace(covariance), 1e-24)
    criterion = samples * float(np.linalg.slogdet(covariance)[1]) + 2 * 3 * order
    share = samples / max(samples - order - fitted / 3.0, 1.0)
    return criterion, NoiseModel(lags, np.linalg.cholesky(covariance * share))


def whiteness(whitened: Sequence[np.ndarray]) -> list[float]:
    """Return for each of the three speeds the p-value of Ljung and Box over WHITE_LAGS lags."""
    found = []
    for output in range(3):
        parts = [each[:, output] - each[:, output].mean() for each in whitened]
        total = sum(len(part) for part in parts)
        power = sum(float(part @ part) for part in parts)
        statistic = 0.0
        for lag in range(1, WHITE_LAGS + 1):
            product = sum(float(part[lag:] @ part[:-lag]) for part in parts)
            statistic += (product / power) ** 2 / (total - lag)
        found.append(float(scipy.stats.chi2.sf(total * (total + 2.0) * statistic, WHITE_LAGS)))
    return found
