# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The sides of the plants of many runs: an actuator and its clutch."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ddct_bringup.batch.actuators import Actuators
from ddct_bringup.batch.clutches import FrictionClutches
from ddct_plant.scenario.plant import OPEN_BELOW
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.shift.roles import OFF_GOING, ON_COMING

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
