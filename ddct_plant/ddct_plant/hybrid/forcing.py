"""What drives a system with friction over an interval: inputs and capacities."""

from collections.abc import Sequence
from operator import lt

import numpy as np

from ddct_plant.base.errors import ParameterError
from ddct_plant.hybrid.mode_flow import Signs

Value = float | Sequence[float] | np.ndarray
"""An input over an interval: one number if it is held, else one for each node."""
_NUMBER = (float, int)
"""As a tuple, for which `isinstance` takes a third of the time."""


def require_capacities(kinetic: Sequence[Value], static: Sequence[Value]) -> None:
    """Raise ParameterError for a negative capacity, or a static one below the kinetic one."""
    for element, (low, high) in enumerate(zip(kinetic, static, strict=True)):
        if isinstance(low, _NUMBER) and isinstance(high, _NUMBER):
            negative, below = low < 0.0, high < low
        elif isinstance(low, _NUMBER) or isinstance(high, _NUMBER):
            raise ParameterError(
                f'friction element {element}: give one number for both its kinetic and its '
                'static capacity, or one for each node'
            )
        else:
            negative, below = min(low) < 0.0, any(map(lt, high, low))
        if negative:
            raise ParameterError(
                f'friction element {element}: its capacity {low} must not be negative'
            )
        if below:
            raise ParameterError(
                f'friction element {element}: its static capacity {high} is below the kinetic '
                f'one {low}: give at least that'
            )


class Forcing:
    """The inputs w = [u, c] at the nodes, whichever mode they are asked in."""

    def __init__(
        self,
        inputs: Sequence[Value],
        kinetic: Sequence[Value],
        static: Sequence[Value],
        nodes: int,
    ) -> None:
        """Take in u (m entries) and the capacities (N entries each), held or by node."""
        self._inputs, self._kinetic, self._static = (
            np.array([np.broadcast_to(value, nodes) for value in values]).reshape(-1, nodes).T
            for values in (inputs, kinetic, static)
        )

    def nodes(self, signs: Signs) -> np.ndarray:
        """Return w (nodes, m + N), with the capacities that count in a mode."""
        capacities = np.where(signs, self._kinetic, self._static)
        return np.hstack([self._inputs, capacities])

    def at(self, signs: Signs, piece: int, part: float) -> np.ndarray:
        """Return [w, dw] after a `part` (0 to 1) of a piece; dw is the change over the piece."""
        start, end = self.nodes(signs)[piece : piece + 2]
        change = end - start
        return np.concatenate((start + part * change, change))
