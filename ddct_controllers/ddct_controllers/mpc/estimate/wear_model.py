"""The wear observer's state: what drives it, and the bounds of K_usura."""

from dataclasses import dataclass

import numpy as np

from ddct_controllers.mpc.estimate.gains import (
    CLUTCH_DRIFT_N_M,
    LOAD_DRIFT_N_M,
    NoiseLevels,
    torque_noise,
)
from ddct_controllers.mpc.model.transmission_model import TransmissionModel

DRIVELINE = 4
"""w_m, w_p, w_r and theta_sr come first."""
GAIN, CLUTCH_ERROR, LOAD_ERROR = range(DRIVELINE, DRIVELINE + 3)
"""Then K_usura, and the errors of C_f and C_load in N m."""
SIZE = LOAD_ERROR + 1
LOWEST_GAIN, HIGHEST_GAIN = 0.5, 1.5
"""Bounds of the estimate. We take a clutch to reach 0.7 to 1.3."""


@dataclass(frozen=True)
class WearNoise:
    """Standard deviations; all drifts are per period."""

    initial_gain: float = 0.2
    """Deviation of K_usura from 1 before the first measurement."""
    gain_drift: float = 0.01
    """Drift of K_usura: 0.1 within a second, an engagement. This is the fade of a hot clutch."""
    clutch_drift_n_m: float = CLUTCH_DRIFT_N_M
    """Drift of the error of C_f while a bound holds K_usura, as in the offset-free controllers."""
    load_drift_n_m: float = LOAD_DRIFT_N_M
    """Drift of the error of C_load, as in the offset-free controllers."""


def process_noise(model: TransmissionModel, noise: NoiseLevels, wear: WearNoise) -> np.ndarray:
    """Return the covariance (SIZE, SIZE) that a period adds, without what drifts at times."""
    process = np.zeros((SIZE, SIZE))
    process[:DRIVELINE, :DRIVELINE] = torque_noise(model, noise)[:DRIVELINE, :DRIVELINE]
    process[LOAD_ERROR, LOAD_ERROR] = wear.load_drift_n_m**2
    return process


def within_bounds(state: np.ndarray, covariance: np.ndarray) -> np.ndarray:
    """
    Return the likeliest state (SIZE,) whose K_usura is within the bounds.

    What K_usura gives up goes to the states that `covariance` (SIZE, SIZE) ties to it, the error
    of C_f above all: the projection of Simon and Chia (IEEE Trans. Aerospace and Electronic
    Systems 38, 2002) with W = P^-1.
    """
    gain = state[GAIN]
    bound = min(max(gain, LOWEST_GAIN), HIGHEST_GAIN)
    if bound == gain:
        return state
    state = state + covariance[:, GAIN] / covariance[GAIN, GAIN] * (bound - gain)
    # Exactly, whatever is rounded.
    state[GAIN] = bound
    return state
