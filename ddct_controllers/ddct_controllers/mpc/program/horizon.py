"""Condense a prediction over the horizon into a quadratic program in the input moves alone."""

from dataclasses import dataclass

import numpy as np

from ddct_controllers.mpc.model.transmission_model import TransmissionModel
from ddct_controllers.mpc.program.prediction import Prediction, predict
from ddct_controllers.mpc.program.settings import MpcSettings
from ddct_controllers.mpc.qp.problem import QpStructure
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import PERIOD_S

INPUT_NAMES = ('the clutch torque request', 'C_m')


@dataclass(frozen=True, eq=False)
class CondensedProgram:
    """
    The program whose solution z are the moves; what changes from step to step is linear.

    With v as in `Prediction`: f = gradient @ (v, the inputs' targets, the outputs' references
    period by period), and the bounds are `lower` and `upper` less shift @ (v, jump), where jump is
    what the inputs change by before the first move, because the open loop does.
    """

    structure: QpStructure
    gradient: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    shift: np.ndarray
    level_rows: tuple[np.ndarray, ...]
    """Per input the rows that limit it at the moves 1..m, (m,), or (0,) without such a limit."""


def condense(model: TransmissionModel, settings: MpcSettings) -> CondensedProgram:
    """Return the program; raise ParameterError when horizons or weights leave moves open."""
    prediction = predict(model, settings)
    hessian, gradient = _cost(model, settings, prediction)
    _require_felt(settings, prediction)
    _require_weighed(settings, hessian)
    hard, soft = _input_rows(model, settings), _output_rows(settings, prediction)
    rows, lower, upper, shift = (np.concatenate(pair) for pair in zip(hard, soft, strict=True))
    is_soft = np.arange(len(rows)) >= len(hard[0])
    return CondensedProgram(
        QpStructure(hessian, rows, is_soft, settings.soft_limit_weight),
        gradient,
        lower,
        upper,
        shift,
        _level_rows(settings),
    )


def _require_felt(settings: MpcSettings, prediction: Prediction) -> None:
    """Raise ParameterError when outputs are weighted, but no move can change one of them."""
    inputs, horizon = len(settings.inputs), settings.prediction_steps
    weighted = np.tile([terms.weight > 0.0 for terms in settings.outputs], horizon)
    weighted[-len(settings.outputs) :] |= [terms.final_weight > 0.0 for terms in settings.outputs]
    felt = prediction.from_moves[weighted, :inputs].any(axis=0)
    if weighted.any() and not felt.all():
        name = INPUT_NAMES[int(np.argmin(felt))]
        raise ParameterError(
            f'MPC: prediction_steps is {horizon}: within them no weighted output feels a move of '
            f'{name}: choose more'
        )


def _require_weighed(settings: MpcSettings, hessian: np.ndarray) -> None:
    """Raise ParameterError when nothing weighs the last moves, as they act too late."""
    weighed = np.diag(hessian) > 0.0
    longest = int(np.argmin(weighed)) // len(settings.inputs)
    if not weighed.all() and longest > 0:
        raise ParameterError(
            f'MPC: control_steps is {settings.control_steps}, too long for prediction_steps, '
            f'{settings.prediction_steps}: nothing weighs the last moves: choose at most {longest}'
        )


def _cost(
    model: TransmissionModel, settings: MpcSettings, prediction: Prediction
) -> tuple[np.ndarray, np.ndarray]:
    """Return H and the gradient matrix; levels = levels before + cumulated moves."""
    moves, inputs = settings.control_steps, len(settings.inputs)
    weights = np.tile([terms.weight**2 for terms in settings.outputs], settings.prediction_steps)
    weights[-len(settings.outputs) :] += [terms.final_weight**2 for terms in settings.outputs]
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
"""Constraint rows, their lower and upper bounds, and what (v, jump) shifts the bounds by."""


def _input_rows(model: TransmissionModel, settings: MpcSettings) -> _Rows:
    """Return rows for the inputs' levels and rates, only where they are limited."""
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
    rows = np.vstack([_levels(moves, inputs), np.eye(moves * inputs)])
    lower = np.concatenate([np.tile(lowest, moves), -change])
    upper = np.concatenate([np.tile(highest, moves), change])
    limited = np.isfinite(lower) | np.isfinite(upper)
    return rows[limited], lower[limited], upper[limited], np.vstack([before, jump])[limited]


def _level_rows(settings: MpcSettings) -> tuple[np.ndarray, ...]:
    """Return where among the rows of `_input_rows` each input's levels are."""
    limited = [np.isfinite((terms.lowest, terms.highest)).any() for terms in settings.inputs]
    owner = np.tile(np.flatnonzero(limited), settings.control_steps)
    return tuple(np.flatnonzero(owner == each) for each in range(len(limited)))


def _output_rows(settings: MpcSettings, prediction: Prediction) -> _Rows:
    """Return rows for the outputs that have a soft limit."""
    limits = [(terms.lowest, terms.highest) for terms in settings.outputs]
    lower, upper = np.tile(np.array(limits).T, settings.prediction_steps)
    limited = np.isfinite(lower) | np.isfinite(upper)
    shift = prediction.from_known[limited]
    no_jump = np.zeros((len(shift), len(settings.inputs)))
    return (
        prediction.from_moves[limited],
        lower[limited],
        upper[limited],
        np.hstack([shift, no_jump]),
    )


def _levels(moves: int, inputs: int) -> np.ndarray:
    """Return the map from moves to what the inputs have changed by, period by period."""
    return np.kron(np.tril(np.ones((moves, moves))), np.eye(inputs))
