# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The torque of the printed actuator by periods, in plain floats, and its torque to come."""

import numpy as np

from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import StateSpace
from ddct_plant.linear.sampling import discretise_zoh
from ddct_plant.models.actuator import at_rest
from ddct_plant.models.printed import ACTUATOR

AHEAD = 4
"""
Number of coming periods whose torque the requests so far decide: the delay, and the lag of G_a.

Both are 43 ms at low frequency (Section 1.4.2).
"""


class ActuatorTorque:
    """
    G_a(s) behind a delay of one period: mean torque of a period, and of the coming `AHEAD` ones.

    The states of G_a are extended by the integral of the torque, so the means are exact.
    """

    def __init__(self) -> None:
        """Start at rest on a request of zero."""
        model = ACTUATOR.to_state_space()
        size = len(model.a)
        a, b = np.zeros((size + 1, size + 1)), np.zeros((size + 1, 1))
        a[:size, :size], a[size, :size], b[:size] = model.a, model.c[0], model.b
        sampled = discretise_zoh(
            StateSpace(a, b, np.eye(size + 1), np.zeros((size + 1, 1))), PERIOD_S
        )
        step, held = sampled.a[:size, :size], sampled.b[:size, 0]
        mean, mean_held = sampled.a[size, :size] / PERIOD_S, sampled.b[size, 0] / PERIOD_S
        total, total_held = np.zeros(size), 0.0
        power, response = np.eye(size), np.zeros(size)
        for _ in range(AHEAD):
            total, total_held = total + mean @ power, total_held + mean @ response + mean_held
            power, response = step @ power, step @ response + held
        self.step: list[list[float]] = step.tolist()
        """Map of the states over a period, (4, 4)."""
        self.held: list[float] = held.tolist()
        """Effect of the delayed request on the states after a period, (4,)."""
        self.mean = [*mean.tolist(), float(mean_held)]
        """Map of the states and the delayed request to the mean torque of the period, (5,)."""
        self.total = [*total.tolist(), float(total_held)]
        """The same to the sum of the means of `AHEAD` periods with that request, (5,)."""
        self.at_rest: list[float] = at_rest(model, 1.0).tolist()
        """States at rest on a request of 1 N m, (4,)."""
        self.reset(0.0)

    def reset(self, request: float) -> None:
        """Put the actuator at rest on a request in N m."""
        self.request = request
        """Request of the period before in N m, which acts in the coming one."""
        self._states = [state * request for state in self.at_rest]

    def mean_torque(self) -> float:
        """Return the mean torque of the coming period in N m."""
        return _weighted(self.mean, self._states, self.request)

    def torque_ahead(self) -> float:
        """Return the sum of the mean torques of the coming `AHEAD` periods in N m."""
        return _weighted(self.total, self._states, self.request)

    def advance(self, request: float) -> None:
        """Pass a period; `request` in N m acts from the next one on."""
        states, before = self._states, self.request
        self._states = [
            row[0] * states[0]
            + row[1] * states[1]
            + row[2] * states[2]
            + row[3] * states[3]
            + held * before
            for row, held in zip(self.step, self.held, strict=True)
        ]
        self.request = request


def _weighted(weights: list[float], states: list[float], request: float) -> float:
    """Return the weighted sum of the four states and the request."""
    return (
        weights[0] * states[0]
        + weights[1] * states[1]
        + weights[2] * states[2]
        + weights[3] * states[3]
        + weights[4] * request
    )
