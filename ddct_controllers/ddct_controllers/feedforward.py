# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Feedforward of engine torque and load torque (thesis Section 1.6.2), as it runs."""

from ddct_controllers.design.feedforward import design_feedforward, state_at_rest
from ddct_controllers.linear import DiscreteFilter
from ddct_plant.models.actuator import ActuatorParameters
from ddct_plant.models.parameters import DrivelineParameters


class Feedforward:
    """
    u = -C_1 C_m - C_2 C_load with proper, stable C_1 and C_2; see `design.feedforward`.

    C_1 and C_2 are negative, as P_2 is, so that the request is about 0.88 C_m, with a lead that
    compensates the lag of the actuator.
    """

    def __init__(self, driveline: DrivelineParameters, actuator: ActuatorParameters) -> None:
        """Design the filter for a driveline and an actuator."""
        self._model = design_feedforward(driveline, actuator)
        self._filter = DiscreteFilter(self._model)
        self._started = False

    def update(self, engine_torque: float, load_torque: float) -> float:
        """Return the request in N m for C_m and C_load in N m of the coming period."""
        if not self._started:
            self._filter.reset(state_at_rest(self._model, engine_torque))
            self._started = True
        return self._filter.update(engine_torque, load_torque)
