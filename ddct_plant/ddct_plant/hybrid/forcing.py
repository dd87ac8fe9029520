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
    """The inputs w = [u, c] of each piece, whichever mode they are asked in."""

    def __init__(self, nodes: np.ndarray, elements: int) -> None:
        """Take in the values (nodes, m + 2 N) of u, the kinetic and the static capacities."""
        self._nodes, self._elements = nodes, elements
        self._by_mode: dict[Signs, np.ndarray] = {}

    def pieces(self, signs: Signs) -> np.ndarray:
        """Return [w, dw] (pieces, 2 (m + N)) in a mode; dw is the change over a piece."""
        if signs not in self._by_mode:
            count = self._elements
            first = self._nodes.shape[1] - 2 * count
            in_force = [first + i + (0 if sign else count) for i, sign in enumerate(signs)]
            w = self._nodes[:, [*range(first), *in_force]]
            self._by_mode[signs] = np.hstack([w[:-1], w[1:] - w[:-1]])
        return self._by_mode[signs]

    def at(self, signs: Signs, piece: int, part: float) -> np.ndarray:
        """Return [w, dw] after a `part` (0 to 1) of a piece."""
        forcing = self.pieces(signs)[piece].copy()
        inputs = len(forcing) // 2
        forcing[:inputs] += part * forcing[inputs:]
        return forcing
