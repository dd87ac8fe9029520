# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Estimate of the slip that the plates would have if the half-shafts were rigid."""

import math

from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.parameters import DrivelineParameters

TORQUE_RATE_SHARE = 0.6
"""Share with which a new rate of the torque enters the correction for the twist."""


def rigid_inertia(driveline: DrivelineParameters) -> float:
    """Return J_r in kg m^2, the inertia of the slip of a rigid car."""
    engine, vehicle = driveline.engine_inertia, driveline.vehicle_side_inertia
    return engine * vehicle / (engine + vehicle)


def shaft_twist(driveline: DrivelineParameters) -> float:
    """Return kappa in rad/s per N m/s."""
    p = driveline
    return p.vehicle_inertia / (p.vehicle_side_inertia * p.halfshaft_stiffness)


def twist_of(driveline: DrivelineParameters) -> float:
    """Return J_r kappa in N m s per N m/s."""
    return rigid_inertia(driveline) * shaft_twist(driveline)


class RigidSlip:
    """
    Observer of the slip s of the rigid transmission, and of an error of the surplus torque.

    The surplus y is the torque that the clutch carries beyond that of constant slip:
    J_r ds/dt = -y, J_r = J_m J_eq / (J_m + J_eq). While the torque changes at the rate r, the
    half-shafts twist further, and the measured slip is w_d = s - kappa r with
    kappa = J_v/(k_sa J_eq). So w_d + kappa r is what the observer compares with: its
    model needs no half-shaft, and the oscillation of w_p is left out. Both poles are at
    exp(-bandwidth T).
    """

    def __init__(self, driveline: DrivelineParameters, bandwidth_rad_s: float) -> None:
        """Place both poles at the bandwidth."""
        self.inertia = rigid_inertia(driveline)
        """J_r in kg m^2."""
        self.twist_s2 = shaft_twist(driveline)
        """kappa in rad/s per N m/s."""
        pole = math.exp(-bandwidth_rad_s * PERIOD_S)
        self.slip_share = 1.0 - pole * pole
        """Share of the error of the predicted slip by which the slip is corrected."""
        self.surplus_share = (1.0 - pole) ** 2 * self.inertia / PERIOD_S
        """The same for the surplus, in N m per rad/s."""
        self.reset()

    def reset(self) -> None:
        """Clear the estimate."""
        self.slip = 0.0
        """Estimate of s in rad/s."""
        self.surplus_error = 0.0
        """Estimate of the error of y in N m: what the clutch carries beyond the estimate."""
        self._torque_rate = 0.0

    def follow(self, measured: float, *, keep: bool = False) -> None:
        """
        Take the measured slip in rad/s of plates that may turn together, or before any torque.

        With `keep` the error of the surplus stays: they may also slip still.
        """
        self.slip, self._torque_rate = measured, 0.0
        if not keep:
            self.surplus_error = 0.0

    def update(self, measured: float, surplus: float, change: float) -> None:
        """
        Take the measured slip in rad/s after a period of slipping.

        `surplus` is y in N m in that period, `change` that of the carried torque in N m from the
        mean of the period before to that of this one.
        """
        self._torque_rate += TORQUE_RATE_SHARE * (change / PERIOD_S - self._torque_rate)
        predicted = self.slip - PERIOD_S / self.inertia * (surplus + self.surplus_error)
        error = measured + self.twist_s2 * self._torque_rate - predicted
        self.slip = predicted + self.slip_share * error
        self.surplus_error -= self.surplus_share * error

    def update_held_shaft(self, measured: float, rate: float) -> None:
        """Take the measured slip in rad/s while the car stands; `rate` is that of w_m."""
        predicted = self.slip + PERIOD_S * rate
        self.slip = predicted + self.slip_share * (measured - predicted)
        self.surplus_error = 0.0
