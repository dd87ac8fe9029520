"""Disturbances that are estimated so that no constant error of a torque leaves a slip error."""

import numpy as np

from ddct_controllers.mpc.estimate.observer import NoiseLevels
from ddct_controllers.mpc.model.transmission_model import (
    LOAD_TORQUE,
    MEASURED,
    TransmissionModel,
    transmission_model,
    with_disturbances,
)
from ddct_plant.base.errors import ParameterError
from ddct_plant.models.parameters import DrivelineParameters

CLUTCH_DRIFT_N_M = 13.0
"""
Per period. A random walk reaches it times the root of the number of periods: a clutch worn by 0.3
is wrong by 90 N m when C_f has risen to 300 N m, half a second after the start.
"""
LOAD_DRIFT_N_M = 47.0
"""Per period: within a second the load of a 10 % slope, 470 N m at the wheels of 1500 kg."""


def offset_free_model(driveline: DrivelineParameters) -> TransmissionModel:
    """
    Return the sampled model with errors of C_f and C_load, in N m, as its states 10 and 11.

    Two, because the measured speeds tell no more than two constant torques along the shaft apart:
    what flows from the engine to the wheels without accelerating anything only twists the
    half-shafts. So an error of C_m, or of a friction torque, appears as a pair of these two.
    """
    model = transmission_model(driveline)
    columns = np.column_stack([model.clutch, model.b[:, LOAD_TORQUE]])
    augmented = with_disturbances(model, columns)
    require_detectable(augmented)
    return augmented


def offset_free_noise(
    clutch_drift_n_m: float = CLUTCH_DRIFT_N_M, load_drift_n_m: float = LOAD_DRIFT_N_M
) -> NoiseLevels:
    """Return the noise levels of the observer of `offset_free_model`."""
    return NoiseLevels(drift=(clutch_drift_n_m, load_drift_n_m))


def require_detectable(model: TransmissionModel) -> None:
    """
    Raise ParameterError unless the measured speeds determine the disturbances.

    With n states, n_d disturbances and the measurements C the condition is
    rank [[A - I, B_d], [C, 0]] = n + n_d (Muske and Badgwell, J. Process Control 12, 2002;
    Pannocchia and Rawlings, AIChE Journal 49, 2003).
    """
    size = len(model.a)
    matrix = np.vstack([model.a - np.eye(size), np.eye(MEASURED, size)])
    # Columns of unit length, so that the rank does not depend on units.
    rank = np.linalg.matrix_rank(matrix / np.linalg.norm(matrix, axis=0))
    if rank < size:
        raise ParameterError(
            f'MPC: the measured speeds do not determine {model.disturbances} disturbances '
            f'(rank {rank} of {size}): estimate fewer'
        )
