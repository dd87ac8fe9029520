"""The wear observer's state, and what it believes of the noise that drives it."""

from dataclasses import dataclass

import numpy as np

from ddct_controllers.mpc.estimate.disturbances import CLUTCH_DRIFT_N_M, LOAD_DRIFT_N_M
from ddct_controllers.mpc.estimate.observer import NoiseLevels
from ddct_controllers.mpc.model.transmission_model import (
    ENGINE_TORQUE,
    LOAD_TORQUE,
    TransmissionModel,
)

DRIVELINE = 4
"""w_m, w_p, w_r and theta_sr come first."""
GAIN, CLUTCH_ERROR, LOAD_ERROR = range(DRIVELINE, DRIVELINE + 3)
"""Then K_usura, and the errors of C_f and C_load in N m."""
SIZE = LOAD_ERROR + 1


@dataclass(frozen=True)
class WearNoise:
    """Standard deviations; all drifts are per period."""

    initial_gain: float = 0.2
    """Of K_usura about 1 before the first measurement."""
    gain_drift: float = 0.01
    """Of K_usura; within a second, an engagement, 0.1: the fade of a hot clutch."""
    clutch_drift_n_m: float = CLUTCH_DRIFT_N_M
    """Of the error of C_f, while a bound holds K_usura; as in the offset-free controllers."""
    load_drift_n_m: float = LOAD_DRIFT_N_M
    """Of the error of C_load; as in the offset-free controllers."""


def process_noise(model: TransmissionModel, noise: NoiseLevels, wear: WearNoise) -> np.ndarray:
    """Return the covariance (SIZE, SIZE) that a period adds, without what drifts at times."""
    torques = np.zeros((SIZE, 3))
    torques[:DRIVELINE, 0] = noise.engine_torque_n_m * model.b[:DRIVELINE, ENGINE_TORQUE]
    torques[:DRIVELINE, 1] = noise.load_torque_n_m * model.b[:DRIVELINE, LOAD_TORQUE]
    torques[:DRIVELINE, 2] = noise.clutch_torque_n_m * model.clutch[:DRIVELINE]
    process = torques @ torques.T
    process[LOAD_ERROR, LOAD_ERROR] = wear.load_drift_n_m**2
    return process
