"""The exact integration of a linear system with dry friction, from event to event."""

import struct
from collections.abc import Sequence
from itertools import product

import numpy as np

from ddct_plant.base.errors import ParameterError, require_number
from ddct_plant.hybrid.forcing import Forcing, Layout, Signs, Values
from ddct_plant.hybrid.friction_system import FrictionSystem
from ddct_plant.hybrid.interval_map import Interval, IntervalMap
from ddct_plant.hybrid.mode_choice import SLACKS
from ddct_plant.hybrid.mode_flow import ModeFlow
from ddct_plant.hybrid.motion import Motion


class HybridIntegrator:
    """
    Integrates a FrictionSystem over intervals of equal pieces, in which inputs are linear.

    Between events a mode's flow is a matrix exponential, taken by its series, which is exact to
    rounding over one piece. Slips and margins are then polynomials in time. One product gives
    the new state together with lower bounds of their Bernstein coefficients; if none is negative
    there is no event. Otherwise another gives the coefficients themselves, piece by piece. In the
    first piece that has a negative one the first root is found on the polynomial, and the motion
    goes on from there in the mode that `choose_mode` gives.

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
        count = int(require_number('pieces', pieces, at_least=1))
        self._layout = Layout(system.b.shape[1], system.elements, count, held)
        # A third faster than numpy, which looks at every value before it makes an array.
        self._pack = struct.Struct(f'{len(system.a) + self._layout.width}d').pack
        self._flows = {
            signs: ModeFlow(system, signs, piece_s)
            for signs in product((-1, 0, 1), repeat=system.elements)
        }
        self._maps = {
            signs: IntervalMap(flow, piece_s, self._layout) for signs, flow in self._flows.items()
        }

    def mode_of(self, state: Values, locked: Sequence[int] = ()) -> Signs:
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
        self, state: Values, signs: Signs, inputs: Values, kinetic: Values, static: Values
    ) -> Interval:
        """
        Integrate one interval from `state` (n,) in the mode `signs`.

        `inputs` are the values of u one after the other, `kinetic` and `static` those of the
        capacities: one each of what is held, else one for each node. Raise ParameterError for a
        capacity that is negative or a static one below the kinetic one.
        """
        capacities = self._layout.in_force(signs, kinetic, static)
        try:
            v = np.frombuffer(self._pack(*state, *inputs, *capacities))
        except struct.error as error:
            raise ParameterError(
                f'friction: the inputs {inputs} do not fit the interval: {error}'
            ) from error
        interval = self._maps[signs].whole(v, capacities)
        if interval is not None:
            return interval
        forcing = Forcing(self._layout, inputs, kinetic, static)
        start = v[: len(state)]
        motion = Motion(self.system, self._flows, self._maps, self._piece_s, forcing, start, signs)
        return motion.to_the_end()
