# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Actuators of many runs, each with its own delay and bandwidth."""

from collections.abc import Sequence

import numpy as np

from ddct_bringup.batch.stacks import by_run, distinct, product
from ddct_plant.base.timebase import SUBSTEPS
from ddct_plant.models.actuator import ActuatorParameters, at_rest, lifted

_EARLIER, _LATER = 4, 5
"""Places in the input of an actuator, after the states of G_a: both requests of a period."""
_STATES = slice(0, _EARLIER)


class Actuators:
    """
    Actuators of R runs, the counterpart of `Actuator`.

    Where a delay is a whole number of periods the earlier request has no effect.
    """

    def __init__(
        self, parameters: Sequence[ActuatorParameters], requests: np.ndarray, steps: int
    ) -> None:
        """Start in steady state at requests, (R,) in N m, for `steps` periods."""
        first, places = distinct(parameters)
        made = [_matrices(parameters[index]) for index in first]
        self._rows = by_run([rows for rows, _ in made], places)
        delayed = np.maximum(requests, 0.0)
        self._values = np.zeros((len(parameters), _LATER + 1))
        rest = np.stack([each for _, each in made])
        self._values[:, _STATES] = rest[places] * delayed[:, np.newaxis]
        periods = np.array([each.delay_substeps // SUBSTEPS for each in parameters])
        self._before = int(periods.max()) + 1
        self._requests = np.empty((self._before + steps, len(parameters)))
        self._requests[: self._before] = delayed
        self._later = self._before - periods
        self._columns = np.arange(len(parameters))

    def update(self, step: int, requests: np.ndarray) -> np.ndarray:
        """Return the torques in N m at 0, 1, ..., 10 ms, (R, 11), and accept requests, (R,)."""
        np.maximum(requests, 0.0, out=self._requests[self._before + step])
        later = self._later + step
        self._values[:, _EARLIER] = self._requests[later - 1, self._columns]
        self._values[:, _LATER] = self._requests[later, self._columns]
        followed = product(self._rows, self._values)
        self._values[:, _STATES] = followed[:, _STATES]
        return followed[:, _EARLIER:]

    def mean_torque(self, step: int, requests: np.ndarray) -> np.ndarray:
        """Return the mean torques of a period in N m, (R,), and accept requests, as `update`."""
        total: np.ndarray = sum(self.update(step, requests)[:, :-1].T)
        return total / SUBSTEPS


def _matrices(parameters: ActuatorParameters) -> tuple[np.ndarray, np.ndarray]:
    """Return the (4 + 11, 6) map to next state and nodes, and the steady state for 1 N m."""
    model, late = parameters.dynamics(), parameters.delay_substeps % SUBSTEPS
    rows = np.concatenate(lifted(model, late))
    if not late:
        rows = np.insert(rows, _EARLIER, 0.0, axis=1)
    return rows, at_rest(model, 1.0)
