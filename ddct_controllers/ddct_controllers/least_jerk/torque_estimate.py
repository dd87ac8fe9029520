# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Estimate of the torque that the clutch carries, from the torque balance of the engine."""

from ddct_controllers.least_jerk.torque_covariance import TorqueCovariance, TorqueNoise
from ddct_plant.base.timebase import PERIOD_S

LOWEST_GAIN, HIGHEST_GAIN = 0.4, 1.8
"""Bounds of the estimated wear gain."""
APPLIED_SHARE, APPLIED_SHARE_IN_SHIFTS = 0.1, 1.0
"""
Share with which a request follows the estimate, whose noise would move the torque.

In a shift nothing is known of the wear when feedback starts, and the engine runs up meanwhile.
"""


class CarriedTorque:
    """
    Kalman filter of w_m, the wear gain g and an offset d of the torque that the clutch carries.

    J_m dw_m/dt = C_m - c_m w_m - (g f + d), with f the mean torque of the actuator's model. f is
    known, so the filter is linear with a known coefficient that changes with time. d takes up a
    moved kiss point, and what a wrong delay makes of a torque that rises.
    """

    def __init__(
        self,
        engine_inertia: float,
        engine_damping: float,
        noise: TorqueNoise,
        applied_share: float = APPLIED_SHARE,
    ) -> None:
        """Take J_m in kg m^2, c_m in N m s/rad, the drifts, and the share of requests."""
        self._applied_share = applied_share
        self.step = PERIOD_S / engine_inertia
        """Change of w_m in rad/s per N m and period."""
        self._damping = engine_damping
        self._noise = noise
        self.reset()

    def reset(self) -> None:
        """Clear the estimate; the next measurement starts another one."""
        self.gain = 1.0
        """Estimate of the wear gain K_usura, without unit."""
        self.offset = 0.0
        """Estimate of d in N m."""
        self._applied_gain, self._applied_offset = 1.0, 0.0
        self._speed: float | None = None
        self._covariance = TorqueCovariance()

    def carried(self, torque: float) -> float:
        """Return the torque in N m that the clutch carries for an actuator's torque in N m."""
        return self.gain * torque + self.offset

    def request(self, torque: float) -> float:
        """Return the request in N m, not negative, for a torque in N m to be carried."""
        return max((torque - self._applied_offset) / self._applied_gain, 0.0)

    def applied(self, request: float) -> float:
        """Return the torque in N m that `request` is made for, from a request in N m."""
        return self._applied_gain * request + self._applied_offset

    def follow(self, speed: float) -> None:
        """Take a measured w_m in rad/s after a period that says nothing about the clutch."""
        self._speed = speed
        self._covariance = self._covariance.at_measured_speed()

    def update(self, speed: float, engine_torque: float, torque: float) -> None:
        """
        Take w_m in rad/s after a period of slipping.

        C_m and the mean torque of the actuator in that period are in N m.
        """
        if self._speed is None:
            self.follow(speed)
            return
        driven = engine_torque - self._damping * self._speed - self.carried(torque)
        predicted = self._speed + self.step * driven
        gains, self._covariance = self._covariance.after_period(self.step, torque, self._noise)
        error = speed - predicted
        self._speed = predicted + gains.speed * error
        self.gain = min(max(self.gain + gains.gain * error, LOWEST_GAIN), HIGHEST_GAIN)
        self.offset += gains.offset * error
        self._applied_gain += self._applied_share * (self.gain - self._applied_gain)
        self._applied_offset += self._applied_share * (self.offset - self._applied_offset)
