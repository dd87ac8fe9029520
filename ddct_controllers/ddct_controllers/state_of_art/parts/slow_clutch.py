# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The clutch's share of two-input control: it makes a slow speed follow a plan."""

import numpy as np

from ddct_controllers.interface import ControllerContext, Measurement
from ddct_controllers.linear import DiscreteFilter
from ddct_controllers.state_of_art.parts.rigid_transmission import RigidTransmission, SpeedPlan
from ddct_controllers.state_of_art.parts.speed_loops import Pid
from ddct_plant.base.timebase import PERIOD_S, SUBSTEPS
from ddct_plant.linear.lti import StateSpace
from ddct_plant.linear.sampling import discretise_zoh
from ddct_plant.models.actuator import Actuator
from ddct_plant.scenario.initial_state import initial_request


class SlowClutch:
    """
    C_f = C_load/tau + J_eq (a_0 + W (a - a_0)) for a desired shaft acceleration a.

    a_0 is that of constant slip. Above sqrt(k_sa/J_v) the inverse of a rigid driveline is wrong by
    far, as the compliance of the half-shaft then decouples the vehicle; so W = w^2/(s + w)^2
    passes frequencies below half of that, and the engine supplies the rest. Without W the loops
    are unstable from bandwidths of 0.5 to 1 rad/s on.
    """

    def __init__(self, context: ControllerContext, bandwidth_rad_s: float) -> None:
        """Start as the run does, with the bandwidth of the loop of `pid` in rad/s."""
        self._initial_request = initial_request(context.settings)
        scenario = context.settings.scenario
        self.actuator = scenario.actuator
        """Known actuator, whose lag is behind each request."""
        transmission = self.transmission = RigidTransmission(scenario.controlled_driveline)
        """Rigid transmission that plan and request are computed for."""
        self.plan = SpeedPlan(transmission, scenario.engine_speed_reference)
        """Plan of the engine speed."""
        corner = 0.5 * transmission.rigid_below_rad_s
        # At low frequency the shaft's acceleration is so far behind the desired one.
        lag_s = 2.0 / corner + self.actuator.lag_s
        self.pid = Pid(bandwidth_rad_s, lag_s)
        """Controller from the error of the slow speed in rad/s to an acceleration in rad/s^2."""
        self._filter = DiscreteFilter(_low_pass(corner))
        self.reset()

    def reset(self) -> None:
        """Start afresh, with the actuator at rest on the initial request."""
        for part in (self.plan, self.pid, self._filter):
            part.reset()
        self._actuator = Actuator(self._initial_request, self.actuator)

    def torque(self, measurement: Measurement, acceleration: float) -> float:
        """Return C_f in N m for a desired shaft acceleration in rad/s^2."""
        constant_slip = self.transmission.constant_slip_acceleration(measurement)
        passed = constant_slip + self._filter.update(acceleration - constant_slip)
        return (
            self.transmission.load_at_shaft(measurement)
            + self.transmission.vehicle_inertia * passed
        )

    def request(self, measurement: Measurement, acceleration: float, more: float) -> float:
        """Return the request in N m for this acceleration in rad/s^2, plus `more` in N m."""
        torque = self.torque(measurement, acceleration) + more
        request = max(torque, 0.0)
        self.pid.unwind((torque - request) / self.transmission.vehicle_inertia)
        return request

    def nominal(self, request: float) -> float:
        """
        Return the torque in N m of a clutch without wear, and store the request in N m.

        It is the actuator's mean over the coming period, which moves the engine; the request acts
        after the actuator's delay.
        """
        nodes = self._actuator.update(request)
        return (sum(nodes) - 0.5 * (nodes[0] + nodes[-1])) / SUBSTEPS


def _low_pass(corner_rad_s: float) -> StateSpace:
    """Return w^2/(s + w)^2, sampled."""
    a = corner_rad_s * np.array([[-1.0, 1.0], [0.0, -1.0]])
    b = corner_rad_s * np.array([[0.0], [1.0]])
    continuous = StateSpace(a, b, np.array([[1.0, 0.0]]), np.zeros((1, 1)))
    return discretise_zoh(continuous, PERIOD_S)
