# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The sides of the plants of many runs: an actuator and a clutch, linear or with dry plates."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ddct_bringup.batch.plant.actuators import Actuators
from ddct_bringup.batch.stacks import Curves
from ddct_plant.models.clutch import AMBIENT_C, Capacity, FrictionParameters
from ddct_plant.models.clutch_heat import ClutchHeat, HeatParameters
from ddct_plant.scenario.plant import OPEN_BELOW
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.shift.roles import OFF_GOING, ON_COMING


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


Reply = tuple[tuple[np.ndarray, ...], dict[str, np.ndarray]]
"""Torques in N m of a period, (R, 11) each, and signals (R,) by name."""


class LinearSides:
    """Actuators and linear clutches of R runs, the counterpart of `LinearSide`."""

    def __init__(self, runs: Sequence[RunSettings], actuators: Actuators) -> None:
        self._actuators = actuators
        self._wear_gains = np.array([run.case.wear_gain for run in runs])[:, np.newaxis]

    def reply(self, step: int, request: np.ndarray, outputs: Any) -> Reply:
        """Return the transmitted torques over the period of t_k, and signals."""
        torque = self._wear_gains * self._actuators.update(step, request)
        return (torque,), {'torque_request': request}


class StickSlipSides:
    """Actuators and sticking clutches of R runs, the counterpart of `StickSlipSide`."""

    def __init__(
        self, runs: Sequence[RunSettings], actuators: Actuators, role: str = ON_COMING
    ) -> None:
        self._actuators = actuators
        self._prefix = f'{OFF_GOING}_' if role == OFF_GOING else ''
        scenarios = [run.scenario for run in runs]
        self._clutches = FrictionClutches(
            [scenario.friction for scenario in scenarios],
            [scenario.heat for scenario in scenarios],
            np.array([_wear_gain(run, role) for run in runs]),
            OPEN_BELOW if runs[0].shift else 0.0,
        )

    def reply(self, step: int, request: np.ndarray, outputs: Any) -> Reply:
        """Return kinetic and static capacities over the period of t_k, and signals."""
        torque = self._actuators.update(step, request)
        capacity = self._clutches.reply(step, torque, outputs.slip_speed, outputs.friction_work)
        values = {'torque_request': request, 'clutch_temperature': capacity.temperature_c}
        return capacity[:2], {f'{self._prefix}{name}': each for name, each in values.items()}


def _wear_gain(run: RunSettings, role: str) -> float:
    return run.case.off_going_wear_gain if role == OFF_GOING else run.case.wear_gain
