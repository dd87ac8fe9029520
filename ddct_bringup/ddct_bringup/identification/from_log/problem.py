# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Least-squares problem of a fit to the stretches of a log, with the noise of the speeds."""

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache

import numpy as np
import scipy

from ddct_bringup.identification.from_log.response import (
    NUISANCE,
    residuals_of,
    responses,
    shifts_of,
)
from ddct_bringup.identification.from_log.stretches import OUTPUTS, Stretch
from ddct_bringup.identification.from_log.unknowns import Unknowns
from ddct_plant.base.errors import DdctError

_LAGS = 2
"""Lags of the noise model."""
_FEWEST = 20
"""Fewest samples of a used stretch, without the samples that the delays cost."""
_LEAST_VARIANCE = 1e-10
"""Least variance of a speed, over the sum of all: noise of zero variance cannot be whitened."""
_ROUNDING = 1e-12
"""Least standard deviation of a speed in rad/s, that of the rounding in an exact log."""
_INSIDE = 0.999
"""Share of the bounds within which a fit starts."""
_STEP = 1e-6
"""
Difference step in x of the Jacobian.

The root of the machine epsilon, scipy's step, is too small for an exact log: there the rounding of
the speeds is as large as the residuals, and the fit takes many times as many iterations.
"""
_COARSE, _FINE = 1e-4, 1e-7
"""Relative change of cost or x at which an approximate fit ends, and a final one."""
_MOST_ROUNDS, _SETTLED = 5, 0.05
"""Most rounds of fit and noise model, and the change over the deviation at which they end."""


def used(stretches: Sequence[Stretch], values: Mapping[str, float]) -> list[Stretch]:
    """
    Return the stretches without the samples whose torques are not in the log.

    A torque with the delay d is in the log d after the sample of a speed. Raise DdctError when no
    stretch is left.
    """
    kept = []
    for each in stretches:
        shifts, _ = shifts_of(values, each)
        step = np.median(np.diff(each.time_s))
        first, last = each.time_s[0] - step, each.time_s[-1] + step
        rows = (each.time_s + shifts.min() >= first) & (each.time_s + shifts.max() <= last)
        if rows.sum() >= _FEWEST:
            kept.append(each.rows(rows))
    if not kept:
        raise DdctError('the delays leave no stretch of the log: give a longer log')
    return kept


class _Noise:
    """r_k = a_1 r_(k-1) + ... + a_p r_(k-p) + e_k for each speed, e white of covariance S."""

    def __init__(self, residuals: Sequence[np.ndarray], fitted: int, lags: int = _LAGS) -> None:
        """
        Fit the model to residuals (n, 3) of several stretches.

        `fitted` is the number of fitted values behind them, by which the covariance is corrected.
        """
        now = np.vstack([each[lags:] for each in residuals])
        before = [
            np.vstack([each[lags - lag : len(each) - lag] for each in residuals])
            for lag in range(1, lags + 1)
        ]
        self._shares = np.zeros((lags, len(OUTPUTS)))
        for output in range(len(OUTPUTS) if lags else 0):
            table = np.column_stack([each[:, output] for each in before])
            self._shares[:, output] = np.linalg.lstsq(table, now[:, output], rcond=None)[0]
        left = now - sum(a * each for a, each in zip(self._shares, before, strict=True))
        covariance = left.T @ left / max(len(now) - lags - fitted / len(OUTPUTS), 1.0)
        least = max(_LEAST_VARIANCE * float(np.trace(covariance)), _ROUNDING**2)
        factor = np.linalg.cholesky(covariance + least * np.eye(len(OUTPUTS)))
        self._whitening = np.linalg.inv(factor)

    def white(self, values: np.ndarray) -> np.ndarray:
        """Return L^-1 e of residuals, (n, 3, m), with S = L L^T, from the sample p on."""
        lags, samples = len(self._shares), len(values)
        left = values[lags:].copy()
        for lag, share in enumerate(self._shares, start=1):
            left -= share[:, None] * values[lags - lag : samples - lag]
        return np.einsum('ij,njm->nim', self._whitening, left)


