# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A mode over an interval of equal pieces, as matrix products."""

from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import dataclass
from functools import cached_property
from operator import mul
from typing import NamedTuple

import numpy as np

from ddct_plant.hybrid.friction_system import IntervalLayout, Signs, Values
from ddct_plant.hybrid.mode_flow import Course, ModeFlow

BLOCK = 9000
"""Most elements of a matrix in one product: from 9216 OpenBLAS uses threads, with other
rounding."""


class Event(NamedTuple):
    """Event of an element: it locks, is released, or reverses its slip."""

    time_s: float
    """Time of the event in s, from the start of the interval."""
    element: int
    """Index of the element."""
    kind: str
    """Kind of the event: `lock`, `release` or `reverse`."""
    slip_acceleration: float
    """Slip acceleration just before the event, per s^2 of the slip's angle; after a release."""


@dataclass(slots=True)
class Interval:
    """Result of an interval: state and mode at its end, events and friction work in it."""

    state: list[float]
    """State at the end, (n,)."""
    signs: Signs
    """Mode at the end."""
    events: list[Event]
    """Events in the interval, in the order of time."""
    work: list[float]
    """Friction work of each element, (N,): the integral of c |s|, not negative."""
    friction: list[float]
    """Friction torques at the end, (N,), left limits."""
    courses: Sequence[tuple[Course, float]] = ()
    """Courses in their order, and the part of a piece each lasts; empty unless they were kept."""


class ManyEnds(NamedTuple):
    """Results of the intervals of R motions in one mode, as if none had an event."""

    state: np.ndarray
    """States at the end, (R, n)."""
    friction: np.ndarray
    """Friction torques at the end, (R, N), left limits."""
    work: np.ndarray
    """Friction work of each element, (R, N)."""
    least: np.ndarray
    """Least value of the guards of each element, (R, N); an event is possible if negative."""


class IntervalMap:
    """
    Linear map of one mode over an interval from v = [x, *u, *c], see `IntervalLayout`, to its end.

    It also gives what must not be negative in an interval without an event, see `guard_checks`.
    """

    def __init__(self, flow: ModeFlow, piece_s: float, layout: IntervalLayout) -> None:
        self._pieces, self._states, self._signs = layout.pieces, flow.states, flow.signs
        self._guarded = flow.guarded
        self._slipping = len(flow.slipping)
        self._sticking = [
            (i, flow.guarded.index(i)) for i, sign in enumerate(flow.signs) if not sign
        ]
        """Index of each sticking element and of its first guard."""
        starts = _piece_starts(flow, layout)
        stack, width = starts.shape[:-3], starts.shape[-1]
        ends = flow.end[..., None, :, :] @ starts
        slips = piece_s * _over_pieces(flow.slip_integrals(), starts)
        checks = _over_pieces(flow.guard_checks(), starts)
        flat = [part.reshape(*stack, layout.pieces, -1, width) for part in (slips, checks)]
        by_piece = np.concatenate([ends, *flat], axis=-2).reshape(*stack, -1, width)
        end, last = ends[..., -1, :, :], starts[..., -1, flow.states :, :]
        at_end = last[..., : flow.inputs, :] + last[..., flow.inputs :, :]
        results = [end, flow.force @ np.concatenate([end, at_end], axis=-2)]
        self._friction = slice(flow.states, flow.states + len(flow.signs))
        results += self._work_rows(slips, flow.slipping, layout)
        self._results = sum(part.shape[-2] for part in results)
        """Number of values before the checks."""
        # The end of a piece is the start of the next one.
        within = checks[..., :-1, :, :].reshape(*stack, -1, width)
        self._rows = np.concatenate([*results, within, checks[..., -1, -1, :, :]], axis=-2)
        self._of_pieces = by_piece

    def of_system(self, place: int) -> 'IntervalMap':
        """Return the map of one system of a stack."""
        interval_map = copy(self)
        interval_map._rows, interval_map._of_pieces = self._rows[place], self._of_pieces[place]
        return interval_map

    @cached_property
    def _by_piece(self) -> Callable[[np.ndarray], np.ndarray]:
        return _product(self._of_pieces)

    @cached_property
    def _whole(self) -> Callable[[np.ndarray], np.ndarray]:
        return _product(self._rows)

    def _work_rows(
        self, slips: np.ndarray, slipping: list[int], layout: IntervalLayout
    ) -> list[np.ndarray]:
        """Return the rows on v of the slip integrals for the work, and set where they are."""
        self._work: list[tuple[int, slice, slice]] = []
        """Index, slice of the integrals and slice of the capacities of each slipping element."""
        self._held_work: list[tuple[int, int, int]] = []
        """Indices of the element, its integral and its capacity, for each slipping element with a
        held capacity; a sum would take longer."""
        rows: list[np.ndarray] = []
        first = self._friction.stop
        for place, element in enumerate(slipping):
            where = layout.capacities[element]
            held = where.stop - where.start == 1
            rows.append(_by_value(slips[..., place, :], held=held))
            integrals = slice(first, first + rows[-1].shape[-2])
            if held:
                self._held_work.append((element, first, where.start))
            else:
                self._work.append((element, integrals, where))
            first = integrals.stop
        return rows

    def whole(self, v: np.ndarray, capacities: Values) -> Interval | None:
        """Return the result of the interval, or None if an event in it is possible."""
        values = self._whole(v)
        checks = values[self._results :]
        # Not `<`: a value that is not a number must not pass either.
        if not checks[checks.argmin()] >= 0.0:
            return None
        results = values[: self._results].tolist()
        work = [0.0] * len(self._signs)
        for element, integrals, where in self._work:
            work[element] = sum(map(mul, results[integrals], capacities[where]))
        for element, integral, place in self._held_work:
            work[element] = results[integral] * capacities[place]
        return Interval(results[: self._states], self._signs, [], work, results[self._friction])

    def matrix(self) -> np.ndarray:
        """Return the map from v to the values that `of_many` reads, (rows, v)."""
        results, checks = np.split(self._rows, [self._results])
        by_guard = checks.reshape(-1, len(self._guarded), checks.shape[1]).swapaxes(0, 1)
        return np.vstack([results, by_guard.reshape(checks.shape)])

    def of_many(self, values: np.ndarray, capacities: np.ndarray) -> 'ManyEnds':
        """
        Return the results of the intervals of R motions, as if none had an event.

        `values` are the products of `matrix()` and the v of each motion, (R, rows), `capacities`
        those in the v, (R, c).
        """
        least = np.full((len(values), len(self._signs)), np.inf)
        checks = values[:, self._results :].reshape(len(values), len(self._guarded), -1)
        for element, of_guard in zip(self._guarded, checks.min(axis=2).T, strict=True):
            np.minimum(least[:, element], of_guard, out=least[:, element])
        work = np.zeros_like(least)
        for element, integrals, where in self._work:
            work[:, element] = (values[:, integrals] * capacities[:, where]).sum(axis=1)
        for element, integral, place in self._held_work:
            work[:, element] = values[:, integral] * capacities[:, place]
        return ManyEnds(values[:, : self._states], values[:, self._friction], work, least)

    def slip_integrals(self, element: int) -> np.ndarray:
        """
        Return the rows on v of the integrals of |s| of a slipping element, (P + 1, v).

        Each has the weight of a node, which is 1 there and linear to 0 at the nodes beside it, so
        that the sum of the integrals times the capacities at the nodes is the friction work.
        """
        rows = next(integrals for each, integrals, _ in self._work if each == element)
        return self._rows[rows]

    def twice_torque(self, element: int) -> np.ndarray:
        """Return the rows on v of twice the torque of a sticking element at the nodes, (k, v)."""
        first = dict(self._sticking)[element]
        checks = self._rows[self._results :].reshape(-1, len(self._guarded), self._rows.shape[1])
        return checks[:, first + 1] - checks[:, first]

    def by_piece(self, v: np.ndarray) -> tuple[np.ndarray, np.ndarray, int]:
        """
        Return states, slip integrals and event-free pieces, as if the mode lasted for all pieces.

        The states are those after each piece, (P, n). The integrals are those of |s| (1 - t) and
        |s| t, t from 0 to 1 in a piece, (P, 2, slipping elements). The last result is the number
        of pieces before the first in which a guard may become negative.
        """
        values = self._by_piece(v).reshape(self._pieces, -1)
        slips = self._states + 2 * self._slipping
        # Not `<`: a value that is not a number must not pass either.
        safe = values[:, slips:] >= 0.0
        first = int(safe.argmin())
        lasts = self._pieces if safe.flat[first] else first // safe.shape[1]
        integrals = values[:, self._states : slips].reshape(self._pieces, 2, self._slipping)
        return values[:, : self._states], integrals, lasts

    def friction_signs(self, v: np.ndarray) -> list[int]:
        """Return the sign of each friction torque while the mode lasts, 0 where it may change."""
        signs = list(self._signs)
        if self._sticking:
            guards = self._whole(v)[self._results :].reshape(-1, len(signs) + len(self._sticking))
            for element, first in self._sticking:
                twice = guards[:, first + 1] - guards[:, first]
                # Twice as fast as min and max.
                low, high = twice[twice.argmin()], twice[twice.argmax()]
                signs[element] = int(low > 0.0) - int(high < 0.0)
        return signs


