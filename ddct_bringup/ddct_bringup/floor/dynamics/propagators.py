# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Exact maps of the driveline over a period: slipping, slipping until a lock, and locked."""

import numpy as np

from ddct_plant.base.timebase import PERIOD_S, SUBSTEP_S, SUBSTEPS
from ddct_plant.linear.sampling import hold_inputs, lift_piecewise_linear
from ddct_plant.models.driveline_model import states_and_torques
from ddct_plant.models.linear_driveline import step_matrix
from ddct_plant.models.parameters import DrivelineParameters

ENGINE, SHAFT, WHEEL, TWIST = range(4)
"""Indices of w_m, w_p, w_r and theta_sr."""
NODES = SUBSTEPS + 1
"""Number of nodes of C_f in a period."""


def slipping(parameters: DrivelineParameters) -> np.ndarray:
    """
    Return the map of a whole period in which the plates slip, (4, 17).

    Its columns are the states (4), C_m, C_load and the nodes of C_f (11), as in the plant.
    """
    return step_matrix(parameters, angles=False)


def slipping_for(parameters: DrivelineParameters, time_s: float) -> np.ndarray:
    """
    Return the map from the start of a period over `time_s`, at most 10 ms, (4, 17).

    C_f is linear between its nodes, so within the last piece it is interpolated. The columns are
    those of `slipping`.
    """
    a, b = states_and_torques(parameters)
    whole = min(int(time_s / SUBSTEP_S), SUBSTEPS - 1)
    rest = time_s - whole * SUBSTEP_S
    _, held = hold_inputs(a, b[:, [0, 2]], time_s) if time_s > 0.0 else (None, np.zeros((4, 2)))
    transition, torque = np.eye(4), np.zeros((4, NODES))
    if whole:
        transition, ahead = lift_piecewise_linear(a, b[:, 1], whole * SUBSTEP_S, whole)
        torque[:, : whole + 1] = ahead
    if rest > 0.0:
        last, ends = lift_piecewise_linear(a, b[:, 1], rest, 1)
        share = rest / SUBSTEP_S
        transition, torque = last @ transition, last @ torque
        torque[:, whole] += ends[:, 0] + (1.0 - share) * ends[:, 1]
        torque[:, whole + 1] += share * ends[:, 1]
    return np.hstack([transition, held, torque])


def interpolated(time_s: float) -> np.ndarray:
    """Return the weights of the nodes of C_f at `time_s` after the start of a period, (11,)."""
    whole = min(int(time_s / SUBSTEP_S), SUBSTEPS - 1)
    share = time_s / SUBSTEP_S - whole
    weights = np.zeros(NODES)
    weights[whole : whole + 2] = 1.0 - share, share
    return weights


def locked_matrices(parameters: DrivelineParameters) -> tuple[np.ndarray, np.ndarray]:
    """
    Return a (4, 4) and b (4, 2), inputs C_m and C_load, of plates that stick together.

    (J_m + J_p) dw/dt is the sum of the two rows of the slipping plant times their inertias, in
    which C_f cancels; both plates have this acceleration.
    """
    a, b = states_and_torques(parameters)
    inertias = np.array([parameters.engine_inertia, parameters.shaft_inertia])
    both = inertias / inertias.sum()
    a[:2], b[:2] = both @ a[:2], both @ b[:2]
    return a, b[:, [0, 2]]


def locked(parameters: DrivelineParameters, time_s: float = PERIOD_S) -> np.ndarray:
    """Return the map of locked plates over `time_s`, (4, 6): states, C_m, C_load."""
    if time_s <= 0.0:
        return np.eye(4, 6)
    return np.hstack(hold_inputs(*locked_matrices(parameters), time_s))


def joined(parameters: DrivelineParameters) -> np.ndarray:
    """
    Return the map to the state after a lock, (4, 4): both plates have their common speed.

    The common speed conserves J_m w_m + J_p w_p; at zero slip the state does not change.
    """
    inertias = np.array([parameters.engine_inertia, parameters.shaft_inertia])
    matrix = np.eye(4)
    matrix[:2, :2] = inertias / inertias.sum()
    return matrix
