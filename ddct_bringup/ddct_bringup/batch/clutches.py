# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Stick-slip clutches of many runs: capacities, temperatures and friction curves."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ddct_bringup.batch.curves import Curves
from ddct_plant.models.clutch import AMBIENT_C, Capacity, FrictionParameters
from ddct_plant.models.clutch_heat import ClutchHeat, HeatParameters


class FrictionClutches:
    """Stick-slip clutches of R runs, the counterpart of `FrictionClutch`."""

    def __init__(
        self,
        parameters: Sequence[FrictionParameters],
        heat: Sequence[HeatParameters],
        wear_gains: np.ndarray,
        open_below: float = 0.0,
    ) -> None:
        """Start at the temperatures of `heat`; wear gains are (R,), `open_below` is in N m."""
        self._heat, self._open_below = ClutchHeat.of_many(heat), open_below
        self._wear_gains = wear_gains
        self._kiss = np.array([each.kiss_torque_n_m for each in parameters])
        self._drift = np.array([each.kiss_drift_n_m_k for each in parameters])
        self._most = np.array([each.most_n_m for each in parameters])[:, np.newaxis]
        ratios = np.array([each.static_over_kinetic for each in parameters])[:, np.newaxis]
        self._ratios = None if (ratios == 1.0).all() else ratios
        of_temperature = [(each.temperature_c, each.temperature_share) for each in parameters]
        of_slip = [(each.slip_rad_s, each.slip_share) for each in parameters]
        self._of_temperature, self._of_slip = Curves(of_temperature), Curves(of_slip)

    def reply(
        self, step: int, actuator_torque: np.ndarray, slip_speed: np.ndarray, work: Any
    ) -> Any:
        """
        Return the `Capacity` of the period of t_k, (R, 11), with the temperatures, (R,).

        The actuator torques (R, 11) are in N m, slips (R,) in rad/s; `work` in J is the friction
        work of the last period.
        """
        if step:
            self._heat.advance(work)
        temperature: Any = self._heat.facing_c
        gains = self._wear_gains
        if not self._of_temperature.constant:
            gains = gains * self._of_temperature.at(temperature)
        if not self._of_slip.constant:
            gains = gains * self._of_slip.at(np.abs(slip_speed))
        kiss = (self._kiss - self._drift * (temperature - AMBIENT_C))[:, np.newaxis]
        pressing = actuator_torque > np.maximum(kiss, self._open_below)
        carried = gains[:, np.newaxis] * (actuator_torque - kiss)
        kinetic = np.minimum(np.where(pressing, carried, 0.0), self._most)
        static = kinetic if self._ratios is None else self._ratios * kinetic
        return Capacity(kinetic, static, temperature)
