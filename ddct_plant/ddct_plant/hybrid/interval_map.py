# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A mode over an interval of equal pieces, as matrix products."""

from collections.abc import Callable
from dataclasses import dataclass
from operator import mul
from typing import NamedTuple

import numpy as np

from ddct_plant.hybrid.friction_system import IntervalLayout, Signs, Values
from ddct_plant.hybrid.mode_flow import ModeFlow
from ddct_plant.hybrid.polynomials import linear_weights

BLOCK = 9000
"""Most elements of a matrix in one product: from 9216 OpenBLAS uses threads, with other
rounding."""

ROUNDING = 2.0**-52
"""Singular value that counts as zero, over the largest one."""


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


class IntervalMap:
    """
    Linear map of one mode over an interval from v = [x, *u, *c], see `IntervalLayout`, to its end.

    Between two nodes a guard's Bernstein coefficients may be below the straight line. This
    shortfall is a matrix times v. Its singular value decomposition reduces it to few numbers
    z = W v, without cancellation of large terms; no shortfall is larger, in units of its guard,
    than the sum of |z|.
    """

    def __init__(self, flow: ModeFlow, piece_s: float, layout: IntervalLayout) -> None:
        self._pieces, self._states, self._signs = layout.pieces, flow.states, flow.signs
        starts = _piece_starts(flow, layout)
        ends = flow.end @ starts
        guards = _over_pieces(flow.guards, starts)
        slips = piece_s * linear_weights(flow.degree) @ guards[:, flow.slip_guards]
        self._slipping = len(flow.slipping)
        self._sticking = [
            (i, flow.guarded.index(i)) for i, sign in enumerate(flow.signs) if not sign
        ]
        """Index of each sticking element and of its first guard."""
        flat = [part.reshape(layout.pieces, -1, starts.shape[2]) for part in (slips, guards)]
        by_piece = np.concatenate([ends, *flat], axis=1)
        self._by_piece = _product(by_piece.reshape(-1, by_piece.shape[2]))
        last = starts[-1, flow.states :]
        driven = np.vstack([ends[-1], last[: flow.inputs] + last[flow.inputs :]])
        rows = [ends[-1], flow.force @ driven]
        self._friction = slice(flow.states, flow.states + len(flow.force))
        self._work: list[tuple[int, slice, slice]] = []
        """Index, slice of the integrals and slice of the capacities of each slipping element."""
        self._held_work: list[tuple[int, int, int]] = []
        """Indices of the element, its integral and its capacity, for each slipping element with a
        held capacity; a sum would take longer."""
        first = self._friction.stop
        for place, element in enumerate(flow.slipping):
            where = layout.capacities[element]
            held = where.stop - where.start == 1
            rows.append(_by_value(slips[:, place], held=held))
            integrals = slice(first, first + len(rows[-1]))
            if held:
                self._held_work.append((element, first, where.start))
            else:
                self._work.append((element, integrals, where))
            first = integrals.stop
        units, directions = _shortfalls(flow.guards, starts)
        nodes = np.concatenate([guards[:, :, 0], guards[-1:, :, -1]]) / units[:, None]
        rows += [nodes.reshape(-1, nodes.shape[2]), directions]
        self._guards = slice(first, first + len(rows[-2]))
        self._shortfalls = slice(self._guards.stop, None)
        self._whole = _product(np.vstack(rows))

    def whole(self, v: np.ndarray, capacities: Values) -> Interval | None:
        """Return the result of the interval, or None if an event in it is possible."""
        values = self._whole(v).tolist()
        # Not `<`: a value that is not a number must not pass either.
        if not min(values[self._guards]) >= sum(map(abs, values[self._shortfalls])):
            return None
        work = [0.0] * len(self._signs)
        for element, integrals, where in self._work:
            work[element] = sum(map(mul, values[integrals], capacities[where]))
        for element, integral, place in self._held_work:
            work[element] = values[integral] * capacities[place]
        return Interval(values[: self._states], self._signs, [], work, values[self._friction])

    def by_piece(self, v: np.ndarray) -> tuple[np.ndarray, np.ndarray, int]:
        """
        Return states, slip integrals and event-free pieces, as if the mode lasted for all pieces.

        The states are those after each piece, (P, n). The integrals are those of |s| (1 - t) and
        |s| t, t from 0 to 1 in a piece, (P, slipping elements, 2). The last result is the number
        of pieces before the first in which a guard may become negative.
        """
        values = self._by_piece(v).reshape(self._pieces, -1)
        slips = self._states + 2 * self._slipping
        # Not `<`: a value that is not a number must not pass either.
        safe = values[:, slips:] >= 0.0
        first = int(safe.argmin())
        lasts = self._pieces if safe.flat[first] else first // safe.shape[1]
        integrals = values[:, self._states : slips].reshape(self._pieces, self._slipping, 2)
        return values[:, : self._states], integrals, lasts

    def friction_signs(self, v: np.ndarray) -> list[int]:
        """Return the sign of each friction torque while the mode lasts, 0 where it may change."""
        signs = list(self._signs)
        if self._sticking:
            slips = self._states + 2 * self._slipping
            values = self._by_piece(v).reshape(self._pieces, -1)[:, slips:]
            # Bernstein coefficients: no torque lies outside of theirs.
            guards = values.reshape(self._pieces, len(signs) + len(self._sticking), -1)
            for element, first in self._sticking:
                twice = guards[:, first + 1] - guards[:, first]
                signs[element] = int(twice.min() > 0.0) - int(twice.max() < 0.0)
        return signs


