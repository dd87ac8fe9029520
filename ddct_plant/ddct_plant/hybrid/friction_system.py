# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A linear system with dry-friction elements, and its inputs over an interval."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate, combinations, pairwise

import numpy as np

from ddct_plant.base.errors import ParameterError
from ddct_plant.linear.lti import own_matrices

Signs = tuple[int, ...]
"""Mode of a system: for each element 0 if it sticks, else the sign of its slip."""
Values = Sequence[float] | np.ndarray
SINGULAR = 1e-12
"""Principal minor of -h g that counts as zero, over the product of its diagonal."""


@dataclass(frozen=True, eq=False)
class FrictionSystem:
    """
    dx/dt = a x + b u + g f, slips s = h x, |f_i| at most the capacity c_i of element i.

    While it slips f_i = sign(s_i) c_i. A set S that sticks has constant slips zero, so
    f_S = -(h_S g_S)^-1 h_S (a x + b u + g_F f_F). All principal minors of -h g must be positive:
    then each element opposes its slip, no stuck set is singular, and at every instant exactly one
    set of friction torques is consistent as long as static and kinetic capacity are the same.
    """

    a: np.ndarray
    """State matrix, (n, n)."""
    b: np.ndarray
    """Input matrix, (n, m)."""
    g: np.ndarray
    """Matrix of the friction torques, (n, N)."""
    h: np.ndarray
    """Matrix from the state to the slips, (N, n)."""

    def __post_init__(self) -> None:
        """Check shapes, values and minors; raise ParameterError otherwise."""
        own_matrices(self, 'friction system', g='nN', a='nn', b='nm', h='Nn')
        mobility = -self.h @ self.g
        for i, own in enumerate(np.diag(mobility)):
            if own <= 0.0:
                raise ParameterError(
                    f'friction system: h g of element {i} is {0.0 - own:g}, it must be negative: '
                    'friction opposes the slip it acts on'
                )
        for size in range(2, self.elements + 1):
            for stuck in combinations(range(self.elements), size):
                block = mobility[np.ix_(stuck, stuck)]
                if np.linalg.det(block) <= SINGULAR * np.prod(np.diag(block)):
                    raise ParameterError(
                        f'friction system: h g of the elements {stuck} is singular: they cannot '
                        'stick together, as their slips or torques depend on each other'
                    )

    @cached_property
    def size_of_h(self) -> np.ndarray:
        """Magnitudes of `h`, (N, n), for bounds of the rounding of slips."""
        return np.abs(self.h)

    @property
    def elements(self) -> int:
        """Number N of friction elements."""
        return len(self.h)


def require_capacities(element: int, kinetic: Values, static: Values) -> None:
    """Raise ParameterError where a capacity of an element is negative, or static below kinetic."""
    if min(kinetic) < 0.0:
        raise ParameterError(
            f'friction element {element}: its capacity {min(kinetic)} must not be negative',
            key=f'friction element {element}',
        )
    for low, high in zip(kinetic, static, strict=True):
        if high < low:
            raise ParameterError(
                f'friction element {element}: its static capacity {high} is below the kinetic '
                f'one {low}: give at least that',
                key=f'friction element {element}',
            )


class IntervalLayout:
    """
    Positions of inputs u (m) and capacities c (N) of an interval, in a flat list of each.

    An entry has one value if it is held over the interval, else one at each of P + 1 nodes.
    """

    def __init__(self, inputs: int, elements: int, pieces: int, held: Sequence[int]) -> None:
        """Lay out m inputs and N capacities; `held` lists the entries of [u, c] that are held."""
        sizes = [1 if i in held else pieces + 1 for i in range(inputs + elements)]
        ends = [0, *accumulate(sizes)]
        self.pieces, self.inputs, self.width = pieces, ends[inputs], ends[-1]
        """Number P of pieces, number of values of the inputs, and of all entries together."""
        ends_of_capacities = pairwise(end - self.inputs for end in ends[inputs:])
        self.capacities = [slice(start, stop) for start, stop in ends_of_capacities]
        """Slice of each element's values in a list of capacities."""
        node = np.arange(pieces + 1)[:, None]
        self.nodes = np.minimum(np.array(ends[:-1]) + node, np.array(ends[1:]) - 1)
        """Index in [*u, *c] of the value of each entry at each node, (P + 1, m + N)."""
        last = np.repeat(np.array(ends[1:]) - 1, sizes)
        self.shifts = np.minimum(np.arange(self.width) + node, last)
        """Indices in [*u, *c] of the values of an interval that starts at a later node, (P + 1,
        width)."""

    def in_force(self, signs: Signs, kinetic: Values, static: Values) -> Values:
        """
        Return the capacities in a mode: static for elements that stick, else kinetic.

        Raise ParameterError for impossible capacities or a wrong number of them.
        """
        if static is kinetic and min(kinetic) >= 0.0:
            return kinetic
        count = self.width - self.inputs
        if (len(kinetic), len(static)) != (count, count):
            raise ParameterError(
                f'friction: {len(kinetic)} kinetic and {len(static)} static capacities do not fit '
                f'the interval, which has {count} of each'
            )
        capacities = list(kinetic)
        for element, where in enumerate(self.capacities):
            require_capacities(element, kinetic[where], static[where])
            if not signs[element]:
                capacities[where] = static[where]
        return capacities


class Forcing:
    """Inputs w = [u, c] over an interval, for any mode."""

    def __init__(
        self, layout: IntervalLayout, inputs: Values, kinetic: Values, static: Values
    ) -> None:
        """Use the flat values of u and of both kinds of capacities."""
        self.layout = layout
        self._inputs, self._kinetic, self._static = inputs, kinetic, static
        self._by_mode: dict[Signs, np.ndarray] = {}

    def values(self, signs: Signs) -> np.ndarray:
        """Return the values [*u, *c] in a mode."""
        if signs not in self._by_mode:
            capacities = self.layout.in_force(signs, self._kinetic, self._static)
            self._by_mode[signs] = np.array([*self._inputs, *capacities])
        return self._by_mode[signs]

    def at(self, signs: Signs, piece: int, part: float) -> np.ndarray:
        """Return w and its change dw over a piece, (2 (m + N),), at `part`, 0 to 1, of it."""
        start, end = self.values(signs)[self.layout.nodes[piece : piece + 2]]
        change = end - start
        return np.concatenate((start + part * change, change))
