"""A mode over an interval of equal pieces, as one matrix product."""

import numpy as np

from ddct_plant.hybrid.mode_flow import ModeFlow
from ddct_plant.hybrid.polynomials import bernstein_of_powers, linear_weights

BLOCK = 9000
"""Most elements of a matrix in one product: from 9216 OpenBLAS uses threads, and rounds anew."""


class IntervalMap:
    """
    From the start of an interval to its states, its guards and its friction work.

    The argument is v = [x, the values of each input of w: one if it is held, else one a node].
    The product holds states at the end of each piece (pieces, n); for each element that slips
    what times its capacity in v is its friction work; and the guards' Bernstein coefficients.
    An interval of fewer pieces, whose later nodes may be anything, has the same first pieces.
    """

    def __init__(self, flow: ModeFlow, piece_s: float, pieces: int, columns: list[slice]) -> None:
        """Take in `columns` the place in v of each input."""
        self.flow = flow
        self._pieces = pieces
        starts = _piece_starts(flow, pieces, columns)
        bernstein = bernstein_of_powers(flow.degree)
        guards = np.einsum('jk,kgy,pyv->gjpv', bernstein, flow.series[:, flow.states :], starts)
        end = flow.series[:, : flow.states].sum(axis=0)
        rows = list((end @ starts).reshape(-1, starts.shape[2]))
        self.friction = slice(len(rows), len(rows) + len(flow.signs))
        """Where the friction torques (N,) at the end of the interval are."""
        last = starts[-1, flow.states :]
        ends = np.vstack([rows[-flow.states :], last[: flow.inputs] + last[flow.inputs :]])
        rows += list(flow.force @ ends)
        self.work: list[tuple[int, slice, slice]] = []
        """By element that slips: its number, where its integrals are, where its capacity is."""
        first_capacity = flow.inputs - len(flow.signs)
        for guard, element in enumerate(flow.guarded):
            if flow.signs[element]:
                column = columns[first_capacity + element]
                integrals = piece_s * _by_node(guards[guard], column)
                stop = len(rows) + len(integrals)
                self.work.append((element, slice(len(rows), stop), column))
                rows += list(integrals)
        self.first_guard = len(rows)
        rows += list(guards.reshape(-1, starts.shape[2]))
        height = BLOCK // starts.shape[2]
        self._blocks = [np.array(rows[i : i + height]) for i in range(0, len(rows), height)]

    def apply(self, v: np.ndarray) -> np.ndarray:
        """Return the product with v, flat."""
        if len(self._blocks) == 1:
            return self._blocks[0].dot(v)
        return np.concatenate([block.dot(v) for block in self._blocks])

    def states(self, product: np.ndarray) -> np.ndarray:
        """Return the states (pieces, n) at the end of each piece."""
        return product[: self._pieces * self.flow.states].reshape(self._pieces, -1)

    def guards(self, product: np.ndarray) -> np.ndarray:
        """Return the Bernstein coefficients (guards, d+1, pieces) of the guards."""
        shape = (len(self.flow.guarded), self.flow.degree + 1, self._pieces)
        return product[self.first_guard :].reshape(shape)


def _piece_starts(flow: ModeFlow, pieces: int, columns: list[slice]) -> np.ndarray:
    """Return (pieces, y, v): y at the start of each piece as linear maps of v."""
    width = columns[-1].stop if columns else flow.states
    states, inputs = flow.states, flow.inputs
    starts = np.zeros((pieces, states + 2 * inputs, width))
    starts[0, :states, :states] = np.eye(states)
    end = flow.series[:, :states].sum(axis=0)
    for piece, start in enumerate(starts):
        if piece:
            start[:states] = end @ starts[piece - 1]
        for j, column in enumerate(columns):
            if column.stop - column.start == 1:
                start[states + j, column.start] = 1.0
            else:
                start[states + j, column.start + piece] = 1.0
                start[states + inputs + j, column.start + piece] = -1.0
                start[states + inputs + j, column.start + piece + 1] = 1.0
    return starts


def _by_node(guard: np.ndarray, column: slice) -> np.ndarray:
    """Return (values of the capacity, v): the integrals of slip times the hat of each value."""
    before, after = np.einsum('wj,jpv->wpv', linear_weights(len(guard) - 1), guard)
    if column.stop - column.start == 1:
        return np.sum(before + after, axis=0)[None]
    none = np.zeros((1, guard.shape[2]))
    return np.vstack([before, none]) + np.vstack([none, after])
