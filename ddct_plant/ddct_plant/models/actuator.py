"""Actuator: saturation, 10 ms delay and the second-order pair G_a(s) (Section 1.4.2)."""

import numpy as np

from ddct_plant.base.timebase import PERIOD_S, SUBSTEPS
from ddct_plant.linear.lti import lift_zoh_dense
from ddct_plant.models.printed import ACTUATOR


class Actuator:
    """
    Torque of the actuator for the requested torque, exact between samples.

    The request is cut off below zero, delayed by one period and filtered by G_a(s). G_a is
    strictly proper, so the torque is continuous; its 11 nodes over a period resolve modes up to
    206 rad/s, which the 10 ms grid would not.
    """

    def __init__(self, initial_request: float = 0.0) -> None:
        """Start at rest on `initial_request` in N m, delay line included."""
        model = ACTUATOR.to_state_space()
        transition, held_input, outputs, feedthrough = lift_zoh_dense(model, PERIOD_S, SUBSTEPS)
        self._state_update = np.hstack([transition, held_input])
        self._nodes = np.hstack([outputs, feedthrough])
        delayed = max(initial_request, 0.0)
        at_rest = np.linalg.solve(model.a, -model.b[:, 0] * delayed)
        self._state_and_delayed = np.array([*at_rest, delayed])

    def update(self, request: float) -> list[float]:
        """Return the torque in N m at 0, 1, ..., 10 ms, (11,), and take the next request in."""
        values = self._state_and_delayed
        nodes = (self._nodes @ values).tolist()
        values[:-1] = self._state_update @ values
        values[-1] = max(request, 0.0)
        return nodes
