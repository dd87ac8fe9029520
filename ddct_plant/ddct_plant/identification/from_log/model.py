"""
What the driveline of Section 1.5 makes of measured torques, exact between their samples.

A log is modelled so: every sample is the true value of one instant, a delay before the time of
its row, plus noise. Each signal has a delay of its own. Between its samples a torque is linear or
keeps its value, as the column map says.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import scipy

from ddct_plant.models.driveline_model import driveline_matrices
from ddct_plant.models.parameters import DrivelineParameters

OUTPUTS = 3
"""w_m, w_p, w_r: the first states of the model, in its order."""
NUISANCE = 5
"""Numbers that each stretch has of its own: w_m, w_p, w_r, theta_sr at its start, and C_load."""
_SMALL = 1e-2
_NEARLY_CONSTANT = 1e-6
"""Pole times time up to which a mode only adds up what pushes it."""
_NOTHING = 1e-12
"""Share of the largest entry of a mode below which one counts as zero."""


@dataclass(frozen=True, eq=False)
class Stretch:
    """A part of a log without a gap: n samples of the speeds, torques on a grid that is finer."""

    time_s: np.ndarray
    """(n,) of the samples."""
    speeds: np.ndarray
    """(n, 3) w_m, w_p, w_r in rad/s."""
    grid_s: np.ndarray
    """(m,) equal steps, from before the first sample to beyond the last."""
    torques: np.ndarray
    """(m, 3) C_m, C_f and what is known of C_load in N m on the grid."""
    bends: np.ndarray
    """(m, 3) their second differences over a step of their own rows; 0 of those that are held."""
    held: tuple[bool, ...]
    """Which of them keep their value until the next point; the others are linear between."""
    load_known: bool
    """Whether C_load was measured; otherwise a constant is fitted to each stretch."""
    known_s: tuple[float, float]
    """The first and the last time of the log at which all torques were measured."""


@dataclass(frozen=True)
class Sampling:
    """How the rows of a log relate to its signals."""

    speeds: tuple[float, ...] = (0.0,) * OUTPUTS
    """Delays in s."""
    torques: tuple[float, ...] = (0.0,) * 3
    """Delays of C_m, C_f, C_load in s."""
    bends: tuple[float, ...] = (0.0,) * 3
    """Of each torque the share of its second difference that the line between rows leaves out."""

    @property
    def shifts(self) -> np.ndarray:
        """(3, 3) What to add to the time of a speed's row for that of the torque then."""
        return np.array(self.torques) - np.array(self.speeds)[:, None]


def responses(
    values: Mapping[str, float], sampling: Sampling, stretch: Stretch
) -> tuple[np.ndarray, np.ndarray]:
    """
    Return the speeds (n, 3) from rest under the torques, and what each nuisance adds, (n, 3, 5).

    `values` are those of DrivelineParameters by name; while a fit runs a damping may be negative.

    Over a step h the modes z' = lambda z + v with v linear are advanced exactly by
    z_1 = e^(lambda h) z_0 + h (phi_1 - phi_2) v_0 + h phi_2 v_1. The system is linear, so a torque
    that the log has late by d gives the response to the torque of the log, d later.
    """
    model = driveline_matrices(cast(DrivelineParameters, SimpleNamespace(**values)))
    forced = np.zeros((len(stretch.time_s), OUTPUTS))
    basis = np.zeros((len(stretch.time_s), OUTPUTS, NUISANCE))
    lags = np.array(sampling.speeds)
    since = stretch.time_s - stretch.time_s[0]
    shifts = sampling.shifts.tolist()
    places = {shift: _Place.of(stretch, shift) for shift in {each for r in shifts for each in r}}
    for pole, shape, inverse in _modes(model.a):
        driven = inverse @ model.b
        free = np.exp(pole * since)[:, None] * np.exp(-pole * lags)
        basis[:, :, :4] += np.real((free * shape)[:, :, None] * inverse)
        if not stretch.load_known:
            basis[:, :, 4] += np.real(
                _under_one(pole, since[:, None] - lags, free) * shape * driven[2]
            )
        for torque in _present(driven):
            run = _Run(pole, stretch, torque, sampling.bends[torque])
            for output in _present(shape):
                at = run.at(places[shifts[output][torque]])
                forced[:, output] += np.real(shape[output] * driven[torque] * at)
    return forced, basis


