"""The two inertias that a slipping clutch couples, with the driveline taken as rigid."""

import math
from dataclasses import dataclass

from ddct_controllers.interface import Measurement
from ddct_plant.models.parameters import DrivelineParameters


@dataclass(frozen=True)
class RigidTransmission:
    """
    J_m dw_m/dt = C_m - C_f and J_eq dw_p/dt = C_f - C_load/tau, J_eq = J_p + J_v/tau^2.

    Damping is left out. This is the usual model for the design of clutch control.
    """

    driveline: DrivelineParameters

    @property
    def engine_inertia(self) -> float:
        """J_m in kg m^2."""
        return self.driveline.engine_inertia

    @property
    def vehicle_inertia(self) -> float:
        """J_eq in kg m^2, primary shaft and vehicle seen at the primary shaft."""
        p = self.driveline
        return p.shaft_inertia + p.vehicle_inertia / p.total_ratio**2

    @property
    def slip_gain(self) -> float:
        """1/J_m + 1/J_eq, by which slip falls, in rad/s^2 per N m of clutch torque."""
        return 1.0 / self.engine_inertia + 1.0 / self.vehicle_inertia

    @property
    def rigid_below_rad_s(self) -> float:
        """sqrt(k_sa/J_v): below it the vehicle follows the shaft, above it hangs on a spring."""
        return math.sqrt(self.driveline.halfshaft_stiffness / self.driveline.vehicle_inertia)

    def constant_slip_acceleration(self, measurement: Measurement) -> float:
        """Return (C_m - C_load/tau)/(J_m + J_eq) in rad/s^2, that of both at constant slip."""
        torque = measurement.engine_torque - self.load_at_shaft(measurement)
        return torque / (self.engine_inertia + self.vehicle_inertia)

    def load_at_shaft(self, measurement: Measurement) -> float:
        """Return C_load/tau in N m."""
        return measurement.load_torque / self.driveline.total_ratio

    def engine_torque(
        self, measurement: Measurement, clutch_torque: float, slip_rate: float
    ) -> float:
        """
        Return the C_m in N m at which slip changes by `slip_rate` in rad/s^2 with C_f in N m.

        C_m = C_f + J_m ((C_f - C_load/tau)/J_eq + dw_d/dt).
        """
        shaft_rate = (clutch_torque - self.load_at_shaft(measurement)) / self.vehicle_inertia
        return clutch_torque + self.engine_inertia * (shaft_rate + slip_rate)

    def momentum(self, measurement: Measurement) -> float:
        """Return J_m w_m + J_p w_p + J_v w_r/tau in kg m^2/s, which C_f does not change."""
        p = self.driveline
        return (
            p.engine_inertia * measurement.engine_speed
            + p.shaft_inertia * measurement.shaft_speed
            + p.vehicle_inertia * measurement.wheel_speed / p.total_ratio
        )
