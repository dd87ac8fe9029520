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
        self._flows = {
            signs: ModeFlow(system, signs, piece_s)
            for signs in product((-1, 0, 1), repeat=system.elements)
        }
        self._maps = {
            signs: IntervalMap(flow, piece_s, self._pieces, self._columns)
            for signs, flow in self._flows.items()
        }
        # A single number by its index: numpy writes it in a third of the time.
        self._places = [c.start if c.stop - c.start == 1 else c for c in self._columns]
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
        require_capacities(kinetic, static)
        interval_map = self._maps[signs]
        v = self._argument(state, signs, inputs, kinetic, static)
        product = interval_map.apply(v)
        guards = product[interval_map.first_guard :]
        if guards[guards.argmin()] >= 0.0:
            work = [0.0] * len(signs)
            for element, integrals, capacities in interval_map.work:
                work[element] = float(product[integrals].dot(v[capacities]))
            friction = product[interval_map.friction].tolist()
            return Interval(interval_map.states(product), signs, [], work, friction)
        forcing = Forcing(inputs, kinetic, static, self._pieces + 1)
        return self._through_events(state, signs, forcing)

    def _argument(
        self,
        state: np.ndarray,
        signs: Signs,
        inputs: Sequence[Value],
        kinetic: Sequence[Value],
        static: Sequence[Value],
    ) -> np.ndarray:
        """Return v, the argument of the map of a mode, for a whole interval."""
        v = self._v
        v[: self._states] = state
        in_force = [
            low if sign else high for sign, low, high in zip(signs, kinetic, static, strict=True)
        ]
        try:
            for where, value in zip(self._places, (*inputs, *in_force), strict=True):
                v[where] = value
        except ValueError as error:
            raise ParameterError(
                f'friction: the inputs {inputs} and capacities {in_force} do not fit the '
                f'interval: {error}'
            ) from error
        return v

    def _rest_argument(
        self, state: np.ndarray, signs: Signs, forcing: Forcing, piece: int
    ) -> np.ndarray:
        """Return v for the rest of the interval from `piece` on."""
        nodes = np.roll(forcing.nodes(signs), -piece, axis=0)
        values = [nodes[: c.stop - c.start, j] for j, c in enumerate(self._columns)]
        return np.concatenate((state, *values))

    def _through_events(self, state: np.ndarray, signs: Signs, forcing: Forcing) -> Interval:
        """Advance over pieces without an event at once, and through the others one by one."""
        states = np.zeros((self._pieces, self._states))
        motion = Motion(self.system, self._flows, self._piece_s, forcing, state, signs)
        piece = 0
        while piece < self._pieces:
            interval_map = self._maps[motion.signs]
            product = interval_map.apply(
                self._rest_argument(motion.state, motion.signs, forcing, piece)
            )
            ends, guards = interval_map.states(product), interval_map.guards(product)
            left = self._pieces - piece
            eventful = ~(guards[:, :, :left] >= 0.0).all(axis=(0, 1))
            quiet = int(eventful.argmax()) if eventful.any() else left
            motion.pass_quiet_pieces(piece, ends[:quiet], guards[:, :, :quiet])
            states[piece : piece + quiet] = ends[:quiet]
            piece += quiet
            if quiet < left:
                states[piece] = motion.pass_piece(piece)
                piece += 1
        return Interval(states, motion.signs, motion.events, motion.work, motion.friction())
