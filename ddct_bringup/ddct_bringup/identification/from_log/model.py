# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Response of the driveline of Section 1.5 to measured torques, exact between their samples.

Model of a log: every sample is the true value at one instant, a delay before the time of its row,
plus noise. Each signal has a delay of its own. Between its samples a torque is linear or held,
according to the column map.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import scipy

from ddct_bringup.identification.from_log.stretch import SPEED_COLUMNS, Stretch
from ddct_plant.models.driveline_model import STATES, TORQUES, driveline_matrices
from ddct_plant.models.gearbox import EngagedGear
from ddct_plant.models.parameters import DrivelineParameters

_MEASURED = STATES.places(*SPEED_COLUMNS)
OUTPUTS = len(_MEASURED)
"""Number of outputs: w_m, w_p, w_r."""
NUISANCE = len(STATES) + 1
"""Number of nuisances of each stretch: the states at its start, and C_load."""
_SMALL = 1e-2
"""Size of z up to which the series of phi_1 and phi_2 are used."""
_NEARLY_CONSTANT = 1e-6
"""Largest pole times time of a mode that is treated as an integrator."""
_NOTHING = 1e-12
"""Size of an entry of a mode that counts as zero, over the largest entry."""
_Mode = tuple[complex, np.ndarray, np.ndarray, np.ndarray]
"""
Pole, right eigenvector in the outputs (3,), left eigenvector (n,), and what each torque adds (3,).
"""


@dataclass(frozen=True)
class Sampling:
    """Relation of the rows of a log to its signals: delays and bends."""

    speeds: tuple[float, ...] = (0.0,) * OUTPUTS
    """Delays of w_m, w_p, w_r in s."""
    torques: tuple[float, ...] = (0.0,) * 3
    """Delays of C_m, C_f, C_load in s."""
    second_differences: tuple[float, ...] = (0.0,) * 3
    """Bends of C_m, C_f, C_load: shares of the second difference missed by linear
    interpolation."""

    @property
    def shifts(self) -> np.ndarray:
        """Time shifts in s from the row of a speed to the rows of the torques then, (3, 3)."""
        return np.array(self.torques) - np.array(self.speeds)[:, None]


def responses(
    values: Mapping[str, float], sampling: Sampling, stretch: Stretch
) -> tuple[np.ndarray, np.ndarray]:
    """
    Return the speeds (n, 3) from rest under the torques, and the nuisances' responses (n, 3, 5).

    `values` are those of DrivelineParameters by name; while a fit runs a damping may be negative.

    Over a step h the modes z' = lambda z + v with v linear are advanced exactly by z_1 = e^(lambda
    h) z_0 + h (phi_1 - phi_2) v_0 + h phi_2 v_1. The system is linear, so for a torque with the
    delay d in the log the response to the logged torque is d later.
    """
    forced = np.zeros((len(stretch.time_s), OUTPUTS))
    basis = np.zeros((len(stretch.time_s), OUTPUTS, NUISANCE))
    lags = np.array(sampling.speeds)
    since = stretch.time_s - stretch.time_s[0]
    shifts = sampling.shifts.tolist()
    places = {shift: _Place.of(stretch, shift) for shift in {each for r in shifts for each in r}}
    for pole, shape, inverse, driven in _modes(tuple(values.items())):
        free = np.exp(pole * since)[:, None] * np.exp(-pole * lags)
        basis[:, :, :-1] += np.real((free * shape)[:, :, None] * inverse)
        if not stretch.load_known:
            load = driven[TORQUES['load_torque']]
            basis[:, :, -1] += np.real(
                _under_one(pole, since[:, None] - lags, free) * shape * load
            )
        for torque in _present(driven):
            run = _ModeResponse(pole, stretch, torque, sampling.second_differences[torque])
            for output in _present(shape):
                at = run.at(places[shifts[output][torque]])
                forced[:, output] += np.real(shape[output] * driven[torque] * at)
    return forced, basis


def residuals_of(
    values: Mapping[str, float], sampling: Sampling, stretch: Stretch
) -> tuple[np.ndarray, np.ndarray]:
    """
    Return the residuals, measured less computed speeds (n, 3) in rad/s, and the nuisances (5,).

    The nuisances, initial state and C_load of the stretch, are fitted by least squares.
    """
    forced, basis = responses(values, sampling, stretch)
    left = stretch.speeds - forced
    nuisance = np.linalg.lstsq(basis.reshape(-1, NUISANCE), left.ravel(), rcond=None)[0]
    return left - basis @ nuisance, nuisance


