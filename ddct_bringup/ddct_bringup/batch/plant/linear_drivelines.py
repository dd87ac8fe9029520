# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Drivelines of many runs with the linear clutch."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ddct_bringup.batch.stacks import by_run, distinct, product, stacked
from ddct_plant.models.driveline import DrivelineOutputs
from ddct_plant.models.driveline_model import ANGLES, STATES
from ddct_plant.models.initial_state import InitialState
from ddct_plant.models.linear_driveline import step_matrix
from ddct_plant.scenario.scenario import Scenario


class LinearDrivelines:
    """Drivelines of R runs, the counterpart of `Driveline`; without angles where none is read."""

    def __init__(
        self, scenarios: Sequence[Scenario], initial: Sequence[InitialState], *, angles: bool
    ) -> None:
        """Start in the initial states; raise ParameterError as `step_matrix` does."""
        parameters = [scenario.driveline for scenario in scenarios]
        self._parameters = stacked(parameters)
        self._wheel_radius: Any = np.array([each.vehicle.wheel_radius_m for each in scenarios])
        first, places = distinct(parameters)
        steps = step_matrix(stacked([parameters[index] for index in first]), angles=angles)
        self._steps = by_run(list(steps), places)
        self._values = np.zeros((len(scenarios), self._steps.shape[-1]))
        start: Any = stacked(initial)
        self._values[:, : len(STATES)] = np.stack(start.states, axis=-1)
        self._states = self._steps.shape[-2]
        self._without = [] if angles else [math.nan] * len(ANGLES)
        self._torques: Any = (start.engine_torque, start.sides[0].torque, start.load_torque)

    def outputs(self) -> Any:
        """Return `DrivelineOutputs` at the present step, each value (R,); NaN without angles."""
        states: Any = [*self._values[:, : self._states].T, *self._without]
        return DrivelineOutputs.of_state(
            self._parameters, self._wheel_radius, states, self._torques
        )

    def step(
        self,
        running: np.ndarray,
        engine_torque: np.ndarray,
        load_torque: np.ndarray,
        clutch_torque: np.ndarray,
    ) -> None:
        """
        Advance by 10 ms with held C_m and C_load, (R,), and the (R, 11) nodes of C_f in N m.

        Runs that do not run any more go on too, since no number of theirs counts.
        """
        values, states = self._values, self._states
        values[:, states], values[:, states + 1] = engine_torque, load_torque
        values[:, states + 2 :] = clutch_torque
        values[:, :states] = product(self._steps, values)
        self._torques = (engine_torque, clutch_torque[:, -1], load_torque)

    @property
    def failed(self) -> np.ndarray:
        """Runs that could not be integrated, (R,): none."""
        return np.zeros(len(self._values), dtype=bool)

    @property
    def phase_events(self) -> dict[str, Any]:
        """Events in the last period, by the name of their signal: none."""
        return {}
