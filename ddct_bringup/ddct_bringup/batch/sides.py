# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The sides of the plants of many runs: an actuator and its clutch."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ddct_bringup.batch.actuators import Actuators
from ddct_plant.scenario.settings import RunSettings


class LinearSides:
    """Actuators and linear clutches of R runs, the counterpart of `LinearSide`."""

    def __init__(self, runs: Sequence[RunSettings], actuators: Actuators) -> None:
        self._actuators = actuators
        self._wear = np.array([run.case.wear_gain for run in runs])[:, np.newaxis]

    def reply(
        self, step: int, request: np.ndarray, outputs: Any
    ) -> tuple[tuple[np.ndarray, ...], dict[str, np.ndarray]]:
        """Return the transmitted torques (R, 11) in N m over the period of t_k, and signals."""
        torque = self._wear * self._actuators.update(step, request)
        return (torque,), {'torque_request': request}
