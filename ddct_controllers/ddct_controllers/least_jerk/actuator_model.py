# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The torque of an actuator by periods, in plain floats, and its torque to come."""

from collections.abc import Sequence

import numpy as np

from ddct_plant.base.timebase import PERIOD_S, SUBSTEPS
from ddct_plant.linear.delayed_input import acting_inputs
from ddct_plant.linear.lti import StateSpace
from ddct_plant.linear.sampling import discretise_zoh
from ddct_plant.models.actuator import ActuatorParameters, at_rest


class ActuatorTorque:
    """
    G_a(s) behind its delay: mean torque of a period, and of the coming `ahead` ones.

    The states of G_a are extended by the integral of the torque, so the means are exact.
    """

    def __init__(self, actuator: ActuatorParameters) -> None:
        """Start at rest on a request of zero."""
        model = actuator.dynamics()
        size = len(model.a)
        periods, late = divmod(actuator.delay_substeps, SUBSTEPS)
        self.inputs = 2 if late else 1
        """Number of requests in effect within a period."""
        self.ahead = max(round(actuator.lag_s / PERIOD_S), 1)
        """Number of coming periods whose torque the requests so far decide: the lag."""
        a, b = np.zeros((size + 1, size + 1)), np.zeros((size + 1, 1))
        a[:size, :size], a[size, :size], b[:size] = model.a, model.c[0], model.b
        extended = StateSpace(a, b, np.eye(size + 1), np.zeros((size + 1, 1)))
        sampled, acting = discretise_zoh(extended, PERIOD_S), acting_inputs(extended, late)
        step, held = sampled.a[:size, :size], acting[:size]
        mean, mean_held = sampled.a[size, :size] / PERIOD_S, acting[size] / PERIOD_S
        waiting = max(periods + self.inputs - 1, 1)
        total, total_held = np.zeros(size), np.zeros(waiting)
        power, response = np.eye(size), np.zeros((size, waiting))
        for period in range(self.ahead):
            # The requests in effect: of those that wait, the last one is held.
            places = np.minimum(period + np.arange(self.inputs), waiting - 1)
            chosen = np.eye(waiting)[places]
            total = total + mean @ power
            total_held = total_held + mean @ response + mean_held @ chosen
            power, response = step @ power, step @ response + held @ chosen
        self.step: list[list[float]] = step.tolist()
        """Map of the states over a period, (4, 4)."""
        self.held: list[list[float]] = held.tolist()
        """Effect of the requests in effect on the states after a period, (4, 1 or 2)."""
        self.mean: list[float] = [*mean.tolist(), *mean_held.tolist()]
        """Map of the states and the requests in effect to the mean torque of the period."""
        self.total: list[float] = [*total.tolist(), *total_held.tolist()]
        """The same, of all requests that wait, to the sum of the means of `ahead` periods."""
        self.at_rest: list[float] = at_rest(model, 1.0).tolist()
        """States at rest on a request of 1 N m, (4,)."""
        self.delayed = periods + self.inputs - 1
        """Number of requests that wait, 0 without a delay."""
        self.reset(0.0)

    def reset(self, request: float) -> None:
        """Put the actuator at rest on a request in N m."""
        self._waiting = [request] * max(self.delayed, 1)
        """Requests in N m that have not acted in full, the latest last; at least that one."""
        self._states = [state * request for state in self.at_rest]

    @property
    def request(self) -> float:
        """Latest request in N m."""
        return self._waiting[-1]

    def mean_torque(self, request: float) -> float:
        """Return the mean torque of the coming period in N m, with its request in N m."""
        return _weighted(self.mean, self._states, self._acting(request))

    def torque_ahead(self) -> float:
        """Return the sum of the mean torques of the coming `ahead` periods in N m."""
        return _weighted(self.total, self._states, self._waiting)

    def advance(self, request: float) -> None:
        """Pass a period with a request in N m."""
        states, acting = self._states, self._acting(request)
        self._states = [
            _weighted([*row, *held], states, acting)
            for row, held in zip(self.step, self.held, strict=True)
        ]
        self._waiting = [*self._waiting[1:], request]

    def _acting(self, request: float) -> Sequence[float]:
        """Return the requests in effect within the coming period, the earlier one first."""
        waiting = [*self._waiting, request] if self.delayed else [request]
        return waiting[: self.inputs]


def _weighted(weights: list[float], states: list[float], requests: Sequence[float]) -> float:
    """Return the weighted sum of the four states and the requests."""
    total = (
        weights[0] * states[0]
        + weights[1] * states[1]
        + weights[2] * states[2]
        + weights[3] * states[3]
    )
    for weight, request in zip(weights[4:], requests, strict=True):
        total += weight * request
    return total
