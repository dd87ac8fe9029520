# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Estimate of the torque that the clutch carries, from the torque balance of the engine."""

from dataclasses import dataclass

from ddct_plant.base.timebase import PERIOD_S

SPEED_NOISE_RAD_S = 0.1
"""Standard deviation of the measured w_m, twice what our other observers assume."""
ENGINE_TORQUE_NOISE_N_M = 3.0
"""Standard deviation of C_m per period."""
INITIAL_GAIN = 0.2
"""Standard deviation of the wear gain from 1 before the first measurement."""
INITIAL_OFFSET_N_M = 2.0
"""Standard deviation of the offset of the torque before the first measurement."""
LOWEST_GAIN, HIGHEST_GAIN = 0.4, 1.8
"""Bounds of the estimated wear gain."""
LEAST_TORQUE_N_M = 5.0
"""Torque below which the wear gain does not drift: there it is not observable."""
APPLIED_SHARE, APPLIED_SHARE_IN_SHIFTS = 0.1, 1.0
"""
Share with which a request follows the estimate, whose noise would move the torque.

In a shift nothing is known of the wear when feedback starts, and the engine runs up meanwhile.
"""
AT_TORQUE_N_M = 100.0
"""Torque at which the drift of the offset is given: it is in proportion to the torque."""


@dataclass(frozen=True)
class TorqueNoise:
    """Drifts of the estimate, standard deviations per period."""

    gain_drift: float
    """Drift of the wear gain."""
    offset_drift_n_m: float
    """Drift of the offset in N m at a torque of `AT_TORQUE_N_M`."""


class CarriedTorque:
    """
    Kalman filter of w_m, the wear gain g and an offset d of the torque that the clutch carries.

    J_m dw_m/dt = C_m - c_m w_m - (g f + d), with f the mean torque of the actuator's model. f is
    known, so the filter is linear with a known coefficient that changes with time. d takes up a
    moved kiss point, and what a wrong delay makes of a torque that rises. The covariance is kept
    as its six different entries.
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
        self._ss = SPEED_NOISE_RAD_S**2
        self._sg = self._sd = self._gd = 0.0
        self._gg, self._dd = INITIAL_GAIN**2, INITIAL_OFFSET_N_M**2

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
        self._ss = SPEED_NOISE_RAD_S**2
        self._sg = self._sd = 0.0

    def update(self, speed: float, engine_torque: float, torque: float) -> None:
        """
        Take w_m in rad/s after a period of slipping.

        C_m and the mean torque of the actuator in that period are in N m.
        """
        if self._speed is None:
            self.follow(speed)
            return
        step, noise = self.step, self._noise
        driven = engine_torque - self._damping * self._speed - self.carried(torque)
        predicted = self._speed + step * driven
        # Prediction of the covariance: w_m depends on g by -step f, and on d by -step.
        by_gain = step * torque
        spread_g = self._sg - by_gain * self._gg - step * self._gd
        spread_d = self._sd - by_gain * self._gd - step * self._dd
        spread = self._ss - by_gain * (self._sg + spread_g) - step * (self._sd + spread_d)
        spread += (step * ENGINE_TORQUE_NOISE_N_M) ** 2
        gain_spread = self._gg + (noise.gain_drift**2 if torque > LEAST_TORQUE_N_M else 0.0)
        offset_drift = noise.offset_drift_n_m * torque / AT_TORQUE_N_M
        offset_spread = self._dd + offset_drift * offset_drift
        # Correction by the measured speed.
        innovation = spread + SPEED_NOISE_RAD_S**2
        k_s, k_g, k_d = spread / innovation, spread_g / innovation, spread_d / innovation
        error = speed - predicted
        self._speed = predicted + k_s * error
        self.gain = min(max(self.gain + k_g * error, LOWEST_GAIN), HIGHEST_GAIN)
        self.offset += k_d * error
        self._applied_gain += self._applied_share * (self.gain - self._applied_gain)
        self._applied_offset += self._applied_share * (self.offset - self._applied_offset)
        self._ss = spread - k_s * spread
        self._sg = spread_g - k_s * spread_g
        self._sd = spread_d - k_s * spread_d
        self._gg = gain_spread - k_g * spread_g
        self._gd -= k_g * spread_d
        self._dd = offset_spread - k_d * spread_d
