# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Least-squares problem of a fit to the stretches of a log, with the noise model."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
import scipy

from ddct_bringup.identification.from_log.delays import (
    BEND_OF,
    BEND_SCALE,
    BENDS,
    DELAY_SCALE_S,
    DELAYED,
    residuals_by_name,
    sampling_of,
    without_ends,
)
from ddct_bringup.identification.from_log.model import NUISANCE, responses
from ddct_bringup.identification.from_log.noise import NoiseModel, fit_noise
from ddct_bringup.identification.from_log.stretch import (
    SPEED_COLUMNS,
    TORQUE_COLUMNS,
    TORQUES,
    Stretch,
)
from ddct_bringup.logs.columns import MOST_DELAY_S
from ddct_plant.base.errors import DdctError
from ddct_plant.models.parameters import DrivelineParameters

DAMPINGS = ('engine_damping', 'shaft_damping')
"""Parameters that may be zero, so that their values are fitted; the others' logarithms are."""
_PRIOR_STD = float(np.log(10.0))
"""Prior standard deviation of a logarithm: undetermined parameters stay near their start."""
_DELAY_PRIOR = MOST_DELAY_S / DELAY_SCALE_S
"""Prior standard deviation of a delay, over its scale."""
_INSIDE = 0.999
"""Share of the bounds within which a fit starts."""
_BOUND = float(np.log(1000.0))
"""Bound of the change of a logarithm, damping or bend, in the units of x."""
_LEAST_SPREAD = 1e-9
"""Standard deviation in rad/s assumed for the steps of a constant speed."""
_MOST_ROUNDS = 5
"""Most rounds of fit and noise model."""
_STEP = 1e-6
"""
Difference step in x of the Jacobian.

The root of the machine epsilon, scipy's step, is too small for an exact log: there the rounding of
the speeds is as large as the residuals, and the fit takes many times as many iterations.
"""
_COARSE = 1e-4
"""Relative change of cost or x at which an approximate fit ends."""
_SETTLED = 0.05
"""Largest change of an estimate in the last round, over its standard deviation."""


def nothing() -> None:
    """Do nothing at an evaluation: the default of a fit without progress."""


