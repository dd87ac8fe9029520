"""A mode over an interval of equal pieces, as one matrix product."""

from collections.abc import Sequence

import numpy as np

from ddct_plant.hybrid.mode_flow import ModeFlow
from ddct_plant.hybrid.polynomials import linear_weights

BLOCK = 9000
"""Most elements of a matrix in one product: from 9216 OpenBLAS uses threads, and rounds anew."""

ROUNDING = 2.0**-52
"""Singular values below this part of the largest one are zero."""
TINY = 1e-300


class IntervalMap:
    """
    From the start of an interval to its end, as long as no event can be in it.

    The argument is v = [x, the values of u, of the kinetic and of the static capacities: one if
    it is held, else one a node]. The product holds the state at the end (n,); the friction
    torques there (N,); for each element that slips what times its capacity in v is its friction
    work; and what tells that there is no event: kinetic capacities, static less kinetic ones and
    the guards at the nodes, which all must stay above what the last rows give.

    For between two nodes a guard's Bernstein coefficients may fall short of the straight line.
    How far is a matrix times v. With its singular values it is few numbers z = W v, small as no
    large terms cancel any more, and D |z| a bound that is close to the largest shortfall.
    """

    def __init__(
        self, flow: ModeFlow, piece_s: float, pieces: int, columns: Sequence[slice]
    ) -> None:
        """Take in `columns` the place in v of each of u, kinetic and static capacities."""
        elements = len(flow.signs)
        kinetic, static = columns[-2 * elements : -elements], columns[-elements:]
        in_force = [
            k if sign else s for sign, k, s in zip(flow.signs, kinetic, static, strict=True)
        ]
        starts = _piece_starts(flow, pieces, [*columns[: -2 * elements], *in_force])
        starts = np.pad(starts, ((0, 0), (0, 0), (0, columns[-1].stop - starts.shape[2])))
        last = starts[-1]
        end = flow.series[:, : flow.states].sum(axis=0) @ last
        inputs = last[flow.states : flow.states + flow.inputs] + last[flow.states + flow.inputs :]
        rows = [*end, *(flow.force @ np.vstack([end, inputs]))]
        self.friction = slice(len(end), len(rows))
        """Where the friction torques (N,) at the end of the interval are."""
        guards = np.tensordot(flow.guards, starts, axes=(2, 1))
        self.work: list[tuple[int, slice, slice]] = []
        """By element that slips: its number, where its integrals are, where its capacity is."""
        for guard, element in enumerate(flow.guarded):
            if flow.signs[element]:
                integrals = piece_s * _by_node(guards[guard], in_force[element])
                stop = len(rows) + len(integrals)
                self.work.append((element, slice(len(rows), stop), in_force[element]))
                rows += list(integrals)
        first = len(rows)
        unit = np.eye(columns[-1].stop)
        for low, high in zip(kinetic, static, strict=True):
            rows += [*unit[low], *(unit[high] - unit[low])]
        nodes = np.concatenate([guards[:, 0], guards[:, -1, -1:]], axis=1)
        bounds, directions = _shortfall(flow.guards, starts)
        none = np.zeros((len(rows) - first, len(directions)))
        self._bounds = _blocks(np.vstack([none, np.repeat(bounds, nodes.shape[1], axis=0)]))
        for guard in nodes:
            rows += list(guard)
        self._tested = slice(first, len(rows))
        self._directions = slice(len(rows), None)
        self._matrix = _blocks(np.vstack([*rows, *directions]))

    def apply(self, v: np.ndarray) -> np.ndarray | None:
        """Return the product with v, flat, or None if an event may be near or a capacity wrong."""
        product = _times(self._matrix, v)
        spare = product[self._tested] - _times(self._bounds, np.abs(product[self._directions]))
        # Not `< 0`: a value that is not a number must not pass either.
        return product if spare[spare.argmin()] >= 0.0 else None


def _blocks(matrix: np.ndarray) -> list[np.ndarray]:
    height = max(1, BLOCK // max(1, matrix.shape[1]))
    return [matrix[i : i + height].copy() for i in range(0, len(matrix), height)]


def _times(blocks: list[np.ndarray], v: np.ndarray) -> np.ndarray:
    if len(blocks) == 1:
        return blocks[0].dot(v)
    return np.concatenate([block.dot(v) for block in blocks])


def _piece_starts(flow: ModeFlow, pieces: int, columns: Sequence[slice]) -> np.ndarray:
    """Return (pieces, y, v): y at the start of each piece as linear maps of v."""
    width = max((column.stop for column in columns), default=flow.states)
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


def _shortfall(guards: np.ndarray, starts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return D (guards, r) and W (r, v): coefficients are off the lines by at most D |W v|."""
    part = np.linspace(0.0, 1.0, guards.shape[1])[:, None]
    off = guards - (1.0 - part) * guards[:, :1] - part * guards[:, -1:]
    # In units of each guard, as slips and torques share the directions.
    units = np.abs(off).max(axis=(1, 2), initial=TINY)[:, None, None]
    in_a_piece = _directions((off / units).reshape(-1, off.shape[2]))
    directions = _directions((in_a_piece @ starts).reshape(-1, starts.shape[2]))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    parts = np.tensordot(off, starts @ directions.T, axes=(2, 1))
    return np.abs(parts).max(axis=(1, 2)), directions


def _directions(matrix: np.ndarray) -> np.ndarray:
    """Return the rows (r, v) of the singular value decomposition, times their values."""
    _, values, rows = np.linalg.svd(matrix, full_matrices=False)
    kept = values > ROUNDING * values.max(initial=0.0)
    return values[kept, None] * rows[kept]
