# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The torques of the actuators of many runs by periods, and their torques to come."""

from collections.abc import Sequence

import numpy as np

from ddct_bringup.batch.stacks import by_run, distinct, product
from ddct_controllers.least_jerk.actuator_model import ActuatorTorque


class ActuatorTorques:
    """The counterpart of `ActuatorTorque`; all actuators have as many requests that wait."""

    def __init__(self, actuators: Sequence[ActuatorTorque], request: np.ndarray) -> None:
        """Start at rest on requests in N m."""
        first, places = distinct(map(id, actuators))
        models = [actuators[index] for index in first]
        self.ahead, self._inputs, self._delayed = sizes(models[0])
        self._step = by_run([np.hstack([each.step, each.held]) for each in models], places)
        self._mean = by_run([np.array([each.mean]) for each in models], places)
        self._total = by_run([np.array([each.total]) for each in models], places)
        at_rest = np.array([each.at_rest for each in models])[places]
        self._states = at_rest * request[:, np.newaxis]
        self._waiting = np.repeat(request[:, np.newaxis], max(self._delayed, 1), axis=1)

    @property
    def request(self) -> np.ndarray:
        """Latest requests in N m."""
        return self._waiting[:, -1]

    def mean_torque(self, request: np.ndarray) -> np.ndarray:
        """Return the mean torques of the coming period in N m, with its requests in N m."""
        return product(self._mean, np.hstack([self._states, self._acting(request)]))[:, 0]

    def torque_ahead(self) -> np.ndarray:
        """Return the sums of the mean torques of the coming `ahead` periods in N m."""
        return product(self._total, np.hstack([self._states, self._waiting]))[:, 0]

    def advance(self, request: np.ndarray) -> None:
        """Pass a period with requests in N m."""
        values = np.hstack([self._states, self._acting(request)])
        self._states = product(self._step, values)
        self._waiting = np.column_stack([self._waiting[:, 1:], request])

    def _acting(self, request: np.ndarray) -> np.ndarray:
        """Return the requests in effect within the coming period, (R, 1 or 2)."""
        if not self._delayed:
            return request[:, np.newaxis]
        return np.column_stack([self._waiting, request])[:, : self._inputs]


def sizes(model: ActuatorTorque) -> tuple[int, int, int]:
    """Return what actuators that are computed together share."""
    return model.ahead, model.inputs, model.delayed
