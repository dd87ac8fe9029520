# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Predict over the horizon, and condense it into a quadratic program in the input moves alone."""

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from ddct_controllers.mpc.model.transmission_model import (
    ENGINE_TORQUE,
    LOAD_TORQUE,
    REQUEST,
    TransmissionModel,
)
from ddct_controllers.mpc.program.settings import MpcSettings
from ddct_controllers.mpc.qp.problem import QpStructure
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import PERIOD_S

DECIDED = (REQUEST, ENGINE_TORQUE)
"""Model inputs that a controller may decide, in their order; the others are known inputs."""
INPUT_NAMES = ('the clutch torque request', 'C_m')


@dataclass(frozen=True, eq=False)
class HorizonPrediction:
    """
    Outputs over the horizon, y_i, i = 1..p, stacked period by period, p outputs long.

    y = from_moves @ z + from_known @ v, with z the moves of the inputs, m after m, and v the state
    x_k, the inputs before the first move, and the known inputs, constant over the horizon.
    """

    from_moves: np.ndarray
    """Effect of the moves on the outputs, (p outputs, m inputs)."""
    from_known: np.ndarray
    """Effect of v on the outputs, (p outputs, n + inputs + known inputs)."""


@dataclass(frozen=True, eq=False)
class CondensedProgram:
    """
    The program whose solution z are the moves; its data at each step are linear in v.

    With v as in `HorizonPrediction`: f = gradient @ (v, the inputs' targets, the outputs'
    references period by period), and the bounds are `lower` and `upper` less shift @ (v, jump),
    where jump is the change of the inputs before the first move, caused by the open loop.
    """

    structure: QpStructure
    gradient: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    shift: np.ndarray
    level_rows: tuple[np.ndarray, ...]
    """
    Rows that limit each input's level at the moves 1..m: per input (m,), or (0,) without a limit.
    """

    @cached_property
    def without_rows(self) -> np.ndarray:
        """
        Map from (v, targets, references, jump) to the optimum without rows, (1 + rows, ...).

        Its first value is the first move, the others are those that the rows have then: where all
        are between `lower` and `upper`, it is the optimum of the program too.
        """
        inputs = len(self.level_rows)
        by_known, by_jump = np.split(self.shift, [-inputs], axis=1)
        first, rows = self.structure.without_rows(self.gradient)
        rows[:, : by_known.shape[1]] += by_known
        return np.block([[first, np.zeros((1, inputs))], [rows, by_jump]])


@lru_cache  # runs with equal known settings share one
def condense(model: TransmissionModel, settings: MpcSettings) -> CondensedProgram:
    """Return the program; raise ParameterError when horizons or weights leave moves free."""
    inputs = len(settings.inputs)
    prediction = predict(model, settings)
    weights = np.tile([terms.weight**2 for terms in settings.outputs], settings.prediction_steps)
    weights[-len(settings.outputs) :] += [terms.final_weight**2 for terms in settings.outputs]
    hessian, gradient = _cost(model, settings, prediction, weights)
    _require_effect(settings, prediction, weights > 0.0)
    _require_weighted_moves(settings, hessian)
    hard, soft = _input_rows(model, settings), _output_rows(settings, prediction)
    rows, lower, upper, shift = (np.concatenate(pair) for pair in zip(hard, soft, strict=True))
    limited = np.flatnonzero(np.isfinite(lower) | np.isfinite(upper))
    # Those of the levels come first, move by move, and of each input in turn.
    levels = limited[limited < settings.control_steps * inputs]
    return CondensedProgram(
        QpStructure(hessian, rows[limited], limited >= len(hard[0]), settings.soft_limit_weight),
        gradient,
        lower[limited],
        upper[limited],
        shift[limited],
        tuple(np.flatnonzero(levels % inputs == each) for each in range(inputs)),
    )


def predict(model: TransmissionModel, settings: MpcSettings) -> HorizonPrediction:
    """Return the weighted outputs over the horizon as a linear map of moves, state and inputs."""
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
    return HorizonPrediction(_moves(steps, feedthrough, settings.control_steps), np.vstack(free))


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


