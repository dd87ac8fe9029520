"""The clutch's share of two-input control: what the driveline can follow as a rigid body."""

import numpy as np

from ddct_controllers.discrete_filter import DiscreteFilter
from ddct_controllers.interface import ControllerContext, Measurement
from ddct_controllers.state_of_art.parts.clutch_actuation import ClutchActuation
from ddct_controllers.state_of_art.parts.lag import ACTUATION_LAG_S
from ddct_controllers.state_of_art.parts.rigid_transmission import RigidTransmission
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import StateSpace, discretise_zoh


class SlowClutch:
    """
    C_f = C_load/tau + J_eq (a_0 + W (a - a_0)) for a wanted shaft acceleration a.

    a_0 is that of constant slip. Above sqrt(k_sa/J_v) the inverse of a rigid driveline is wrong by
    far, as the vehicle then hangs on the half-shaft like on a spring; so W = w^2/(s + w)^2 passes
    what lies below half of that frequency, and the engine makes up for the rest. Without W the
    loops are unstable from bandwidths of 0.5 to 1 rad/s on.
    """

    def __init__(self, context: ControllerContext, transmission: RigidTransmission) -> None:
        """Start as the run does."""
        self._transmission = transmission
        corner = 0.5 * transmission.rigid_below_rad_s
        self.lag_s = 2.0 / corner + ACTUATION_LAG_S
        """Of the shaft's acceleration behind the wanted one, at low frequency."""
        self._filter = DiscreteFilter(_low_pass(corner))
        self._actuation = ClutchActuation(context)

    def reset(self) -> None:
        """Start afresh."""
        self._filter.reset()
        self._actuation.reset()

    def hold(self, measurement: Measurement) -> float:
        """Return what `nominal` does, for the open-loop torque alone."""
        return self._actuation.update(measurement.open_loop_torque)

    def torque(self, measurement: Measurement, acceleration: float) -> float:
        """Return C_f in N m for a wanted shaft acceleration in rad/s^2."""
        constant_slip = self._transmission.constant_slip_acceleration(measurement)
        passed = constant_slip + self._filter.update(acceleration - constant_slip)
        return (
            self._transmission.load_at_shaft(measurement)
            + self._transmission.vehicle_inertia * passed
        )

    def nominal(self, request: float) -> float:
        """Return the actuator's mean torque over the coming period in N m, after this request."""
        return self._actuation.update(request)


def _low_pass(corner_rad_s: float) -> StateSpace:
    """Return w^2/(s + w)^2, sampled."""
    a = corner_rad_s * np.array([[-1.0, 1.0], [0.0, -1.0]])
    b = corner_rad_s * np.array([[0.0], [1.0]])
    continuous = StateSpace(a, b, np.array([[1.0, 0.0]]), np.zeros((1, 1)))
    return discretise_zoh(continuous, PERIOD_S)
