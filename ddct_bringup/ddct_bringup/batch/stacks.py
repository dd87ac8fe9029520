# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Arrays with one column per run for quantities that differ from run to run, and their filters."""

from collections.abc import Hashable, Iterable, Sequence
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from ddct_plant.linear.lti import StateSpace


def stacked(members: Sequence[Any]) -> Any:
    """
    Return one dataclass with the fields of R as arrays, (R,), also in nested dataclasses.

    A tuple of dataclasses becomes one of such dataclasses.

    Its class is theirs, so that equations may call its methods; it is not checked.
    """
    stack = object.__new__(type(members[0]))
    for field in fields(members[0]):
        values = [getattr(each, field.name) for each in members]
        object.__setattr__(stack, field.name, _column(values))
    return stack


def _column(values: Sequence[Any]) -> Any:
    if is_dataclass(values[0]):
        return stacked(values)
    if isinstance(values[0], tuple) and all(map(is_dataclass, values[0])):
        return tuple(stacked(each) for each in zip(*values, strict=True))
    return np.array(values)


def distinct(keys: Iterable[Hashable]) -> tuple[list[int], np.ndarray]:
    """Return the index of each key's first occurrence, and per key its index among those, (R,)."""
    places: dict[Any, int] = {}
    first: list[int] = []
    inverse = []
    for index, key in enumerate(keys):
        if key not in places:
            places[key] = len(first)
            first.append(index)
        inverse.append(places[key])
    return first, np.array(inverse)


def product(matrix: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """
    Return matrix @ columns, (m, R), for one matrix (m, n) or one per run (m, n, R).

    BLAS is faster with one matrix, but the rounding of a column depends on its neighbours.
    """
    return np.einsum('ijr,jr->ir' if matrix.ndim == 3 else 'ij,jr->ir', matrix, columns)


class Filters:
    """
    Many sampled linear systems as columns, the counterpart of `DiscreteFilter`.

    y_k = c x_k + d u_k, x_(k+1) = a x_k + b u_k for each run, all of one order, one output.
    """

    def __init__(self, models: Sequence[StateSpace], states: np.ndarray | float = 0.0) -> None:
        """Start in the states `states`, (n, R)."""
        systems = [(model.a, model.b, model.c, model.d) for model in models]
        first, places = distinct(tuple(map(np.ndarray.tobytes, each)) for each in systems)
        # From states and inputs to the next states and the output, (n + 1, n + m) each.
        maps = [np.block([[a, b], [c, d]]) for a, b, c, d in (systems[index] for index in first)]
        matrices = np.stack(maps, axis=-1)
        self._matrix = matrices[..., 0] if len(first) == 1 else np.take(matrices, places, axis=-1)
        self._order = len(models[0].a)
        self._states_and_inputs = np.zeros((self._matrix.shape[1], len(models)))
        self._states_and_inputs[: self._order] = states

    def update(self, *inputs: np.ndarray) -> np.ndarray:
        """Return the outputs of this period, (R,), and advance the states by one period."""
        values = self._states_and_inputs
        values[self._order :] = inputs
        following = product(self._matrix, values)
        values[: self._order] = following[:-1]
        return following[-1]