def _require_effect(
    settings: MpcSettings, prediction: HorizonPrediction, weighted: np.ndarray
) -> None:
    """Raise ParameterError when no move can change one of the outputs that are `weighted`."""
    effective = prediction.from_moves[weighted, : len(settings.inputs)].any(axis=0)
    if weighted.any() and not effective.all():
        name = INPUT_NAMES[int(np.argmin(effective))]
        raise ParameterError(
            f'MPC: prediction_steps is {settings.prediction_steps}: a move of {name} changes no '
            'weighted output within them: choose more',
            key='MPC: prediction_steps',
        )


def _require_weighted_moves(settings: MpcSettings, hessian: np.ndarray) -> None:
    """Raise ParameterError when the last moves have no weight, as they act too late."""
    weighed = np.diag(hessian) > 0.0
    longest = int(np.argmin(weighed)) // len(settings.inputs)
    if not weighed.all() and longest > 0:
        raise ParameterError(
            f'MPC: control_steps is {settings.control_steps}, too long for prediction_steps, '
            f'{settings.prediction_steps}: nothing weighs the last moves: choose at most '
            f'{longest}',
            key='MPC: control_steps',
        )


def _cost(
    model: TransmissionModel,
    settings: MpcSettings,
    prediction: HorizonPrediction,
    weights: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Return H and the gradient matrix; levels = levels before + cumulated moves."""
    moves, inputs = settings.control_steps, len(settings.inputs)
    penalty = np.tile([terms.move_weight**2 for terms in settings.inputs], moves)
    pull = np.tile([terms.target_weight**2 for terms in settings.inputs], moves)
    levels, repeated = _levels(moves, inputs), np.tile(np.eye(inputs), (moves, 1))
    weighted, pulled = prediction.from_moves.T * weights, levels.T * pull
    hessian = weighted @ prediction.from_moves + np.diag(penalty) + pulled @ levels
    from_known = weighted @ prediction.from_known
    states = len(model.a)
    from_known[:, states : states + inputs] += pulled @ repeated
    return (hessian + hessian.T) / 2.0, np.hstack([from_known, -pulled @ repeated, -weighted])


_Rows = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]
"""
Constraint rows, their lower and upper bounds, and the map from (v, jump) to the bounds' shift.
"""


def _input_rows(model: TransmissionModel, settings: MpcSettings) -> _Rows:
    """Return rows for the inputs' levels, move by move, then for their rates."""
    moves, inputs, states = settings.control_steps, len(settings.inputs), len(model.a)
    known = 2 - (inputs - 1)
    lowest, highest, rate = np.array(
        [(terms.lowest, terms.highest, terms.rate_n_m_s) for terms in settings.inputs]
    ).T
    before = np.zeros((moves * inputs, states + inputs + known + inputs))
    before[:, states : states + inputs] = np.tile(np.eye(inputs), (moves, 1))
    jump = np.zeros_like(before)
    jump[:inputs, -inputs:] = np.eye(inputs)
    change = np.tile(rate * PERIOD_S, moves)
    return (
        np.vstack([_levels(moves, inputs), np.eye(moves * inputs)]),
        np.concatenate([np.tile(lowest, moves), -change]),
        np.concatenate([np.tile(highest, moves), change]),
        np.vstack([before, jump]),
    )


def _output_rows(settings: MpcSettings, prediction: HorizonPrediction) -> _Rows:
    """Return rows for the outputs, period by period."""
    limits = [(terms.lowest, terms.highest) for terms in settings.outputs]
    lower, upper = np.tile(np.array(limits).T, settings.prediction_steps)
    no_jump = np.zeros((len(lower), len(settings.inputs)))
    return prediction.from_moves, lower, upper, np.hstack([prediction.from_known, no_jump])


def _levels(moves: int, inputs: int) -> np.ndarray:
    """Return the map from moves to the change of the inputs' levels, period by period."""
    return np.kron(np.tril(np.ones((moves, moves))), np.eye(inputs))
