# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Engines with limits of many runs."""

from collections.abc import Sequence

import numpy as np

from ddct_bringup.batch.curves import Curves
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.engine_limits import EngineLimits

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
