# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Test whether residuals of a fit depend on the torques, which sensor noise does not."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from ddct_bringup.identification.from_log.delays import residuals_by_name, sampling_of
from ddct_bringup.identification.from_log.model import NUISANCE, OUTPUTS, responses
from ddct_bringup.identification.from_log.noise import NoiseModel
from ddct_bringup.identification.from_log.stretch import Stretch

_LAGS = range(-3, 7)
"""Lags of the torques relative to a speed, in steps of the speeds."""
_LEAST = 1e-9
"""Least singular value of a used direction, for torques that do not change."""
_RANK = 1e-6
"""Least singular value of a used direction, over the largest of the shifted torques."""


@dataclass(frozen=True)
class Dependence:
    """Dependence of the residual of one speed on the torques."""

    p_value: float
    """Probability that noise alone gives at least this dependence."""
    rms_rad_s: float
    """R.m.s. in rad/s of the dependent part of the residual, beyond that expected of noise."""


def dependences(
    values: Mapping[str, float],
    noise: NoiseModel,
    stretches: Sequence[Stretch],
    jacobian: np.ndarray,
    noisier: Sequence[Sequence[Stretch]] = (),
) -> list[Dependence]:
    """
    Return the dependences of w_m, w_p and w_r at the parameters and delays of a fit.

    The whitened residual is regressed on C_m and C_f, shifted by steps of the log and whitened
    too. Initial state, C_load and the fitted numbers are projected out of both before;
    `jacobian` (n, fitted) is that of the whitened residuals. The explained sum of squares is
    chi-square for noise that does not depend on the torques. Noise of the torques themselves does:
    `noisier` are the stretches with twice its variance, and their additional sum of squares is
    allowed for, twice, as the added noise is half of that in the regressors.
    """
    fitted_basis = np.linalg.qr(jacobian)[0]
    residual = _residual(values, noise, stretches)
    found = []
    for output in range(OUTPUTS):
        rank, explained = _explained(values, noise, stretches, output, residual, fitted_basis)
        added = [
            _explained(
                values,
                noise,
                each,
                output,
                _residual(values, noise, each) - residual,
                fitted_basis,
            )[1]
            for each in noisier
        ]
        expected = 2.0 * float(np.mean(added)) if added else 0.0
        p_value = float(
            scipy.stats.ncx2.sf(explained, rank, expected)
            if expected
            else scipy.stats.chi2.sf(explained, rank)
        )
        excess = max(explained - rank - expected, 0.0) / (len(residual) / OUTPUTS)
        found.append(Dependence(p_value, float(noise.factor[output, output] * np.sqrt(excess))))
    return found


def _residual(
    values: Mapping[str, float], noise: NoiseModel, stretches: Sequence[Stretch]
) -> np.ndarray:
    """Return the whitened residuals of all stretches, concatenated."""
    return np.concatenate(
        [
            _projected(values, noise, each, residuals_by_name(values, each)[0][:, :, None])[:, 0]
            for each in stretches
        ]
    )


def _explained(
    values: Mapping[str, float],
    noise: NoiseModel,
    stretches: Sequence[Stretch],
    output: int,
    residual: np.ndarray,
    fitted_basis: np.ndarray,
) -> tuple[int, float]:
    """Return the rank of the shifted torques, and the sum of squares that they explain."""
    white = np.vstack(
        [
            _projected(values, noise, each, _shifted_torques(values, each, output))
            for each in stretches
        ]
    )
    white = white - fitted_basis @ (fitted_basis.T @ white)
    directions, sizes, _ = np.linalg.svd(white, full_matrices=False)
    kept = directions[:, sizes > max(_RANK * sizes[0], _LEAST)]
    along = kept.T @ (residual - fitted_basis @ (fitted_basis.T @ residual))
    return kept.shape[1], float(along @ along)


def _projected(
    values: Mapping[str, float], noise: NoiseModel, stretch: Stretch, columns: np.ndarray
) -> np.ndarray:
    """Return the whitened columns (n, 3, q) with initial state and C_load projected out."""
    basis = responses(values, sampling_of(values, load_known=stretch.load_known), stretch)[1]
    white = noise.white(columns)
    white = white.reshape(-1, columns.shape[2])
    directions = np.linalg.qr(noise.white(basis).reshape(len(white), NUISANCE))[0]
    return white - directions @ (directions.T @ white)


def _shifted_torques(values: Mapping[str, float], stretch: Stretch, output: int) -> np.ndarray:
    """Return C_m and C_f at the lags about each sample, (n, 3, q), in the column of one speed."""
    shifts = sampling_of(values, load_known=stretch.load_known).shifts[output]
    step = float(np.median(np.diff(stretch.time_s)))
    columns = np.zeros((len(stretch.time_s), OUTPUTS, 2 * len(_LAGS)))
    columns[:, output] = np.column_stack(
        [
            np.interp(
                stretch.time_s + shifts[torque] - lag * step,
                stretch.grid_s,
                stretch.torques[:, torque],
            )
            for torque in range(2)
            for lag in _LAGS
        ]
    )
    return columns