class LogProblem:
    """Least-squares problem for unknowns; the nuisances are projected out, as they are linear."""

    def __init__(
        self, unknowns: Unknowns, stretches: Sequence[Stretch], evaluated: Callable[[], None]
    ) -> None:
        """Begin with white noise as large as the steps of the speeds."""
        self._unknowns, self._whole, self._evaluated = unknowns, stretches, evaluated
        self._at: Mapping[str, float] = {}
        self._noise = _Noise([np.diff(each.speeds, axis=0) for each in stretches], 0, 0)

    def solve(self) -> tuple[np.ndarray, np.ndarray]:
        """
        Alternate fit and noise model; return x and the variances of its entries, (n,) each.

        The first fit assumes white noise: residuals of a wrong start are no noise, and a noise
        model of them would mask the error. It uses all samples; later fits use those whose torques
        are in the log at the present delays. A variance is the larger one of noise with a memory
        and of noise without.
        """
        x = self._fitted(np.zeros(len(self._unknowns.names)), self._whole, _COARSE)[0]
        for _ in range(_MOST_ROUNDS):
            values = self._unknowns.values(x)
            self._at, before = values, x
            stretches = self._used(self._whole)
            left = [residuals_of(values, each)[0] for each in stretches]
            fitted = len(x) + NUISANCE * len(left)
            self._noise = _Noise(left, fitted)
            x, jacobian = self._fitted(x, stretches, _FINE)
            variance = _variance(jacobian)
            if np.all(np.abs(x - before) < _SETTLED * np.sqrt(variance)):
                break
        # The model of a short log has less noise at low frequencies than there is.
        model, self._noise = self._noise, _Noise(left, fitted, 0)
        jacobian = self._jacobian(x, stretches, self._residuals(x, stretches))
        variance = np.maximum(variance, _variance(jacobian))
        self._noise = model
        return x, variance

    def moves(self, x: np.ndarray, others: Sequence[Sequence[Stretch]]) -> np.ndarray:
        """Return the steps from x to the fits to other logs, (k, n), by Gauss and Newton."""
        steps = np.zeros((len(others), len(x)))
        for step, each in zip(steps, map(self._used, others), strict=True):
            residuals = self._residuals(x, each)
            jacobian = self._jacobian(x, each, residuals)
            step[:] = np.linalg.lstsq(jacobian, -residuals, rcond=None)[0]
        return steps

    def _used(self, stretches: Sequence[Stretch]) -> list[Stretch]:
        """Return the stretches with the samples that the last round of the fit used."""
        return used(stretches, self._at)

    def _fitted(
        self, x: np.ndarray, stretches: Sequence[Stretch], settled: float
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return x of the best fit, and the Jacobian of the residuals there."""
        bound = self._unknowns.bound

        @lru_cache(maxsize=1)  # scipy asks for the Jacobian where it has just had the residuals
        def residuals(place: bytes) -> np.ndarray:
            return self._residuals(np.frombuffer(place), stretches)

        answer = scipy.optimize.least_squares(
            lambda x: residuals(x.tobytes()),
            np.clip(x, -bound * _INSIDE, bound * _INSIDE),
            lambda x: self._jacobian(x, stretches, residuals(x.tobytes())),
            bounds=(-bound, bound),
            x_scale='jac',
            ftol=settled,
            xtol=settled,
        )
        if not answer.success:
            raise DdctError(f'the fit to the log does not converge: {answer.message}')
        return answer.x, answer.jac

    def _residuals(self, x: np.ndarray, stretches: Sequence[Stretch]) -> np.ndarray:
        """Return the whitened residuals without nuisances of all stretches, then x over prior."""
        self._evaluated()
        parts, values = [], self._unknowns.values(x)
        for stretch in stretches:
            forced, basis = responses(values, stretch)
            left = self._noise.white((stretch.speeds - forced)[:, :, None]).ravel()
            directions = np.linalg.qr(self._noise.white(basis).reshape(len(left), NUISANCE))[0]
            parts.append(left - directions @ (directions.T @ left))
        return np.concatenate([*parts, x / self._unknowns.prior])

    def _jacobian(
        self, x: np.ndarray, stretches: Sequence[Stretch], here: np.ndarray
    ) -> np.ndarray:
        """Return d `_residuals` / d x by forward differences, from the residuals at x."""
        moved = [self._residuals(x + step, stretches) for step in _STEP * np.eye(len(x))]
        return (np.column_stack(moved) - here[:, None]) / _STEP


def _variance(jacobian: np.ndarray) -> np.ndarray:
    return np.asarray(np.diag(np.linalg.inv(jacobian.T @ jacobian)))