def residuals_of(
    values: Mapping[str, float], sampling: Sampling, stretch: Stretch
) -> tuple[np.ndarray, np.ndarray]:
    """
    Return measured less computed speeds (n, 3) in rad/s, with the best nuisances, (5,).

    Start and C_load of the stretch are fitted to it, by least squares.
    """
    forced, basis = responses(values, sampling, stretch)
    left = stretch.speeds - forced
    nuisance = np.linalg.lstsq(basis.reshape(-1, NUISANCE), left.ravel(), rcond=None)[0]
    return left - basis @ nuisance, nuisance


def _modes(a: np.ndarray) -> Iterator[tuple[complex, np.ndarray, np.ndarray]]:
    """
    Yield each pole, its part of the outputs (3,) and of the state (4,).

    Of a pair of poles only one comes, twice its part: what it gives is real.
    """
    poles, vectors = np.linalg.eig(a)
    poles, vectors = poles.astype(complex), vectors.astype(complex)
    inverse = np.linalg.inv(vectors)
    for mode, pole in enumerate(poles):
        if pole.imag >= 0.0:
            twice = 2.0 if pole.imag else 1.0
            yield complex(pole), twice * vectors[:OUTPUTS, mode], inverse[mode]


def _present(entries: np.ndarray) -> np.ndarray:
    """Return the places of the entries that are not zero."""
    sizes = np.abs(entries)
    return np.flatnonzero(sizes > _NOTHING * sizes.max())


@dataclass(frozen=True, eq=False)
class _Place:
    """Where the times of the samples, shifted, lie on the grid."""

    before: np.ndarray
    """(n,) The grid point before each."""
    rest_s: Any
    """(n,) s from there; one number where all are equal."""
    step_s: float

    @classmethod
    def of(cls, stretch: Stretch, shift: float) -> '_Place':
        step = float(stretch.grid_s[1] - stretch.grid_s[0])
        place = (stretch.time_s + shift - stretch.grid_s[0]) / step
        before = np.clip(np.floor(place + 1e-6).astype(int), 0, len(stretch.grid_s) - 2)
        rest = (place - before) * step
        return cls(before, float(rest[0]) if np.ptp(rest) < 1e-7 * step else rest, step)


class _Run:
    """One mode under one torque, from rest at the first point of the grid."""

    def __init__(self, pole: complex, stretch: Stretch, torque: int, bend: float) -> None:
        self._pole, self._held = pole, stretch.held[torque]
        self._torque = stretch.torques[:, torque]
        if bend:
            self._torque = self._torque + bend * stretch.bends[:, torque]
        step = float(stretch.grid_s[1] - stretch.grid_s[0])
        decay, first, second = _weights(pole * step, step)
        later = self._torque[:-1] if self._held else self._torque[1:]
        pushed = np.concatenate([[0.0], first * self._torque[:-1] + second * later])
        self._state = scipy.signal.lfilter([1.0], [1.0, -decay], pushed)

    def at(self, place: _Place) -> np.ndarray:
        """Return the mode at a place, (n,)."""
        start = self._torque[place.before]
        end = start
        if not self._held:
            end = start + (self._torque[place.before + 1] - start) * (place.rest_s / place.step_s)
        decay, first, second = _weights(self._pole * place.rest_s, place.rest_s)
        return decay * self._state[place.before] + first * start + second * end


def _under_one(pole: complex, since: np.ndarray, free: np.ndarray) -> np.ndarray:
    """Return a mode that a constant 1 has pushed for `since`, in s, where it was 0 before."""
    if abs(pole) * since[-1, 0] > _NEARLY_CONSTANT:
        return (free - 1.0) / pole
    z = pole * since
    return since * (1.0 + z / 2.0 * (1.0 + z / 3.0))


def _weights(z: Any, step: Any) -> tuple[Any, Any, Any]:
    """Return e^z and the weights of the values at both ends of a step; z and it may be arrays."""
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
    """Return the same of small z."""
    phi_1 = 1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0 * (1.0 + z / 5.0)))
    phi_2 = 0.5 + z / 6.0 * (1.0 + z / 4.0 * (1.0 + z / 5.0 * (1.0 + z / 6.0)))
    return phi_1, phi_2
