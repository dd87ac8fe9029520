"""What the driveline of Section 1.5 makes of measured torques, exact between their samples."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import SimpleNamespace
from typing import cast

import numpy as np
import scipy

from ddct_plant.models.driveline_model import driveline_matrices
from ddct_plant.models.parameters import DrivelineParameters

OUTPUTS = 3
"""w_m, w_p, w_r: the first states of the model, in its order."""
NUISANCE = 5
"""Numbers that each stretch has of its own: w_m, w_p, w_r, theta_sr at its start, and C_load."""
_SMALL = 1e-2


@dataclass(frozen=True, eq=False)
class Stretch:
    """A part of a log without a gap: n samples of the speeds, torques on a grid that is finer."""

    time_s: np.ndarray
    """(n,) of the samples."""
    speeds: np.ndarray
    """(n, 3) w_m, w_p, w_r in rad/s."""
    grid_s: np.ndarray
    """(m,) equal steps from the first sample to the last or beyond."""
    torques: np.ndarray
    """(m, 3) C_m, C_f and what is known of C_load in N m on the grid."""
    held: tuple[bool, ...]
    """Which of them keep their value until the next point; the others are linear between."""
    load_known: bool
    """Whether C_load was measured; otherwise a constant is fitted to each stretch."""


def responses(values: Mapping[str, float], stretch: Stretch) -> tuple[np.ndarray, np.ndarray]:
    """
    Return the speeds (n, 3) from rest under the torques, and what each nuisance adds, (n, 3, 5).

    `values` are those of DrivelineParameters by name; while a fit runs a damping may be negative.

    Over a step h the modes z' = lambda z + v with v linear are advanced exactly by
    z_1 = e^(lambda h) z_0 + h (phi_1 - phi_2) v_0 + h phi_2 v_1.
    """
    model = driveline_matrices(cast(DrivelineParameters, SimpleNamespace(**values)))
    poles, vectors = np.linalg.eig(model.a)
    poles, vectors = poles.astype(complex), vectors.astype(complex)
    inverse = np.linalg.inv(vectors)
    drive = np.ones((len(stretch.grid_s), 4))
    drive[:, :3] = stretch.torques
    into_modes = inverse @ np.column_stack([model.b, model.b[:, 2]])
    held = (*stretch.held, True)
    step = stretch.grid_s[1] - stretch.grid_s[0]
    forced = np.zeros((len(drive), OUTPUTS))
    basis = np.zeros((len(drive), OUTPUTS, NUISANCE))
    for mode, pole in enumerate(poles):
        shape = vectors[:OUTPUTS, mode]
        decay, first, second = _weights(pole * step, step)
        later = np.where(held, drive[:-1], drive[1:])
        pushed = (first * drive[:-1] + second * later) * into_modes[mode]
        pushed = np.vstack([np.zeros(4), pushed])
        known = _run(decay, pushed[:, :3].sum(axis=1))
        forced += np.real(np.outer(known, shape))
        free = decay ** np.arange(len(drive))
        basis[:, :, :4] += np.real(free[:, None, None] * np.outer(shape, inverse[mode]))
        if not stretch.load_known:
            basis[:, :, 4] += np.real(np.outer(_run(decay, pushed[:, 3]), shape))
    return _at(stretch, forced), _at(stretch, basis)


def residuals_of(values: Mapping[str, float], stretch: Stretch) -> tuple[np.ndarray, np.ndarray]:
    """
    Return measured less computed speeds (n, 3) in rad/s, with the best nuisances, (5,).

    Start and C_load of the stretch are fitted to it, by least squares.
    """
    forced, basis = responses(values, stretch)
    left = stretch.speeds - forced
    nuisance = np.linalg.lstsq(basis.reshape(-1, NUISANCE), left.ravel(), rcond=None)[0]
    return left - basis @ nuisance, nuisance


def _weights(z: complex, step: float) -> tuple[complex, complex, complex]:
    """Return e^z and the weights of the values at both ends of a step."""
    if abs(z) < _SMALL:
        phi_1 = 1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0 * (1.0 + z / 5.0)))
        phi_2 = 0.5 + z / 6.0 * (1.0 + z / 4.0 * (1.0 + z / 5.0 * (1.0 + z / 6.0)))
    else:
        phi_1 = np.expm1(z) / z
        phi_2 = (phi_1 - 1.0) / z
    return np.exp(z), step * (phi_1 - phi_2), step * phi_2


def _run(decay: complex, pushed: np.ndarray) -> np.ndarray:
    """Return z_k of z_(k+1) = decay z_k + pushed_(k+1) with z_0 = pushed_0."""
    return scipy.signal.lfilter([1.0], [1.0, -decay], pushed)


def _at(stretch: Stretch, values: np.ndarray) -> np.ndarray:
    """Return values on the grid at the times of the samples, linear between grid points."""
    step = stretch.grid_s[1] - stretch.grid_s[0]
    place = (stretch.time_s - stretch.grid_s[0]) / step
    before = np.clip(np.floor(place + 1e-6).astype(int), 0, len(values) - 2)
    share = (place - before).reshape(-1, *(1,) * (values.ndim - 1))
    share = np.where(np.abs(share - np.round(share)) < 1e-6, np.round(share), share)
    return values[before] * (1.0 - share) + values[before + 1] * share
