# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Engines of many runs: the driver's demand, requests within their authority, and limits."""

from collections.abc import Sequence

import numpy as np

from ddct_bringup.batch.stacks import Curves, distinct, rows_of
from ddct_plant.base.timebase import PERIOD_S, STEPS_PER_S
from ddct_plant.models.engine import EngineAuthority
from ddct_plant.models.engine_limits import EngineLimits
from ddct_plant.scenario.scenario import Scenario

_NUMBERS = (
    *('idle_rad_s', 'idle_gain_n_m_s', 'idle_integral_n_m', 'idle_most_n_m'),
    *('stall_rad_s', 'cut_rad_s', 'resume_rad_s', 'over_rev_rad_s'),
)
"""Names of the limits that are numbers."""


class LimitedEngines:
    """Engines of R runs within their limits, the counterpart of `LimitedEngine`."""

    def __init__(self, limits: Sequence[EngineLimits]) -> None:
        """Start with the fuel on and no integral of idle control."""
        speeds = [each.speed_rad_s for each in limits]
        friction, full_load = (
            [getattr(each, name) for each in limits] for name in ('friction_n_m', 'full_load_n_m')
        )
        self._friction = Curves(list(zip(speeds, friction, strict=True)))
        self._full_load = Curves(list(zip(speeds, full_load, strict=True)))
        values = {name: np.array([getattr(each, name) for each in limits]) for name in _NUMBERS}
        self._idle, self._gain, self._integral_gain, self._most_idle = (
            values[name] for name in _NUMBERS[:4]
        )
        self._stall, self._cut_speed, self._resume, self._over_rev = (
            values[name] for name in _NUMBERS[4:]
        )
        self._integral = np.zeros(len(limits))
        self._cut, self._stalled, self._ended = np.zeros((3, len(limits)), dtype=bool)

    def over(self, speed: np.ndarray) -> np.ndarray:
        """Return for w_m in rad/s, (R,), whether the engine stalls or over-revs."""
        over: np.ndarray = (speed <= self._stall) | (speed >= self._over_rev)
        return over

    def deliver(self, request: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """Return C_m in N m over the coming period, for requests in N m at w_m in rad/s, (R,)."""
        self._stalled |= ~self._ended & (speed <= self._stall)
        self._ended |= self.over(speed)
        friction = self._friction.at(speed)
        cut = speed >= np.where(self._cut, self._resume, self._cut_speed)
        self._cut = np.where(self._stalled, self._cut, cut)
        idle = self._idle_torque(speed, ~(cut | self._stalled))
        raised = np.maximum(np.maximum(request, idle), -friction)
        torque = np.minimum(raised, self._full_load.at(speed))
        return np.where(self._stalled, 0.0, np.where(cut, -friction, torque))

    def _idle_torque(self, speed: np.ndarray, fuelled: np.ndarray) -> np.ndarray:
        """Return the torques of idle control in N m; integrate where there is fuel."""
        missing = self._idle - speed
        torque = np.minimum(self._gain * missing + self._integral, self._most_idle)
        integral = self._integral + self._integral_gain * missing * PERIOD_S
        integral = np.minimum(np.maximum(integral, 0.0), self._most_idle)
        self._integral = np.where(fuelled, integral, self._integral)
        return torque


class EngineResponses:
    """Responses of R engines, the counterpart of `EngineResponse`."""

    def __init__(self, authorities: Sequence[EngineAuthority]) -> None:
        """Start at the demands."""
        self._most = np.array([each.deviation_n_m for each in authorities])
        self._most_change = np.array([each.slew_n_m_s * PERIOD_S for each in authorities])
        self._lag_share = np.array([each.lag_share for each in authorities])
        self._least_torque = np.array([each.minimum_torque_n_m for each in authorities])
        self._most_torque = np.array([each.maximum_torque_n_m for each in authorities])
        self._requested = self._deviation = np.zeros(len(authorities))

    def deliver(self, demand: np.ndarray, request: np.ndarray) -> np.ndarray:
        """Return C_m over the coming period for demands and requests, all in N m, (R,)."""
        requested = _limited(request - demand, self._most)
        change = _limited(requested - self._requested, self._most_change)
        self._requested = self._requested + change
        missing = self._requested - self._deviation
        self._deviation = self._deviation + self._lag_share * missing
        torque = demand + self._deviation
        return np.minimum(np.maximum(torque, self._least_torque), self._most_torque)


def _limited(values: np.ndarray, limits: np.ndarray) -> np.ndarray:
    return np.minimum(np.maximum(values, -limits), limits)


class Engines:
    """Engines of R runs, with limits or without, the counterpart of `Engine`."""

    def __init__(self, scenarios: Sequence[Scenario], steps: int) -> None:
        """Extend the demands to step `steps`."""
        times = np.arange(steps + 1) / STEPS_PER_S
        demands = [scenario.demand for scenario in scenarios]
        first, places = distinct(demands)
        profiles = [demands[index].over(times) for index in first]
        self._demands = np.stack([profiles[place] for place in places], axis=-1)
        self._responses = EngineResponses([each.engine_authority for each in scenarios])
        limits = [each.engine_limits for each in scenarios if each.engine_limits is not None]
        self._limited = LimitedEngines(limits) if limits else None
        self._with_limits = rows_of(
            [place for place, each in enumerate(scenarios) if each.engine_limits is not None]
        )

    def demand(self, step: int) -> np.ndarray:
        """Return the driver's demands of C_m in N m, (R,), at step `step`."""
        demand: np.ndarray = self._demands[step]
        return demand

    def torque(
        self, demand: np.ndarray, request: np.ndarray | None, speed: np.ndarray
    ) -> np.ndarray:
        """Return C_m over a period for demands and requests in N m at w_m in rad/s, (R,) each."""
        requested = demand if request is None else self._responses.deliver(demand, request)
        if self._limited is None:
            return requested
        rows = self._with_limits
        torque = requested.copy()
        torque[rows] = self._limited.deliver(requested[rows], speed[rows])
        return torque

    def over(self, speed: np.ndarray) -> np.ndarray:
        """Return for w_m in rad/s, (R,), whether the engine ends the run."""
        over = np.zeros(len(speed), dtype=bool)
        if self._limited is not None:
            over[self._with_limits] = self._limited.over(speed[self._with_limits])
        return over