def _product(matrix: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    """Return a function that multiplies the matrix by a vector."""
    height = max(1, BLOCK // max(1, matrix.shape[1]))
    blocks = [matrix[i : i + height] for i in range(0, len(matrix), height)]
    if len(blocks) == 1:
        return blocks[0].dot
    return lambda v: np.concatenate([block.dot(v) for block in blocks])


def _piece_starts(flow: ModeFlow, layout: IntervalLayout) -> np.ndarray:
    """Return the linear maps (P, y, v) from v to y at the start of each piece."""
    states, inputs = flow.states, flow.inputs
    stack, width = flow.end.shape[:-2], states + layout.width
    starts = np.zeros((*stack, layout.pieces, states + 2 * inputs, width))
    starts[..., 0, :states, :states] = np.eye(states)
    values = np.eye(width)[states:][layout.nodes]
    starts[..., states : states + inputs, :] = values[:-1]
    starts[..., states + inputs :, :] = values[1:] - values[:-1]
    for piece in range(1, layout.pieces):
        starts[..., piece, :states, :] = flow.end @ starts[..., piece - 1, :, :]
    return starts


def _over_pieces(rows: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """Convert rows (i, j, y) on the start of each piece to rows (P, i, j, v) on v."""
    *stack, one, two, size = rows.shape
    flat = rows.reshape(*stack, 1, one * two, size) @ starts
    return flat.reshape(*flat.shape[:-2], one, two, starts.shape[-1])


def _by_value(slips: np.ndarray, held: bool) -> np.ndarray:
    """Return the slip integrals (values, v), one per capacity, for `slips` (P, 2, v)."""
    if held:
        return slips.sum(axis=(-3, -2))[..., None, :]
    falling, rising = slips[..., 0, :], slips[..., 1, :]
    none = np.zeros_like(falling[..., :1, :])
    return np.concatenate([falling, none], axis=-2) + np.concatenate([none, rising], axis=-2)
