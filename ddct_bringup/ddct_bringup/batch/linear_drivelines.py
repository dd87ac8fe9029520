# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Drivelines of many runs with the linear clutch."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ddct_bringup.batch.stacks import by_run, distinct, product, stacked
from ddct_plant.models.driveline import DrivelineOutputs
from ddct_plant.models.driveline_model import STATES
from ddct_plant.models.initial_state import InitialState
from ddct_plant.models.linear_driveline import step_matrix
from ddct_plant.scenario.scenario import Scenario

_STATES = slice(0, len(STATES))
_ENGINE_TORQUE, _LOAD_TORQUE = len(STATES), len(STATES) + 1
_NODES = slice(_LOAD_TORQUE + 1, None)
_NO_ANGLES = (math.nan,) * 3


class LinearDrivelines:
    """Drivelines of R runs without angles, the counterpart of `Driveline`."""

    def __init__(self, scenarios: Sequence[Scenario], initial: Sequence[InitialState]) -> None:
        """Start in the initial states; raise ParameterError as `step_matrix` does."""
        parameters = [scenario.driveline for scenario in scenarios]
        self._parameters = stacked(parameters)
        self._wheel_radius: Any = np.array([each.vehicle.wheel_radius_m for each in scenarios])
        first, places = distinct(parameters)
        steps = step_matrix(stacked([parameters[index] for index in first]), angles=False)
        self._steps = by_run(list(steps), places)
        self._values = np.zeros((len(scenarios), self._steps.shape[-1]))
        start: Any = stacked(initial)
        self._values[:, _STATES] = np.stack(start.states, axis=-1)
        self._torques: Any = (start.engine_torque, start.sides[0].torque, start.load_torque)

    def outputs(self) -> Any:
        """Return `DrivelineOutputs` at the present step, each value (R,); the angles are NaN."""
        states: Any = [*self._values[:, _STATES].T, *_NO_ANGLES]
        return DrivelineOutputs.of_state(
            self._parameters, self._wheel_radius, states, self._torques
        )

    def step(
        self, engine_torque: np.ndarray, load_torque: np.ndarray, clutch_torque: np.ndarray
    ) -> None:
        """Advance by 10 ms with held C_m and C_load, (R,), and the (R, 11) nodes of C_f in N m."""
        values = self._values
        values[:, _ENGINE_TORQUE], values[:, _LOAD_TORQUE] = engine_torque, load_torque
        values[:, _NODES] = clutch_torque
        values[:, _STATES] = product(self._steps, values)
        self._torques = (engine_torque, clutch_torque[:, -1], load_torque)
