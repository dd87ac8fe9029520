"""Bounds of a program's rows at one step; the rate of the clutch torque goes before its level."""

import numpy as np

from ddct_controllers.mpc.program.horizon import CondensedProgram
from ddct_controllers.mpc.program.settings import MpcSettings
from ddct_plant.base.timebase import PERIOD_S

CLUTCH = 0
"""Place of the clutch among the inputs."""
ROOM = 1e-9
"""Relative: levels give way by so much more than they must, or rounding may leave no request."""


class Limits:
    """
    Limits of the clutch torque request, so that there always is such a request, and of outputs.

    A limit of the level that the rate cannot keep, as the last request is too far beyond it, gives
    way to the nearest level that the rate reaches.
    """

    def __init__(self, program: CondensedProgram, settings: MpcSettings) -> None:
        terms = settings.inputs[CLUTCH]
        self._program = program
        self._rows, self._soft_rows = program.level_rows[CLUTCH], program.structure.soft_rows
        self._lowest, self._highest = terms.lowest, terms.highest
        self._change = terms.rate_n_m_s * PERIOD_S
        self._reach = self._change * np.arange(1, len(self._rows) + 1)

    def bounds(self, last: float, divisor: float = 1.0) -> tuple[np.ndarray, np.ndarray]:
        """
        Return the lower and the upper bounds of the program's rows, before their shift.

        `last` is the request before in N m, `divisor` what the program's outputs are divided by.
        """
        lower, upper = self._program.lower, self._program.upper
        room = ROOM * (1.0 + abs(last))
        nearest = self._change - room
        kept = self._lowest <= last + nearest and last - nearest <= self._highest
        soft = divisor != 1.0 and len(self._soft_rows)
        if kept and not soft:
            return lower, upper
        lower, upper = lower.copy(), upper.copy()
        if not kept:
            reach = self._reach - room
            lower[self._rows] = np.minimum(lower[self._rows], last + reach)
            upper[self._rows] = np.maximum(upper[self._rows], last - reach)
        if soft:
            lower[self._soft_rows] /= divisor
            upper[self._soft_rows] /= divisor
        return lower, upper

    def nearest(self, level: float, last: float) -> float:
        """Return the request nearest to `level` in N m; `last` is the one before."""
        level = min(max(level, self._lowest), self._highest)
        return min(max(level, last - self._change), last + self._change)