class LogProblem:
    """
    Least-squares problem for the parameters and delays called `free`.

    x has ln(value / start) of a parameter, the change over torque per speed of a damping, the
    change over DELAY_SCALE_S of a delay, the value over BEND_SCALE of a bend. The nuisances are
    linear, so they are projected out of the whitened residuals.
    """

    def __init__(
        self,
        stretches: Sequence[Stretch],
        start: DrivelineParameters,
        delays: Mapping[str, float],
        free: Sequence[str],
        evaluated: Callable[[], None] = nothing,
    ) -> None:
        """Store what is fitted; `evaluated` is called at each evaluation of the residuals."""
        self._evaluated = evaluated
        self._whole, self.free = stretches, free
        self._start: dict[str, float] = start.values() | dict(delays)
        self._at: Mapping[str, float] = self._start
        driving = TORQUE_COLUMNS.places(*TORQUES)
        damped = SPEED_COLUMNS.places('engine_speed', 'shaft_speed')
        torques = np.concatenate([each.torques[:, driving].ravel() for each in stretches])
        speeds = np.concatenate([each.speeds[:, damped].ravel() for each in stretches])
        self.damping = float(np.sqrt(np.mean(torques**2) / np.mean(speeds**2)))
        spread = np.vstack([np.diff(each.speeds, axis=0) for each in stretches]).std(axis=0)
        self.noise = NoiseModel(np.zeros((3, 0)), np.diag(np.maximum(spread, _LEAST_SPREAD)))

    def values(self, x: np.ndarray) -> dict[str, float]:
        """Return every parameter, delay in s and bend at x, by name, in SI units."""
        found = dict(self._start)
        for name, change in zip(self.free, x.tolist(), strict=True):
            if name in DAMPINGS:
                found[name] += change * self.damping
            elif name in DELAYED:
                found[name] += change * DELAY_SCALE_S
            elif name.startswith(BEND_OF):
                found[name] = change * BEND_SCALE
            else:
                found[name] *= float(np.exp(change))
        return found

    def in_units(self, std: np.ndarray) -> dict[str, float]:
        """Return deviations by name: in SI units for dampings and delays, else relative."""
        scales = dict.fromkeys(DAMPINGS, self.damping) | dict.fromkeys(DELAYED, DELAY_SCALE_S)
        scales |= dict.fromkeys(BENDS, BEND_SCALE)
        return {n: scales.get(n, 1.0) * e for n, e in zip(self.free, std.tolist(), strict=True)}

    def solve(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """
        Alternate fit and noise model; return x, its covariance and the Jacobian of the residuals.

        The first fit assumes white noise: residuals of a wrong start are no noise, and a noise
        model of them would mask the error. It uses all samples; later fits use those whose torques
        are in the log at the present delays.
        """
        x = self._fitted(np.zeros(len(self.free)), self._whole, _COARSE)[0]
        for _ in range(_MOST_ROUNDS):
            self._at = self.values(x)
            stretches = self.used(self._whole)
            left = [residuals_by_name(self.values(x), each)[0] for each in stretches]
            self.noise = fit_noise(left, len(x) + NUISANCE * len(left))
            before = x
            x, jacobian = self._fitted(x, stretches)
            covariance = np.linalg.inv(jacobian.T @ jacobian)
            if np.all(np.abs(x - before) < _SETTLED * np.sqrt(np.diag(covariance))):
                break
        return x, covariance, jacobian[: -len(x)]

    def used(self, stretches: Sequence[Stretch]) -> list[Stretch]:
        """Return the stretches with the samples that the last round of the fit used."""
        return without_ends(stretches, self._at)

    def moved_by(self, x: np.ndarray, others: Sequence[Sequence[Stretch]]) -> np.ndarray:
        """Return the mean shift of x in fits to other stretches, with the present noise model."""
        fits = [self._fitted(x, self.used(each), _COARSE)[0] for each in others]
        return np.mean(fits, axis=0) - x

    def _fitted(
        self, x: np.ndarray, stretches: Sequence[Stretch], settled: float = 1e-7
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return x of the best fit and its Jacobian, whose last rows are those of the prior."""
        answer = scipy.optimize.least_squares(
            self._residuals,
            np.clip(x, -self._bounds * _INSIDE, self._bounds * _INSIDE),
            self._jacobian,
            bounds=(-self._bounds, self._bounds),
            x_scale='jac',
            ftol=settled,
            xtol=settled,
            args=(stretches,),
        )
        if not answer.success:
            raise DdctError(f'the fit to the log does not converge: {answer.message}')
        return answer.x, answer.jac

    @property
    def _bounds(self) -> np.ndarray:
        delay = MOST_DELAY_S / DELAY_SCALE_S
        return np.array([delay if name in DELAYED else _BOUND for name in self.free])

    def _residuals(self, x: np.ndarray, stretches: Sequence[Stretch]) -> np.ndarray:
        """Return the whitened residuals without nuisances of all stretches, then x over prior."""
        self._evaluated()
        parts = []
        values = self.values(x)
        for stretch in stretches:
            sampling = sampling_of(values, load_known=stretch.load_known)
            forced, basis = responses(values, sampling, stretch)
            left = self.noise.white(stretch.speeds - forced).ravel()
            directions = np.linalg.qr(self.noise.white(basis).reshape(len(left), NUISANCE))[0]
            parts.append(left - directions @ (directions.T @ left))
        return np.concatenate([*parts, x / self._prior])

    def _jacobian(self, x: np.ndarray, stretches: Sequence[Stretch]) -> np.ndarray:
        """Return d `_residuals` / d x, by forward differences."""
        here = self._residuals(x, stretches)
        moved = [self._residuals(x + step, stretches) for step in _STEP * np.eye(len(x))]
        return (np.column_stack(moved) - here[:, None]) / _STEP

    @property
    def _prior(self) -> np.ndarray:
        kinds = dict.fromkeys(DELAYED, _DELAY_PRIOR) | dict.fromkeys(BENDS, 1.0)
        return np.array([kinds.get(name, _PRIOR_STD) for name in self.free])
