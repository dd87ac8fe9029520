"""What a predictive controller may ask: of the clutch, and of the engine if it commands it."""

import math
from dataclasses import replace

import numpy as np

from ddct_controllers.interface import Measurement, Status
from ddct_controllers.mpc.program.horizon import CondensedProgram
from ddct_controllers.mpc.program.settings import InputTerms, MpcSettings
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.engine import MOST_AUTHORITY, EngineAuthority, EngineResponse

CLUTCH, ENGINE = range(2)
"""Places among the inputs."""
ROOM = 1e-9
"""Relative: levels give way by so much more than they must, or rounding may leave no request."""

Bounds = tuple[np.ndarray, np.ndarray]
"""Lower and upper bounds of the program's rows, before their shift."""


class ClutchInput:
    """
    The clutch torque request, open loop included, and its limits; the rate goes before the level.

    A limit of the level that the rate cannot keep, as the last request is too far beyond it, gives
    way to the nearest level that the rate reaches. So there always is a request within the limits.
    """

    def __init__(self, program: CondensedProgram, terms: InputTerms) -> None:
        self._program = program
        self._rows, self._soft_rows = program.level_rows[CLUTCH], program.structure.soft_rows
        self._lowest, self._highest = terms.lowest, terms.highest
        self._change = terms.rate_n_m_s * PERIOD_S
        self._reach = self._change * np.arange(1, len(self._rows) + 1)
        self.reset()

    def reset(self) -> None:
        """Ask for the open loop alone."""
        self._own_torque = 0.0
        self._open_loop: float | None = None

    def hold(self, measurement: Measurement) -> float:
        """Return the request in N m of the open loop alone, as the actuator is given it."""
        self._own_torque = 0.0
        # The rate counts from what the actuator was given.
        self._open_loop = max(measurement.open_loop_torque, 0.0)
        return self._open_loop

    def before(self, measurement: Measurement) -> tuple[float, float]:
        """
        Return the request in N m without a move of the controller, and its jump in N m.

        The request jumps as the open loop does from one period to the next.
        """
        now, before = measurement.open_loop_torque, self._open_loop
        return now + self._own_torque, now - (max(now, 0.0) if before is None else before)

    def bounds(self, last: float, divisor: float = 1.0) -> Bounds:
        """
        Return the bounds of the program's rows, before their shift.

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

    def keep(self, request: float, measurement: Measurement) -> float:
        """Return the controller's own part of the request in N m, and go on from it."""
        self._own_torque = request - measurement.open_loop_torque
        self._open_loop = measurement.open_loop_torque
        return self._own_torque


class KnownEngine:
    """An engine that follows the driver: C_m is known, and nothing is asked of it."""

    def reset(self) -> None:
        """Do nothing."""

    def hold(self, measurement: Measurement) -> float:
        """Return C_m in N m over the period."""
        return measurement.engine_torque

    def known(self, level: float, ahead: Measurement, gain: float) -> tuple[float, ...]:
        """Return the request before the first move, C_m and C_load in N m."""
        return level, ahead.engine_torque, ahead.load_torque

    def bounds(self, bounds: Bounds, measurement: Measurement, gain: float) -> Bounds:
        """Return the bounds as they are."""
        return bounds

    def ask(
        self, move: list[float], measurement: Measurement, gain: float, *, solved: bool
    ) -> tuple[float | None, float, Status]:
        """Return no request, C_m in N m, and nothing to say."""
        return None, measurement.engine_torque, ()


class CommandedEngine:
    """
    An engine whose deviation from the driver's demand is decided.

    The deviation's target is zero, its limits and its rate are the engine's, and the engine's lag
    is part of the prediction. The demand is taken as constant over the horizon. What the program
    has of these torques is divided by `gain`, which the wear gain is estimated to be.
    """

    def __init__(self, authority: EngineAuthority, rows: np.ndarray, control_steps: int) -> None:
        """Take the rows (control_steps,) of the program that limit it."""
        self._authority = authority
        self._rows = rows
        self._periods = range(1, control_steps + 1)
        self.reset()

    @staticmethod
    def limited_by_rows(settings: MpcSettings) -> MpcSettings:
        """Return the settings with a limit that no engine has: its rows' bounds come by period."""
        limit = 2.0 * MOST_AUTHORITY
        clutch, engine = settings.inputs
        engine = replace(engine, lowest=-limit, highest=limit, rate_n_m_s=math.inf)
        return replace(settings, inputs=(clutch, engine))

    def reset(self) -> None:
        """Put the engine on the demand."""
        self._response = EngineResponse(self._authority)
        self.reachable = np.zeros((2, len(self._periods)))
        """Lowest and highest deviation that may be asked in the coming periods, as divided."""

    def hold(self, measurement: Measurement) -> float:
        """Return C_m in N m over the period, with the demand asked for."""
        return self._response.deliver(measurement.engine_torque, measurement.engine_torque)

    def known(self, level: float, ahead: Measurement, gain: float) -> tuple[float, ...]:
        """Return the demand and the deviation, both inputs before the first move, and C_load."""
        deviation, asked = self._response.deviation / gain, self._response.requested / gain
        return ahead.engine_torque, deviation, level, asked, ahead.load_torque

    def bounds(self, bounds: Bounds, measurement: Measurement, gain: float) -> Bounds:
        """Return the bounds with what the engine can reach by each period."""
        demand = measurement.engine_torque
        reachable = [self._response.reachable(demand, period) for period in self._periods]
        self.reachable = np.transpose(reachable) / gain
        lower, upper = (bound.copy() for bound in bounds)
        lower[self._rows], upper[self._rows] = self.reachable
        return lower, upper

    def ask(
        self, move: list[float], measurement: Measurement, gain: float, *, solved: bool
    ) -> tuple[float | None, float, Status]:
        """
        Return the request for C_m, the C_m that comes, in N m, and how far this is off the demand.

        A move that is not of a solution is cut off at what the engine can reach.
        """
        demand, before, change = measurement.engine_torque, self._response.requested, move[0]
        if not solved:
            lowest, highest = self.reachable[:, 0].tolist()
            change = min(max(before / gain + change, lowest), highest) - before / gain
        request = demand + (before + change * gain)
        delivered = self._response.deliver(demand, request)
        return request, delivered, (('engine_torque_deviation_n_m', repr(delivered - demand)),)