def _product(matrix: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    """Return a function that multiplies the matrix by a vector."""
    height = max(1, BLOCK // max(1, matrix.shape[1]))
    blocks = [matrix[i : i + height].copy() for i in range(0, len(matrix), height)]
    if len(blocks) == 1:
        return blocks[0].dot
    return lambda v: np.concatenate([block.dot(v) for block in blocks])


def _piece_starts(flow: ModeFlow, layout: IntervalLayout) -> np.ndarray:
    """Return the linear maps (P, y, v) from v to y at the start of each piece."""
    states, inputs = flow.states, flow.inputs
    starts = np.zeros((layout.pieces, states + 2 * inputs, states + layout.width))
    starts[0, :states, :states] = np.eye(states)
    values = np.eye(states + layout.width)[states:]
    for piece, start in enumerate(starts):
        if piece:
            start[:states] = flow.end @ starts[piece - 1]
        first, last = values[layout.nodes[piece : piece + 2]]
        start[states : states + inputs] = first
        start[states + inputs :] = last - first
    return starts


def _over_pieces(rows: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """Convert rows (i, j, y) on the start of each piece to rows (P, i, j, v) on v."""
    flat = rows.reshape(-1, rows.shape[2]) @ starts
    return flat.reshape(len(starts), *rows.shape[:2], -1)


def _by_value(slips: np.ndarray, held: bool) -> np.ndarray:
    """Return the slip integrals (values, v), one per capacity, for `slips` (P, 2, v)."""
    if held:
        return slips.sum(axis=(0, 1))[None]
    none = np.zeros_like(slips[:1, 0])
    return np.vstack([slips[:, 0], none]) + np.vstack([none, slips[:, 1]])


def _shortfalls(guards: np.ndarray, starts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return units of the guards and W (r, v): in these units no shortfall is above sum |W v|."""
    part = np.linspace(0.0, 1.0, guards.shape[1])[:, None]
    off = guards - (1.0 - part) * guards[:, :1] - part * guards[:, -1:]
    units = np.abs(off).max(axis=(1, 2))
    units[units == 0.0] = 1.0
    off /= units[:, None, None]
    in_a_piece = _directions(off.reshape(-1, off.shape[2]))
    directions = _directions((in_a_piece @ starts).reshape(-1, starts.shape[2]))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    parts = np.abs(_over_pieces(off, starts @ directions.T))
    return units, parts.max(axis=(0, 1, 2))[:, None] * directions


def _directions(matrix: np.ndarray) -> np.ndarray:
    """Return the right singular vectors (r, v), times their singular values."""
    _, values, rows = np.linalg.svd(matrix, full_matrices=False)
    kept = values > ROUNDING * values.max(initial=0.0)
    return values[kept, None] * rows[kept]
