"""Whether what a fit leaves of the speeds depends on the torques, as no noise of a sensor does."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from ddct_plant.identification.from_log.delays import left_of, sampling_of
from ddct_plant.identification.from_log.model import NUISANCE, OUTPUTS, Stretch, responses
from ddct_plant.identification.from_log.noise import NoiseModel

_LAGS = range(-3, 7)
"""Steps of the speeds by which the torques are shifted against a speed."""
_LEAST = 1e-9
"""Least size of a direction, where torques do not change."""
_RANK = 1e-6
"""Least share of the largest direction of the shifted torques that counts as one."""


@dataclass(frozen=True)
class Dependence:
    """What of the residual of one speed follows the torques."""

    p_value: float
    """Probability that noise alone follows them as well."""
    rms_rad_s: float
    """R.m.s. of what follows them, beyond what noise would, of the part that is not predicted."""


def dependences(
    values: Mapping[str, float],
    noise: NoiseModel,
    stretches: Sequence[Stretch],
    jacobian: np.ndarray,
    noisier: Sequence[Sequence[Stretch]] = (),
) -> list[Dependence]:
    """
    Return it for w_m, w_p and w_r, at the parameters and delays of a fit to `stretches`.

    The whitened residual is regressed on C_m and C_f, shifted by steps of the log and whitened
    too. What start, C_load and the fitted numbers can make up for is taken out of both before;
    `jacobian` (n, fitted) is that of the whitened residuals. The sum of squares of what is
    explained is chi-square for noise that does not depend on the torques. Noise of the torques
    themselves does: `noisier` are the stretches with twice its variance, and what they add is
    allowed for, twice, as the noise that is added is half of what is then regressed on.
    """
    taken = np.linalg.qr(jacobian)[0]
    residual = _residual(values, noise, stretches)
    found = []
    for output in range(OUTPUTS):
        rank, size = _explained(values, noise, stretches, output, residual, taken)
        added = [
            _explained(
                values, noise, each, output, _residual(values, noise, each) - residual, taken
            )[1]
            for each in noisier
        ]
        expected = 2.0 * float(np.mean(added)) if added else 0.0
        p_value = float(
            scipy.stats.ncx2.sf(size, rank, expected)
            if expected
            else scipy.stats.chi2.sf(size, rank)
        )
        excess = max(size - rank - expected, 0.0) / (len(residual) / OUTPUTS)
        found.append(Dependence(p_value, float(noise.factor[output, output] * np.sqrt(excess))))
    return found


def _residual(
    values: Mapping[str, float], noise: NoiseModel, stretches: Sequence[Stretch]
) -> np.ndarray:
    """Return the whitened residuals of all stretches in a row."""
    return np.concatenate(
        [_projected(values, noise, e, left_of(values, e)[0][:, :, None])[:, 0] for e in stretches]
    )


def _explained(
    values: Mapping[str, float],
    noise: NoiseModel,
    stretches: Sequence[Stretch],
    output: int,
    residual: np.ndarray,
    taken: np.ndarray,
) -> tuple[int, float]:
    """Return how many directions the shifted torques have, and the sum of squares along them."""
    white = np.vstack(
        [_projected(values, noise, e, _shifted_torques(values, e, output)) for e in stretches]
    )
    white = white - taken @ (taken.T @ white)
    directions, sizes, _ = np.linalg.svd(white, full_matrices=False)
    kept = directions[:, sizes > max(_RANK * sizes[0], _LEAST)]
    along = kept.T @ (residual - taken @ (taken.T @ residual))
    return kept.shape[1], float(along @ along)


def _projected(
    values: Mapping[str, float], noise: NoiseModel, stretch: Stretch, columns: np.ndarray
) -> np.ndarray:
    """Return columns (n, 3, q) whitened, without what start and C_load can make up for."""
    basis = responses(values, sampling_of(values, load_known=stretch.load_known), stretch)[1]
    white = noise.white(columns)
    white = white.reshape(-1, columns.shape[2])
    directions = np.linalg.qr(noise.white(basis).reshape(len(white), NUISANCE))[0]
    return white - directions @ (directions.T @ white)


def _shifted_torques(values: Mapping[str, float], stretch: Stretch, output: int) -> np.ndarray:
    """Return (n, 3, q), in the column of one speed C_m and C_f at the times about each sample."""
    shifts = sampling_of(values, load_known=stretch.load_known).shifts[output]
    step = float(np.median(np.diff(stretch.time_s)))
    found = np.zeros((len(stretch.time_s), OUTPUTS, 2 * len(_LAGS)))
    found[:, output] = np.column_stack(
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
    return found
