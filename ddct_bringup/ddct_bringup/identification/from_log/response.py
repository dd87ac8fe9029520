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

from ddct_bringup.identification.from_log.stretches import INPUTS, LOAD, OUTPUTS, Stretch
from ddct_plant.models.driveline_model import STATES, TORQUES, driveline_matrices
from ddct_plant.models.gearbox import EngagedGear
from ddct_plant.models.parameters import DrivelineParameters

NUISANCE = len(STATES) + 1
"""Number of nuisances of each stretch: the states at its start, and C_load."""
_MEASURED, _DRIVING = STATES.places(*OUTPUTS), TORQUES.places(*INPUTS)
_NOTHING = 1e-12
"""Size of an entry of a mode that counts as zero, over the largest entry."""
_SMALL, _TERMS = 0.5, 16
"""Size of z up to which phi_2 is a series, and its number of terms, which leave 1e-19."""
_KEPT = 128
"""
Number of places and mode responses that are kept.

The modes are the same while delays alone change, the places while parameters alone do.
"""


def residuals_of(values: Mapping[str, float], stretch: Stretch) -> tuple[np.ndarray, np.ndarray]:
    """
    Return the residuals, measured less computed speeds (n, 3) in rad/s, and the nuisances (5,).

    The nuisances, initial state and C_load of the stretch, are fitted by least squares.
    """
    forced, basis = responses(values, stretch)
    left = stretch.speeds - forced
    nuisance = np.linalg.lstsq(basis.reshape(-1, NUISANCE), left.ravel(), rcond=None)[0]
    return left - basis @ nuisance, nuisance


def responses(values: Mapping[str, float], stretch: Stretch) -> tuple[np.ndarray, np.ndarray]:
    """
    Return the speeds (n, 3) from rest under the torques, and the nuisances' responses (n, 3, 5).

    `values` are those of DrivelineParameters and the delays in s by signal, 0 for missing ones;
    while a fit runs a damping may be negative. The system is linear, so for a torque with the
    delay d in the log the response to the logged torque is d later.
    """
    forced = np.zeros((len(stretch.time_s), len(OUTPUTS)))
    basis = np.zeros((*forced.shape, NUISANCE))
    shifts, lags = shifts_of(values, stretch)
    since = stretch.time_s[:, None] - stretch.time_s[0] - lags
    for pole, shape, left, driven in _modes(tuple(values[name] for name in _PARAMETERS)):
        free = np.exp(pole * since)
        basis[:, :, :-1] += np.real((free * shape)[:, :, None] * left)
        if not stretch.load_known:
            under_one = since * _phi(pole * since)[0]
            basis[:, :, -1] += np.real(under_one * shape * driven[INPUTS[LOAD]])
        for torque in _present(driven):
            run = _mode_response(pole, stretch, int(torque))
            for output in _present(shape):
                at = run.at(_place(stretch, float(shifts[output, torque])))
                forced[:, output] += np.real(shape[output] * driven[torque] * at)
    return forced, basis


def shifts_of(values: Mapping[str, float], stretch: Stretch) -> tuple[np.ndarray, np.ndarray]:
    """
    Return the shifts in s from the row of a speed to those of the torques then, (3, 3).

    And the delays of the speeds, (3,). Where C_load was not measured, its known part is computed
    from w_r and has the delay of w_r.
    """
    lags = np.array([values.get(name, 0.0) for name in OUTPUTS])
    late = [values.get(name, 0.0) for name in INPUTS]
    if not stretch.load_known:
        late[INPUTS[LOAD]] = lags[OUTPUTS['wheel_speed']]
    return np.array(late) - lags[:, None], lags


_PARAMETERS = tuple(DrivelineParameters().values())
_Mode = tuple[complex, np.ndarray, np.ndarray, np.ndarray]
"""
Pole, right eigenvector in the outputs (3,), left eigenvector (n,), and what each torque adds (3,).
"""


