"""The transmission's model with more states: disturbances, or an engine that is commanded."""

import numpy as np

from ddct_controllers.mpc.model.transmission_model import (
    ENGINE_TORQUE,
    LOAD_TORQUE,
    MEASURED,
    TransmissionModel,
    transmission_model,
)
from ddct_plant.base.errors import ParameterError
from ddct_plant.models.parameters import DrivelineParameters


def with_engine(model: TransmissionModel, lag_share: float) -> TransmissionModel:
    """
    Return `model` with two more states, the driver's demand and the deviation before, in N m.

    Its input ENGINE_TORQUE is the deviation u that is asked for. With s = `lag_share`, the share
    that comes about within a period (1 without a lag), C_m = demand + (1 - s) deviation + s u over
    the period, and the deviation after it is (1 - s) deviation + s u. The demand stays as it is.
    """
    kept = 1.0 - lag_share
    states = len(model.a)
    engine, through = model.b[:, ENGINE_TORQUE], model.d[:, ENGINE_TORQUE]
    a = np.zeros((states + 2, states + 2))
    a[:states] = np.column_stack([model.a, engine, kept * engine])
    a[states, states], a[-1, -1] = 1.0, kept
    b = np.vstack([model.b, np.zeros((2, 3))])
    b[:states, ENGINE_TORQUE], b[-1, ENGINE_TORQUE] = lag_share * engine, lag_share
    d = model.d.copy()
    d[:, ENGINE_TORQUE] = lag_share * through
    c = np.column_stack([model.c, through, kept * through])
    return TransmissionModel(a, b, c, d, np.concatenate([model.clutch, np.zeros(2)]))


def with_disturbances(model: TransmissionModel, columns: np.ndarray) -> TransmissionModel:
    """Append constant disturbances that drive the nine states through `columns` (9, count)."""
    count = columns.shape[1]
    lower = np.zeros((count, len(model.a)))
    return TransmissionModel(
        np.block([[model.a, columns], [lower, np.eye(count)]]),
        np.vstack([model.b, np.zeros((count, 3))]),
        np.hstack([model.c, np.zeros((len(model.c), count))]),
        model.d,
        np.concatenate([model.clutch, np.zeros(count)]),
    )


def offset_free_model(driveline: DrivelineParameters) -> TransmissionModel:
    """
    Return the sampled model with errors of C_f and C_load, in N m, as its states 10 and 11.

    They are estimated so that no constant error of a torque leaves a slip error. Two, because the
    measured speeds tell no more than two constant torques along the shaft apart: what flows from
    the engine to the wheels without accelerating anything only twists the half-shafts. So an error
    of C_m, or of a friction torque, appears as a pair of these two.
    """
    model = transmission_model(driveline)
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
