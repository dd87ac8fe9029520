"""One fit of driveline parameters to the stretches of a log, and the noise that it leaves."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from ddct_plant.base.errors import DdctError
from ddct_plant.identification.log_model import NUISANCE, Stretch, residuals_of, responses
from ddct_plant.models.parameters import DrivelineParameters

DAMPINGS = ('engine_damping', 'shaft_damping')
"""These may be zero, so their values are fitted; of all others the logarithms are."""
_PRIOR_STD = float(np.log(10.0))
"""Deviation of a logarithm from its start: what the log does not show stays where it was."""
_BOUND = float(np.log(1000.0))
_LEAST_SPREAD = 1e-9
"""Spread in rad/s of a speed that does not change."""
_MOST_ROUNDS = 5
_SETTLED = 0.05
"""Change of every estimate, over its deviation, after which no further round is made."""
MOST_LAGS = 10
WHITE_LAGS = 10
"""Over which the autocorrelations of what should be white are summed."""
_LEAST_VARIANCE = 1e-10
"""Least variance of a speed, over that of all. Noise without any could not be whitened."""


@dataclass(frozen=True, eq=False)
class NoiseModel:
    """r_k = a_1 r_(k-1) + ... + a_p r_(k-p) + e_k for each speed, e white of covariance S."""

    lags: np.ndarray
    """(3, p) a_1, ..., a_p of each of the three speeds."""
    factor: np.ndarray
    """(3, 3) lower triangular L with L L^T = S."""

    @property
    def order(self) -> int:
        """The number of lags, p."""
        return self.lags.shape[1]

    def white(self, values: np.ndarray) -> np.ndarray:
        """Return L^-1 e of residuals, (n, 3) or (n, 3, m), from the sample p on."""
        left = [
            scipy.signal.lfilter([1.0, *(-self.lags[output])], [1.0], values[:, output], axis=0)
            for output in range(3)
        ]
        whitened = np.tensordot(np.stack(left, axis=1), np.linalg.inv(self.factor), (1, 1))
        return np.moveaxis(whitened, -1, 1)[self.order :]


def fit_noise(residuals: Sequence[np.ndarray], fitted: int) -> NoiseModel:
    """
    Return the model of residuals (n, 3) of several stretches, its order by Akaike's criterion.

    `fitted` numbers were fitted to get them, which the covariance allows for.
    """
    models = [_of_order(residuals, order, fitted) for order in range(MOST_LAGS + 1)]
    return min(models, key=lambda model: model[0])[1]


def _of_order(
    residuals: Sequence[np.ndarray], order: int, fitted: int
) -> tuple[float, NoiseModel]:
    """Return the criterion, over the same samples for every order, and the model."""
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


class LogProblem:
    """
    One fit of the parameters called `free`.

    x holds ln(value / start), of a damping the change over torque per speed. The nuisances are
    linear, so they are projected out of the whitened residuals.
    """

    def __init__(
        self, stretches: Sequence[Stretch], start: DrivelineParameters, free: Sequence[str]
    ) -> None:
        self._stretches, self.free = stretches, free
        self._start: dict[str, float] = dict(vars(start))
        torques = np.concatenate([each.torques[:, :2].ravel() for each in stretches])
        speeds = np.concatenate([each.speeds[:, :2].ravel() for each in stretches])
        self.damping = float(np.sqrt(np.mean(torques**2) / np.mean(speeds**2)))
        spread = np.vstack([np.diff(each.speeds, axis=0) for each in stretches]).std(axis=0)
        self.noise = NoiseModel(np.zeros((3, 0)), np.diag(np.maximum(spread, _LEAST_SPREAD)))

    def values(self, x: np.ndarray) -> dict[str, float]:
        """Return every parameter by name."""
        found = dict(self._start)
        for name, change in zip(self.free, x.tolist(), strict=True):
            if name in DAMPINGS:
                found[name] += change * self.damping
            else:
                found[name] *= float(np.exp(change))
        return found

    def solve(self) -> tuple[np.ndarray, np.ndarray]:
        """
        Fit, and model the noise, in turn; return x and its covariance.

        The first fit takes the noise as white: what a wrong start leaves is no noise, and to
        whiten it would hide the way.
        """
        x, _ = self._fitted(np.zeros(len(self.free)), self._stretches)
        for _ in range(_MOST_ROUNDS):
            left = [residuals_of(self.values(x), each)[0] for each in self._stretches]
            self.noise = fit_noise(left, len(x) + NUISANCE * len(left))
            before = x
            x, covariance = self._fitted(x, self._stretches)
            if np.all(np.abs(x - before) < _SETTLED * np.sqrt(np.diag(covariance))):
                break
        return x, covariance

    def moved_by(self, x: np.ndarray, others: Sequence[Sequence[Stretch]]) -> np.ndarray:
        """Return how far the fits to other stretches of the same noise are from x on average."""
        return np.mean([self._fitted(x, each)[0] for each in others], axis=0) - x

    def _fitted(
        self, x: np.ndarray, stretches: Sequence[Stretch]
    ) -> tuple[np.ndarray, np.ndarray]:
        answer = scipy.optimize.least_squares(
            self._residuals,
            x,
            bounds=(-_BOUND, _BOUND),
            x_scale='jac',
            ftol=1e-7,
            xtol=1e-7,
            args=(stretches,),
        )
        if not answer.success:
            raise DdctError(f'the fit to the log does not converge: {answer.message}')
        return answer.x, np.linalg.inv(answer.jac.T @ answer.jac)

    def _residuals(self, x: np.ndarray, stretches: Sequence[Stretch]) -> np.ndarray:
        """Return what is left of the whitened residuals of all stretches, and x over its prior."""
        parts = []
        values = self.values(x)
        for stretch in stretches:
            forced, basis = responses(values, stretch)
            left = self.noise.white(stretch.speeds - forced).ravel()
            directions = np.linalg.qr(self.noise.white(basis).reshape(len(left), NUISANCE))[0]
            parts.append(left - directions @ (directions.T @ left))
        return np.concatenate([*parts, x / _PRIOR_STD])
