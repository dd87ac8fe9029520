"""What drives a system with friction over an interval."""

from collections.abc import Sequence

import numpy as np

from ddct_plant.hybrid.mode_flow import Signs

Value = float | Sequence[float]
"""An input over an interval: one number if it is held, else one for each node."""


class Forcing:
    """The inputs u and the kinetic and static capacities of an interval."""

    __slots__ = ('_inputs', '_kinetic', '_static')

    def __init__(
        self, inputs: Sequence[Value], kinetic: Sequence[Value], static: Sequence[Value]
    ) -> None:
        self._inputs, self._kinetic, self._static = inputs, kinetic, static

    def in_force(self, signs: Signs) -> list[Value]:
        """Return w = [u, c], each as it was given, with the capacities that count in a mode."""
        capacities = [
            low if sign else high
            for sign, low, high in zip(signs, self._kinetic, self._static, strict=True)
        ]
        return [*self._inputs, *capacities]

    def at(self, signs: Signs, piece: int, part: float) -> np.ndarray:
        """Return [w, dw] after a `part` (0 to 1) of a piece; dw is the change over the piece."""
        values, changes = [], []
        for value in self.in_force(signs):
            if isinstance(value, float | int):
                values.append(value)
                changes.append(0.0)
            else:
                change = value[piece + 1] - value[piece]
                values.append(value[piece] + part * change)
                changes.append(change)
        return np.array(values + changes)
