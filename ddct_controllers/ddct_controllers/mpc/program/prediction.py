"""Outputs over the horizon as they follow from the state, the inputs and their moves."""

from dataclasses import dataclass

import numpy as np

from ddct_controllers.mpc.model.transmission_model import (
    ENGINE_TORQUE,
    LOAD_TORQUE,
    REQUEST,
    TransmissionModel,
)
from ddct_controllers.mpc.program.settings import MpcSettings

DECIDED = (REQUEST, ENGINE_TORQUE)
"""Inputs that a controller may decide, in their order; it knows the others."""


@dataclass(frozen=True, eq=False)
class Prediction:
    """
    Outputs over the horizon, y_i, i = 1..p, stacked period by period, p outputs long.

    y = from_moves @ z + from_known @ v, with z the moves of the inputs, m after m, and v the state
    x_k, the inputs before the first move, and the known inputs, constant over the horizon.
    """

    from_moves: np.ndarray
    """(p outputs, m inputs)."""
    from_known: np.ndarray
    """(p outputs, n + inputs + known inputs)."""


def predict(model: TransmissionModel, settings: MpcSettings) -> Prediction:
    """Return how the weighted outputs follow from moves, state and inputs."""
    inputs = len(settings.inputs)
    decided = list(DECIDED[:inputs])
    known = [column for column in (ENGINE_TORQUE, LOAD_TORQUE) if column not in decided]
    rows = [terms.output for terms in settings.outputs]
    c, d = model.c[rows], model.d[rows]
    states = np.eye(len(model.a))
    held = np.zeros((len(model.a), 3))
    responses, free = [], []
    for _ in range(settings.prediction_steps):
        held = model.a @ held + model.b
        states = model.a @ states
        responses.append(c @ held + d)
        free.append(np.hstack([c @ states, responses[-1][:, decided + known]]))
    steps = np.array([response[:, decided] for response in responses])
    feedthrough = d[:, decided]
    return Prediction(_moves(steps, feedthrough, settings.control_steps), np.vstack(free))


def _moves(steps: np.ndarray, feedthrough: np.ndarray, control_steps: int) -> np.ndarray:
    """
    Return the response to a move at each of the first `control_steps` periods.

    `steps` (p, outputs, inputs) is that to a unit step from period 0 on, at periods 1..p.
    """
    horizon, outputs, inputs = steps.shape
    moves = np.zeros((horizon, outputs, control_steps, inputs))
    for j in range(control_steps):
        moves[j:, :, j, :] = steps[: horizon - j]
        if j > 0:
            moves[j - 1, :, j, :] = feedthrough
    return moves.reshape(horizon * outputs, control_steps * inputs)
