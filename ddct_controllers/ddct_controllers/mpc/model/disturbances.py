# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Models with constant disturbances as further states, which an observer estimates."""

from dataclasses import replace
from functools import lru_cache

import numpy as np

from ddct_controllers.mpc.model.transmission_model import (
    LOAD_TORQUE,
    MEASURED,
    TransmissionModel,
    transmission_model,
)
from ddct_plant.base.errors import ParameterError
from ddct_plant.linear.names import Names
from ddct_plant.models.actuator import PRINTED_ACTUATOR, ActuatorParameters
from ddct_plant.models.parameters import DrivelineParameters


def with_disturbances(model: TransmissionModel, columns: np.ndarray) -> TransmissionModel:
    """Append constant disturbances that drive the other states through `columns` (n, count)."""
    count = columns.shape[1]
    lower = np.zeros((count, len(model.a)))
    return replace(
        model,
        a=np.block([[model.a, columns], [lower, np.eye(count)]]),
        b=np.vstack([model.b, np.zeros((count, 3))]),
        c=np.hstack([model.c, np.zeros((len(model.c), count))]),
        clutch=np.concatenate([model.clutch, np.zeros(count)]),
        states=model.states + Names(tuple(f'disturbance_{i}' for i in range(1, count + 1))),
    )


@lru_cache
def offset_free_model(
    driveline: DrivelineParameters, actuator: ActuatorParameters = PRINTED_ACTUATOR
) -> TransmissionModel:
    """
    Return the sampled model with errors of C_f and C_load, in N m, as its last states.

    They are estimated so that no constant error of a torque leaves a slip error. Two, because no
    more than two constant torques along the shaft are observable from the measured speeds: a
    torque that flows from the engine to the wheels without accelerating anything only twists the
    half-shafts. So an error of C_m, or of a friction torque, appears as a pair of these two.
    """
    model = transmission_model(driveline, actuator=actuator)
    columns = np.column_stack([model.clutch, model.b[:, LOAD_TORQUE]])
    augmented = with_disturbances(model, columns)
    require_detectable(augmented)
    return augmented


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
