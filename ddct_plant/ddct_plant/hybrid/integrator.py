"""The exact integration of a linear system with dry friction, from event to event."""

from collections.abc import Sequence
from itertools import product
from typing import NamedTuple

import numpy as np

from ddct_plant.base.checks import require_number
from ddct_plant.base.errors import ParameterError
from ddct_plant.hybrid.forcing import Forcing, Value, require_capacities
from ddct_plant.hybrid.friction_system import FrictionSystem
from ddct_plant.hybrid.interval_map import IntervalMap
from ddct_plant.hybrid.mode_choice import SLACKS
from ddct_plant.hybrid.mode_flow import ModeFlow, Signs
from ddct_plant.hybrid.motion import Event, Motion


class Interval(NamedTuple):
    """What an interval ends with, and what happened in it."""

    state: np.ndarray
    """(n,) at the end."""
    signs: Signs
    """The mode at the end."""
    events: list[Event]
    work: list[float]
    """(N,) friction work of each element, the integral of c |s|, >= 0."""
    friction: list[float]
    """(N,) friction torques at the end, left limits."""


class HybridIntegrator:
    """
    Integrates a FrictionSystem over intervals of equal pieces, in which inputs are linear.

    Between events a mode's flow is a matrix exponential, taken by its series, which is exact to
    rounding over one piece. Slips and margins are then polynomials in time. One product gives
    the new state together with lower bounds of their Bernstein coefficients; if none is negative
    there is no event. Otherwise the interval is passed piece by piece, in which the coefficients
    themselves tell: the first root is found on the polynomial, and the motion goes on from there
    in the mode that `choose_mode` gives.

    It holds nothing of a motion, so that threads and runs may share it.
    """

    def __init__(
        self,
        system: FrictionSystem,
        piece_s: float,
        pieces: int,
        held: Sequence[int] = (),
    ) -> None:
        """Prepare all modes; `held` lists the entries of [u, c] that are held over an interval."""
        self.system = system
        self._piece_s = require_number('piece_s', piece_s, above=0.0)
        self._pieces = int(require_number('pieces', pieces, at_least=1))
        self._states, inputs = system.b.shape
        capacities = range(inputs, inputs + system.elements)
        columns = self._layout(
            [j in set(held) for j in (*range(inputs), *capacities, *capacities)]
        )
        self._flows = {
            signs: ModeFlow(system, signs, piece_s)
            for signs in product((-1, 0, 1), repeat=system.elements)
        }
        self._maps = {
            signs: IntervalMap(flow, piece_s, self._pieces, columns)
            for signs, flow in self._flows.items()
        }
        # A single number by its index: numpy writes it in a third of the time.
        self._places = [c.start if c.stop - c.start == 1 else c for c in columns]
        self._width = columns[-1].stop
        self._nodes = np.array(
            [np.broadcast_to(np.arange(c.start, c.stop), self._pieces + 1) for c in columns]
        ).T
        """(nodes, m + 2 N): where in v each value at a node is."""

    def _layout(self, held: Sequence[bool]) -> list[slice]:
        """Return the place in v of each of u, of the kinetic and of the static capacities."""
        columns, start = [], self._states
        for once in held:
            stop = start + (1 if once else self._pieces + 1)
            columns.append(slice(start, stop))
            start = stop
        return columns

    def mode_of(self, state: np.ndarray, locked: Sequence[int] = ()) -> Signs:
        """
        Return the mode of a state (n,): an element whose slip is 0 sticks until its torque tells.

        Raise ParameterError when one that is called `locked` has a slip.
        """
        slips = self.system.h @ state
        sizes = SLACKS[0] * np.abs(self.system.h) @ np.abs(state)
        for element in locked:
            if abs(slips[element]) > sizes[element]:
                raise ParameterError(
                    f'element {element} is called locked, but its slip is {slips[element]:g}'
                )
            slips[element] = 0.0
        return tuple(np.sign(slips).astype(int).tolist())

    def advance(
        self,
        state: np.ndarray,
        signs: Signs,
        inputs: Sequence[Value],
        kinetic: Sequence[Value],
        static: Sequence[Value],
    ) -> Interval:
        """
        Integrate one interval from `state` (n,) in the mode `signs`.

        `inputs` are u (m entries), `kinetic` and `static` the capacities (N entries). Raise
        ParameterError for a capacity that is negative or a static one below the kinetic one.
        """
        v = self._argument(state, inputs, kinetic, static)
        interval_map = self._maps[signs]
        product = interval_map.apply(v)
        if product is None:
            require_capacities(kinetic, static)
            return self._through_pieces(signs, v)
        work = [0.0] * len(signs)
        for element, integrals, capacities in interval_map.work:
            work[element] = float(product[integrals].dot(v[capacities]))
        friction = product[interval_map.friction].tolist()
        return Interval(product[: self._states], signs, [], work, friction)

    def _argument(
        self,
        state: np.ndarray,
        inputs: Sequence[Value],
        kinetic: Sequence[Value],
        static: Sequence[Value],
    ) -> np.ndarray:
        """Return v, the argument of the map of a mode."""
        v = np.empty(self._width)
        v[: self._states] = state
        try:
            for where, value in zip(self._places, (*inputs, *kinetic, *static), strict=True):
                v[where] = value
        except (TypeError, ValueError) as error:
            require_capacities(kinetic, static)
            raise ParameterError(
                f'friction: the inputs {inputs} and capacities {kinetic} do not fit the '
                f'interval: {error}'
            ) from error
        return v

    def _through_pieces(self, signs: Signs, v: np.ndarray) -> Interval:
        """Advance piece by piece, as there may be an event in any."""
        forcing = Forcing(v[self._nodes], len(signs))
        motion = Motion(self.system, self._flows, self._piece_s, forcing, v[: self._states], signs)
        for piece in range(self._pieces):
            motion.pass_piece(piece)
        return Interval(motion.state, motion.signs, motion.events, motion.work, motion.friction())
