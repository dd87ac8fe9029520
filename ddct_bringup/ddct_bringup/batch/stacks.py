# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Arrays whose first axis are the runs, for quantities that differ from run to run.

What a run gives does not depend on the other runs, to the last bit: functions of numbers are
applied element by element, and each run has matrix products of its own.
"""

from collections.abc import Hashable, Iterable, Sequence
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from ddct_plant.hybrid.interval_map import BLOCK
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


def rows_of(places: Sequence[int]) -> slice | np.ndarray:
    """Return ascending places as an index, one without copies where they are successive."""
    if places and places[-1] + 1 - places[0] == len(places):
        return slice(places[0], places[-1] + 1)
    return np.array(places, dtype=int)


def by_run(matrices: Sequence[np.ndarray], places: np.ndarray) -> np.ndarray:
    """
    Return the matrix (m, n) of all runs, or a stack (R, m, n) where they differ.

    Rows are contiguous: with another order of the numbers a product has another rounding.
    """
    if len(matrices) == 1:
        return np.array(matrices[0], order='C')
    return np.ascontiguousarray(np.stack(matrices)[places])


def product(matrix: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """
    Return for each run the product of its matrix and its row of values, (R, m).

    `matrix` is one (m, n) or one per run (R, m, n), `rows` are (R, n). It is a product by a vector
    for each run: in one of all runs the rounding of a run would depend on its neighbours.
    """
    height = max(1, BLOCK // matrix.shape[-1])
    columns = rows[:, :, np.newaxis]
    if matrix.shape[-2] <= height:
        return np.matmul(matrix, columns)[:, :, 0]
    blocks = range(0, matrix.shape[-2], height)
    parts = [np.matmul(matrix[..., i : i + height, :], columns)[:, :, 0] for i in blocks]
    return np.concatenate(parts, axis=1)


class Filters:
    """
    Many sampled linear systems, the counterpart of `DiscreteFilter`.

    y_k = c x_k + d u_k, x_(k+1) = a x_k + b u_k for each run, all of one order, one output.
    """

    def __init__(self, models: Sequence[StateSpace], states: np.ndarray | float = 0.0) -> None:
        """Start in the states `states`, (R, n)."""
        systems = [(model.a, model.b, model.c, model.d) for model in models]
        first, places = distinct(tuple(map(np.ndarray.tobytes, each)) for each in systems)
        # From states and inputs to the next states and the output, (n + 1, n + m) each.
        maps = [np.block([[a, b], [c, d]]) for a, b, c, d in (systems[index] for index in first)]
        self._matrix = by_run(maps, places)
        self._order = len(models[0].a)
        self._states_and_inputs = np.zeros((len(models), self._matrix.shape[-1]))
        self._states_and_inputs[:, : self._order] = states

    def update(self, *inputs: np.ndarray) -> np.ndarray:
        """Return the outputs of this period, (R,), and advance the states by one period."""
        values = self._states_and_inputs
        for place, each in enumerate(inputs, self._order):
            values[:, place] = each
        following = product(self._matrix, values)
        values[:, : self._order] = following[:, :-1]
        return following[:, -1]

    def reset(self, which: np.ndarray) -> None:
        """Set the states of the runs of a mask (R,) to zero."""
        self._states_and_inputs[which, : self._order] = 0.0


Curve = tuple[Sequence[float], Sequence[float]]
"""Abscissas and values of the points; none: a factor of 1 everywhere."""


class Curves:
    """A curve for each of R runs, linear between its points and constant outside."""

    def __init__(self, curves: Sequence[Curve]) -> None:
        """Take the points of each run's curve."""
        first, places = distinct((tuple(xs), tuple(ys)) for xs, ys in curves)
        self._curves = [(np.array(curves[i][0]), np.array(curves[i][1])) for i in first]
        self._runs = [np.flatnonzero(places == place) for place in range(len(first))]
        self.constant = not any(xs.size for xs, _ in self._curves)
        """Whether no curve has points."""

    def at(self, x: np.ndarray) -> np.ndarray:
        """Return the value of each run's curve at its x, (R,)."""
        if len(self._curves) == 1:
            return _value(*self._curves[0], x)
        values = np.empty_like(x)
        for (xs, ys), runs in zip(self._curves, self._runs, strict=True):
            values[runs] = _value(xs, ys, x[runs])
        return values


def _value(xs: np.ndarray, ys: np.ndarray, x: np.ndarray) -> np.ndarray:
    return np.interp(x, xs, ys) if xs.size else np.ones_like(x)
