# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Engines with limits of many runs."""

from collections.abc import Sequence

import numpy as np

from ddct_bringup.batch.stacks import distinct
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.engine_limits import EngineLimits

_NUMBERS = ('idle_rad_s', 'idle_gain_n_m_s', 'idle_integral_n_m', 'idle_most_n_m')


class LimitedEngines:
    """
    Engines of R runs, the counterpart of `LimitedEngine`.

    A run ends with the state in which its engine stalls, so what it gives then does not matter.
    """

    def __init__(self, limits: Sequence[EngineLimits]) -> None:
        """Start with the fuel on and no integral of idle control."""
        first, self._places = distinct(limits)
        self._curves = [limits[index] for index in first]
        numbers = np.array([[getattr(each, name) for each in limits] for name in _NUMBERS])
        self._idle_speed, self._gain, self._integral_gain, self._most = numbers
        self._cut_speed = np.array([each.cut_rad_s for each in limits])
        self._resume_speed = np.array([each.resume_rad_s for each in limits])
        self._integral = np.zeros(len(limits))
        self._cut = np.zeros(len(limits), dtype=bool)

    def deliver(self, request: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """Return C_m in N m over the coming period for requests in N m at w_m, (R,) each."""
        friction, full_load = self._at(speed)
        self._cut = speed >= np.where(self._cut, self._resume_speed, self._cut_speed)
        most = np.maximum(np.maximum(request, self._idle(speed)), -friction)
        return np.where(self._cut, -friction, np.minimum(most, full_load))

    def _at(self, speed: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the friction and the full-load torque in N m at w_m, (R,) each."""
        found = np.empty((2, len(speed)))
        for place, limits in enumerate(self._curves):
            rows = slice(None) if len(self._curves) == 1 else self._places == place
            for values, curve in zip(
                found, (limits.friction_n_m, limits.full_load_n_m), strict=True
            ):
                values[rows] = np.interp(speed[rows], limits.speed_rad_s, curve)
        return found[0], found[1]

    def _idle(self, speed: np.ndarray) -> np.ndarray:
        """Return the torques of idle control in N m, and integrate the speed errors."""
        missing = self._idle_speed - speed
        torque = np.minimum(self._gain * missing + self._integral, self._most)
        integral = self._integral + self._integral_gain * missing * PERIOD_S
        integral = np.minimum(np.maximum(integral, 0.0), self._most)
        self._integral = np.where(self._cut, self._integral, integral)
        return torque