@lru_cache(maxsize=1)  # all stretches of a log have the driveline of one evaluation
def _modes(values: tuple[tuple[str, float], ...]) -> list[_Mode]:
    """
    Return the modes of the driveline with these values by name.

    Of a conjugate pair only one pole is returned, with twice its outputs: the real part is used.
    """
    named = dict(values)
    unchecked = SimpleNamespace(**named, gear=EngagedGear(named['total_ratio']))
    model = driveline_matrices(cast(DrivelineParameters, unchecked))
    poles, vectors = np.linalg.eig(model.a)
    poles, vectors = poles.astype(complex), vectors.astype(complex)
    inverse = np.linalg.inv(vectors)
    modes: list[_Mode] = []
    for pole, shape, left in zip(poles.tolist(), vectors[_MEASURED, :].T, inverse, strict=True):
        if pole.imag > 0.0:
            modes.append((pole, 2.0 * shape, left, left @ model.b))
        elif not pole.imag:
            # In real numbers, which take half the time of complex ones.
            modes.append((pole.real, shape.real, left.real, left.real @ model.b))
    return modes


def _present(entries: np.ndarray) -> np.ndarray:
    """Return the indices of the entries that are not zero."""
    sizes = np.abs(entries)
    return np.flatnonzero(sizes > _NOTHING * sizes.max())


@dataclass(frozen=True, eq=False)
class _Place:
    """Position of the shifted times of the samples on the grid."""

    before: np.ndarray
    """Index of the grid point before each sample, (n,)."""
    rest_s: Any
    """Time in s from that grid point, (n,); one number where all are equal."""
    step_s: float
    """Step of the grid in s."""

    @classmethod
    def of(cls, stretch: Stretch, shift: float) -> '_Place':
        step = float(stretch.grid_s[1] - stretch.grid_s[0])
        place = (stretch.time_s + shift - stretch.grid_s[0]) / step
        before = np.clip(np.floor(place + 1e-6).astype(int), 0, len(stretch.grid_s) - 2)
        rest = (place - before) * step
        return cls(before, float(rest[0]) if np.ptp(rest) < 1e-7 * step else rest, step)


class _ModeResponse:
    """Response of one mode to one torque, from rest at the first point of the grid."""

    def __init__(self, pole: complex, stretch: Stretch, torque: int, bend: float) -> None:
        self._pole, self._held = pole, stretch.held[torque]
        self._torque = stretch.torques[:, torque]
        if bend:
            self._torque = self._torque + bend * stretch.second_differences[:, torque]
        step = float(stretch.grid_s[1] - stretch.grid_s[0])
        decay, first, second = _weights(pole * step, step)
        later = self._torque[:-1] if self._held else self._torque[1:]
        pushed = np.concatenate([[0.0], first * self._torque[:-1] + second * later])
        self._state = scipy.signal.lfilter([1.0], [1.0, -decay], pushed)

    def at(self, place: _Place) -> np.ndarray:
        """Return the state of the mode at the samples, (n,)."""
        start = self._torque[place.before]
        end = start
        if not self._held:
            end = start + (self._torque[place.before + 1] - start) * (place.rest_s / place.step_s)
        decay, first, second = _weights(self._pole * place.rest_s, place.rest_s)
        return decay * self._state[place.before] + first * start + second * end


def _under_one(pole: complex, since: np.ndarray, free: np.ndarray) -> np.ndarray:
    """Return the step response of a mode after the times `since` in s."""
    if abs(pole) * since[-1, 0] > _NEARLY_CONSTANT:
        return (free - 1.0) / pole
    z = pole * since
    return since * (1.0 + z / 2.0 * (1.0 + z / 3.0))


def _weights(z: Any, step: Any) -> tuple[Any, Any, Any]:
    """Return e^z and the weights of the inputs at both ends of a step, for numbers or arrays."""
    if isinstance(z, np.ndarray):
        small = np.abs(z) < _SMALL
        near, far = _near_zero(np.where(small, z, 0.0)), _far_from_zero(np.where(small, 1.0, z))
        phi_1, phi_2 = (np.where(small, one, other) for one, other in zip(near, far, strict=True))
    else:
        phi_1, phi_2 = _near_zero(z) if abs(z) < _SMALL else _far_from_zero(z)
    return np.exp(z), step * (phi_1 - phi_2), step * phi_2


def _far_from_zero(z: Any) -> tuple[Any, Any]:
    """Return phi_1 = (e^z - 1) / z and phi_2 = (phi_1 - 1) / z."""
    phi_1 = np.expm1(z) / z
    return phi_1, (phi_1 - 1.0) / z


def _near_zero(z: Any) -> tuple[Any, Any]:
    """Return phi_1 and phi_2 of `_far_from_zero` for small z, by their series."""
    phi_1 = 1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0 * (1.0 + z / 5.0)))
    phi_2 = 0.5 + z / 6.0 * (1.0 + z / 4.0 * (1.0 + z / 5.0 * (1.0 + z / 6.0)))
    return phi_1, phi_2
