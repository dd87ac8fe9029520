"""Sampled linear systems of many runs as they run: `DiscreteFilter` over columns."""

from collections.abc import Sequence

import numpy as np

from ddct_bringup.batch.columns import distinct, product
from ddct_plant.linear.lti import StateSpace


class Filters:
    """y_k = c x_k + d u_k, x_(k+1) = a x_k + b u_k of each run, all of one order, one output."""

    def __init__(self, models: Sequence[StateSpace], states: np.ndarray | float = 0.0) -> None:
        """Start at `states`, (n, R)."""
        first, places = distinct(_key(model) for model in models)
        matrices = np.stack([_matrix(models[index]) for index in first], axis=-1)
        self._matrix = matrices[..., 0] if len(first) == 1 else np.take(matrices, places, axis=-1)
        self._order = len(models[0].a)
        self._states_and_inputs = np.zeros((self._matrix.shape[1], len(models)))
        self._states_and_inputs[: self._order] = states

    def update(self, *inputs: np.ndarray) -> np.ndarray:
        """Return the outputs of this period, (R,), and advance the states to the next one."""
        values = self._states_and_inputs
        values[self._order :] = inputs
        following = product(self._matrix, values)
        values[: self._order] = following[:-1]
        return following[-1]


def _key(model: StateSpace) -> tuple[bytes, ...]:
    return tuple(each.tobytes() for each in (model.a, model.b, model.c, model.d))


def _matrix(model: StateSpace) -> np.ndarray:
    """Return the (n + 1, n + m) map from states and inputs to the next states and the output."""
    return np.block([[model.a, model.b], [model.c, model.d]])
