# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Inputs of a predictive controller: the clutch torque request, and C_m if it is commanded."""

import math
from dataclasses import replace
from typing import Any

import numpy as np

from ddct_controllers.interface import Measurement, Status
from ddct_controllers.mpc.program.horizon import CondensedProgram
from ddct_controllers.mpc.program.settings import InputTerms, MpcSettings
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.engine import MOST_AUTHORITY, EngineAuthority, EngineResponse

CLUTCH, ENGINE = range(2)
"""Indices of the inputs."""
ROOM = 1e-9
"""Additional width of levels that give way, relative: without it rounding may leave no request."""

Bounds = tuple[np.ndarray, np.ndarray]
"""Lower and upper bounds of the program's rows, before their shift."""


class ClutchInput:
    """
    The clutch torque request, open loop included, and its limits of level and rate.

    Where the last request is so far beyond a limit of the level that the rate cannot keep it, the
    limit gives way to the nearest level that the rate reaches. So there always is a request within
    the limits.
    """

    def __init__(self, program: CondensedProgram, terms: InputTerms) -> None:
        self._program = program
        self._rows, self._soft_rows = program.level_rows[CLUTCH], program.structure.soft_rows
        self._lowest, self._highest = terms.lowest, terms.highest
        self._most_change = terms.rate_n_m_s * PERIOD_S
        self._reach = self._most_change * np.arange(1, len(self._rows) + 1)
        self.reset()

    def reset(self) -> None:
        """Start with the open loop alone."""
        self._own_torque = 0.0
        self._open_loop: float | None = None

    def hold(self, measurement: Measurement) -> float:
        """Return the request in N m of the open loop alone, cut off at 0 as in the actuator."""
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
        level_kept = reaches_level(last, self._lowest, self._highest, self._most_change)
        soft = divisor != 1.0 and len(self._soft_rows)
        if level_kept and not soft:
            return lower, upper
        lower, upper = lower.copy(), upper.copy()
        if not level_kept:
            reach = self._reach - room
            lower[self._rows] = np.minimum(lower[self._rows], last + reach)
            upper[self._rows] = np.maximum(upper[self._rows], last - reach)
        if soft:
            lower[self._soft_rows] /= divisor
            upper[self._soft_rows] /= divisor
        return lower, upper

    def nearest(self, level: float, last: float) -> float:
        """Return the allowed request nearest to `level`, N m; `last` is the request before."""
        level = min(max(level, self._lowest), self._highest)
        return min(max(level, last - self._most_change), last + self._most_change)

    def keep(self, request: float, measurement: Measurement) -> float:
        """Return the controller's own part of the request in N m, and store the request."""
        self._own_torque = request - measurement.open_loop_torque
        self._open_loop = measurement.open_loop_torque
        return self._own_torque


def reaches_level(last: Any, lowest: Any, highest: Any, most_change: Any) -> Any:
    """Return whether a request between its limits is in reach of `last`, all in N m or (R,)."""
    change = most_change - ROOM * (1.0 + abs(last))
    return (lowest <= last + change) & (last - change <= highest)


class KnownEngine:
    """An engine that follows the driver: C_m is a known input and is not commanded."""

    def reset(self) -> None:
        """Do nothing: there is no state."""

    def hold(self, measurement: Measurement) -> float:
        """Return C_m in N m over the period."""
        return measurement.engine_torque

    def known(self, level: float, ahead: Measurement, gain: float) -> tuple[float, ...]:
        """Return the request before the first move, C_m and C_load in N m."""
        return level, ahead.engine_torque, ahead.load_torque

    def bounds(self, bounds: Bounds, measurement: Measurement, gain: float) -> Bounds:
        """Return the bounds unchanged."""
        return bounds

    def command(
        self, move: list[float], measurement: Measurement, gain: float, *, solved: bool
    ) -> tuple[float | None, float, Status]:
        """Return None for the request, C_m in N m, and no status."""
        return None, measurement.engine_torque, ()


class CommandedEngine:
    """
    An engine whose deviation from the driver's demand the program decides.

    The deviation's target is zero, its limits and its rate are the engine's, and the engine's lag
    is part of the prediction. The demand is taken as constant over the horizon. In the program
    these torques are divided by `gain`, the estimated wear gain.
    """

    def __init__(self, authority: EngineAuthority, rows: np.ndarray, control_steps: int) -> None:
        """Take the rows of the program that limit the engine, (control_steps,)."""
        self._authority = authority
        self._rows = rows
        self._periods = range(1, control_steps + 1)
        self.reset()

    @staticmethod
    def limited_by_rows(settings: MpcSettings) -> MpcSettings:
        """Return settings with limits beyond any engine's; `bounds` narrows them each period."""
        limit = 2.0 * MOST_AUTHORITY
        clutch, engine = settings.inputs
        engine = replace(engine, lowest=-limit, highest=limit, rate_n_m_s=math.inf)
        return replace(settings, inputs=(clutch, engine))

    def reset(self) -> None:
        """Put the engine on the demand."""
        self._response = EngineResponse(self._authority)
        self.reachable = np.zeros((2, len(self._periods)))
        """
        Lowest and highest deviation that the engine can reach by period, (2, m), N m over `gain`.
        """

    def hold(self, measurement: Measurement) -> float:
        """Return C_m in N m over the period, with the driver's demand as the request."""
        return self._response.deliver(measurement.engine_torque, measurement.engine_torque)

    def known(self, level: float, ahead: Measurement, gain: float) -> tuple[float, ...]:
        """Return the demand and the deviation, both inputs before the first move, and C_load."""
        deviation, request = self._response.deviation / gain, self._response.requested / gain
        return ahead.engine_torque, deviation, level, request, ahead.load_torque

    def bounds(self, bounds: Bounds, measurement: Measurement, gain: float) -> Bounds:
        """Return the bounds, narrowed to the deviations reachable by each period."""
        demand = measurement.engine_torque
        reachable = [self._response.reachable(demand, period) for period in self._periods]
        self.reachable = np.transpose(reachable) / gain
        lower, upper = (bound.copy() for bound in bounds)
        lower[self._rows], upper[self._rows] = self.reachable
        return lower, upper

    def command(
        self, move: list[float], measurement: Measurement, gain: float, *, solved: bool
    ) -> tuple[float | None, float, Status]:
        """
        Return the request for C_m and the C_m that follows in N m, and the deviation as status.

        A move that is not of a solution is limited to what the engine can reach.
        """
        demand, before, change = measurement.engine_torque, self._response.requested, move[0]
        if not solved:
            lowest, highest = self.reachable[:, 0].tolist()
            change = min(max(before / gain + change, lowest), highest) - before / gain
        request = demand + (before + change * gain)
        delivered = self._response.deliver(demand, request)
        return request, delivered, (('engine_torque_deviation_n_m', repr(delivered - demand)),)
