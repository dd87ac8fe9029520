# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Measurements of observers in the torque phase of a shift, with torque of another clutch."""

from ddct_controllers.interface import Measurement
from ddct_plant.models.actuator import Actuator
from ddct_plant.scenario.rules.shift import gears_of
from ddct_plant.scenario.settings import KnownSettings
from ddct_plant.shift.balance import OffGoingBalance


class TorquePhase:
    """
    Measurements in which the off-going clutch is part of the engine and of the load.

    A controller's model has the on-coming clutch alone. The torque C_1 of the other one takes as
    much from the engine and gives tau_i C_1 to the wheels. So the model explains the speeds with
    C_m - C_1 and C_load - tau_i C_1, and its observer does not take C_1 for wear or another error.
    C_1 is that of the rigid driveline with a locked off-going clutch, and C_2 in it that of the
    known actuator.
    """

    def __init__(self, settings: KnownSettings) -> None:
        """Start with the on-coming actuator at rest on a request of zero."""
        self._balance = OffGoingBalance.of(gears_of(settings.scenario))
        self._actuator = Actuator(0.0, settings.scenario.actuator)

    def measured(self, measurement: Measurement) -> Measurement:
        """Return the measurement of a period; called once in each period of the torque phase."""
        carried = self._balance.torque(
            measurement.engine_torque,
            measurement.load_torque,
            measurement.engine_speed,
            self._actuator.mean_torque(measurement.open_loop_torque),
        )
        wheel_torque = self._balance.off_going.wheel_torque(carried)
        return measurement.within(
            measurement.load_torque - wheel_torque,
            measurement.open_loop_torque,
            measurement.engine_torque - carried,
        )
