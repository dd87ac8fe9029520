"""The exact integration of a linear system with dry friction, from event to event."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from operator import lt

import numpy as np

from ddct_plant.base.checks import require_number
from ddct_plant.base.errors import ParameterError
from ddct_plant.hybrid.forcing import Forcing, Value
from ddct_plant.hybrid.friction_system import FrictionSystem
from ddct_plant.hybrid.interval_map import IntervalMap
from ddct_plant.hybrid.mode_choice import SLACKS, choose_mode
from ddct_plant.hybrid.mode_flow import ModeFlow, Signs, series_degree
from ddct_plant.hybrid.motion import Event, Motion


@dataclass(frozen=True, slots=True)
class Interval:
    """What an interval ends with, and what happened in it."""

    states: np.ndarray
    """(pieces, n): the states at the end of each piece, the last of them the new state."""
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
    rounding over one piece. Slips and margins are then polynomials in time. Their Bernstein
    coefficients for the whole interval come with the new state out of one product; none is
    negative unless an event is near. Otherwise the first root is found on the polynomial, and
    the motion goes on from there in the mode that `choose_mode` gives.
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
        self._first_capacity = inputs
        self._columns = self._layout(set(held))
        stuck_sets = list(product((0, 1), repeat=system.elements))
        degree = series_degree(system, stuck_sets, piece_s)
        self._flows = {
            signs: ModeFlow(system, signs, piece_s, degree)
            for signs in product((-1, 0, 1), repeat=system.elements)
        }
        self._maps = {
            signs: IntervalMap(flow, piece_s, self._pieces, self._columns)
            for signs, flow in self._flows.items()
        }
        self._v = np.zeros(self._columns[-1].stop)

    def _layout(self, held: set[int]) -> list[slice]:
        columns, start = [], self._states
        for j in range(self._first_capacity + self.system.elements):
            stop = start + (1 if j in held else self._pieces + 1)
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
        for element, (low, high) in enumerate(zip(kinetic, static, strict=True)):
            _require_capacity(element, low, high)
        forcing = Forcing(inputs, kinetic, static)
        interval_map = self._maps[signs]
        v = self._argument(state, forcing.in_force(signs))
        product = interval_map.apply(v)
        if product[interval_map.first_guard :].min() >= 0.0:
            work = [0.0] * self.system.elements
            for element, integrals, column in interval_map.work:
                work[element] = float(product[integrals] @ v[column])
            friction = product[interval_map.friction].tolist()
            return Interval(interval_map.states(product), signs, [], work, friction)
        return self._through_events(state, signs, forcing)

    def _argument(
        self, state: np.ndarray, in_force: Sequence[Value], piece: int = 0
    ) -> np.ndarray:
        """Return v for the interval from `piece` on; behind its end the nodes are zero."""
        v = self._v
        v[: self._states] = state
        for column, value in zip(self._columns, in_force, strict=True):
            try:
                v[column] = value
            except ValueError as error:
                raise ParameterError(
                    f'friction: {value} cannot be an input: give {column.stop - column.start} numbers'
                ) from error
            if piece and column.stop - column.start > 1:
                v[column] = np.append(v[column][piece:], np.zeros(piece))
        return v

    def _through_events(self, state: np.ndarray, signs: Signs, forcing: Forcing) -> Interval:
        """Advance over pieces without an event at once, and through the others one by one."""
        states = np.zeros((self._pieces, self._states))
        motion = Motion(self.system, self._flows, self._piece_s, forcing, state, signs)
        piece = 0
        while piece < self._pieces:
            interval_map = self._maps[motion.signs]
            v = self._argument(motion.state, forcing.in_force(motion.signs), piece)
            product = interval_map.apply(v)
            ends, guards = interval_map.states(product), interval_map.guards(product)
            for ahead in range(self._pieces - piece):
                if not guards[:, :, ahead].min() >= 0.0:
                    motion.pass_piece(piece)
                    states[piece] = motion.state
                    piece += 1
                    break
                motion.add_work(guards[:, :, ahead], forcing.at(motion.signs, piece, 0.0), 1.0)
                states[piece] = motion.state = ends[ahead]
                piece += 1
        return Interval(states, motion.signs, motion.events, motion.work, motion.friction())


def _require_capacity(element: int, kinetic: Value, static: Value) -> None:
    low = (kinetic,) if isinstance(kinetic, float | int) else kinetic
    high = (static,) if isinstance(static, float | int) else static
    if min(low) < 0.0:
        raise ParameterError(
            f'friction element {element}: its capacity is {min(low):g}, it must not be negative'
        )
    if any(map(lt, high, low)):
        raise ParameterError(
            f'friction element {element}: its static capacity {static} is below the kinetic one '
            f'{kinetic}: give at least that'
        )