@lru_cache(maxsize=1)  # all stretches of a log have the driveline of one evaluation
def _modes(values: tuple[float, ...]) -> list[_Mode]:
    """
    Return the modes of the driveline with these values, in the order of _PARAMETERS.

    Of a conjugate pair only one pole is returned, with twice its outputs: the real part is used.
    """
    named = dict(zip(_PARAMETERS, values, strict=True))
    unchecked = SimpleNamespace(**named, gear=EngagedGear(named['total_ratio']))
    model = driveline_matrices(cast(DrivelineParameters, unchecked))
    poles, vectors = np.linalg.eig(model.a)
    inverse, inputs = np.linalg.inv(vectors), model.b[:, _DRIVING]
    modes: list[_Mode] = []
    for pole, shape, left in zip(poles.tolist(), vectors[_MEASURED, :].T, inverse, strict=True):
        if not np.imag(pole):
            # In real numbers, which take half the time of complex ones.
            modes.append((np.real(pole), shape.real, left.real, left.real @ inputs))
        elif pole.imag > 0.0:
            modes.append((pole, 2.0 * shape, left, left @ inputs))
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


@lru_cache(maxsize=_KEPT)
def _place(stretch: Stretch, shift: float) -> _Place:
    """Return the place of a stretch's samples, whose times are shifted in s."""
    step = float(stretch.grid_s[1] - stretch.grid_s[0])
    place = (stretch.time_s + shift - stretch.grid_s[0]) / step
    before = np.clip(np.floor(place + 1e-6).astype(int), 0, len(stretch.grid_s) - 2)
    rest = (place - before) * step
    return _Place(before, float(rest[0]) if np.ptp(rest) < 1e-7 * step else rest)


class _ModeResponse:
    """
    Response of one mode z' = p z + v to one torque v, from rest at the first point of the grid.

    Over a time h with v linear, z_1 = e^(p h) z_0 + h (phi_1 - phi_2) v_0 + h phi_2 v_1, exactly.
    """

    def __init__(self, pole: complex, stretch: Stretch, torque: int) -> None:
        self._pole = pole
        self._step = float(stretch.grid_s[1] - stretch.grid_s[0])
        self._first = stretch.torques[:-1, torque]
        rises = np.diff(stretch.torques[:, torque])
        self._rise = 0.0 * rises if stretch.held[torque] else rises
        decay, level, slope = _kept_weights(pole, self._step)
        pushed = np.concatenate([[0.0], level * self._first + slope * self._rise])
        self._state = scipy.signal.lfilter([1.0], [1.0, -decay], pushed)

    def at(self, place: _Place) -> np.ndarray:
        """Return the state of the mode at the samples, (n,)."""
        weights = _kept_weights if isinstance(place.rest_s, float) else _weights
        decay, level, slope = weights(self._pole, place.rest_s)
        rise = self._rise[place.before]
        driven = level * self._first[place.before] + slope * (place.rest_s / self._step) * rise
        return decay * self._state[place.before] + driven


def _weights(pole: complex, time_s: Any) -> tuple[Any, Any, Any]:
    """Return e^(p t), and the weights of the torque's level and of its rise in the time t."""
    phi_1, phi_2 = _phi(pole * time_s)
    return 1.0 + pole * time_s * phi_1, time_s * phi_1, time_s * phi_2


_kept_weights = lru_cache(maxsize=_KEPT)(_weights)
"""The same for one time, which the responses to all torques share."""


@lru_cache(maxsize=_KEPT)
def _mode_response(pole: complex, stretch: Stretch, torque: int) -> _ModeResponse:
    return _ModeResponse(pole, stretch, torque)


def _phi(z: Any) -> tuple[Any, Any]:
    """Return phi_1 = (e^z - 1) / z and phi_2 = (phi_1 - 1) / z, of numbers or arrays."""
    if np.ndim(z) == 0:
        phi_2 = _near_zero(z) if abs(z) < _SMALL else _far_from_zero(z)
    else:
        small = np.abs(z) < _SMALL
        near, far = np.where(small, z, 0.0), np.where(small, 1.0, z)
        phi_2 = np.where(small, _near_zero(near), _far_from_zero(far))
    return 1.0 + z * phi_2, phi_2


def _near_zero(z: Any) -> Any:
    """Return phi_2 = 1/2 + z/6 + z^2/24 + ... in Horner's form."""
    phi_2 = 0.0 * z
    for term in range(_TERMS + 1, 1, -1):
        phi_2 = (1.0 + z * phi_2) / term
    return phi_2


def _far_from_zero(z: Any) -> Any:
    return (np.expm1(z) / z - 1.0) / z
