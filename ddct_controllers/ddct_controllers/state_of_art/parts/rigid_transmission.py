# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The two inertias that a slipping clutch couples, on a rigid driveline, and a plan for them."""

import math
from dataclasses import dataclass

from ddct_controllers.interface import Measurement
from ddct_plant.base.timebase import PERIOD_S, time_of_step
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.scenario.control import EngineSpeedReference


@dataclass(frozen=True)
class RigidTransmission:
    """
    J_m dw_m/dt = C_m - C_f and J_eq dw_p/dt = C_f - C_load/tau, J_eq = J_p + J_v/tau^2.

    Damping is left out. This is the usual model for the design of clutch control.
    """

    driveline: DrivelineParameters

    @property
    def engine_inertia(self) -> float:
        """Engine inertia J_m in kg m^2."""
        return self.driveline.engine_inertia

    @property
    def vehicle_inertia(self) -> float:
        """Inertia J_eq of primary shaft and vehicle, referred to the primary shaft, in kg m^2."""
        return self.driveline.vehicle_side_inertia

    @property
    def slip_gain(self) -> float:
        """Slip deceleration per clutch torque, 1/J_m + 1/J_eq, in rad/s^2 per N m."""
        return 1.0 / self.engine_inertia + 1.0 / self.vehicle_inertia

    @property
    def rigid_below_rad_s(self) -> float:
        """
        Frequency sqrt(k_sa/J_v) in rad/s below which the vehicle follows the shaft.

        Above it the vehicle is decoupled by the compliance of the half-shaft.
        """
        return math.sqrt(self.driveline.halfshaft_stiffness / self.driveline.vehicle_inertia)

    def constant_slip_acceleration(self, measurement: Measurement) -> float:
        """Return (C_m - C_load/tau)/(J_m + J_eq) in rad/s^2, that of both at constant slip."""
        torque = measurement.engine_torque - self.load_at_shaft(measurement)
        return torque / (self.engine_inertia + self.vehicle_inertia)

    def load_at_shaft(self, measurement: Measurement) -> float:
        """Return C_load/tau in N m."""
        return float(self.driveline.gear.shaft_torque(measurement.load_torque))

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
            + p.gear.shaft_torque(p.vehicle_inertia * measurement.wheel_speed)
        )


class SpeedPlan:
    """
    The engine speed reference w_m* and its rate, step by step.

    Without points in the scenario, w_m* = (H + J_eq s)/(J_m + J_eq), s the slip reference: the
    speed at which the transmission has that slip and the momentum H that results from the driver's
    demand and the load, dH/dt = C_m - C_load/tau. Followed exactly, it needs no other engine
    torque than the demand. H starts as measured when control starts.
    """

    def __init__(self, transmission: RigidTransmission, given: EngineSpeedReference) -> None:
        """Plan for a transmission; `given` prevails if it has points."""
        self._transmission = transmission
        self._given = given
        self.reset()

    def reset(self) -> None:
        """Clear the momentum; the next update computes it from the measured speeds."""
        self._momentum: float | None = None

    def update(self, measurement: Measurement, *, afresh: bool = False) -> tuple[float, float]:
        """
        Return w_m* in rad/s and its rate over the coming period in rad/s^2.

        With `afresh` the momentum is computed anew from the measured speeds.
        """
        if self._given.given:
            now, then = (
                self._given.at(time_of_step(step))
                for step in (measurement.step, measurement.step + 1)
            )
            return now, (then - now) / PERIOD_S
        transmission = self._transmission
        momentum = self._momentum
        if momentum is None or afresh:
            momentum = transmission.momentum(measurement)
        vehicle = transmission.vehicle_inertia
        total = transmission.engine_inertia + vehicle
        acceleration = transmission.constant_slip_acceleration(measurement)
        self._momentum = momentum + PERIOD_S * total * acceleration
        return (
            (momentum + vehicle * measurement.slip_reference[0]) / total,
            acceleration + vehicle / total * measurement.slip_reference_rate[0],
        )
