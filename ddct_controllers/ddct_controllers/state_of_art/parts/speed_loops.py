# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Parts of the loops of two speeds: a PID, the engine's share, an estimator of the clutch."""

import math

from ddct_controllers.interface import Measurement
from ddct_controllers.state_of_art.parts.rigid_transmission import RigidTransmission
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.engine import EngineAuthority, EngineResponse

TAKEOVER_BANDWIDTH_RAD_S = 5.0
"""Highest crossover in rad/s of the slip loop through the clutch."""
TAKEOVER_LAG_RAD = 0.22
"""Most phase in rad that the actuator's lag may cost at the crossover, 13 degrees."""
NEGLIGIBLE_RAD_S2 = 1e-6


class Pid:
    """
    u_k = K_p e_k + K_d (e_k - e_(k-1))/T + i_k, i_(k+1) = i_k + K_i T e_k.

    The gains are those for a speed that follows its acceleration command after a lag. Without lag
    the plant is 1/s, and K_p = 2 w, K_i = w^2 put both closed-loop poles at -w. The series form
    (K_p + K_i/s)(1 + lag s) cancels a first-order lag in front of it.
    """

    def __init__(self, bandwidth_rad_s: float, lag_s: float = 0.0) -> None:
        """Start with an empty integral and no last error."""
        proportional = 2.0 * bandwidth_rad_s
        self.integral = bandwidth_rad_s**2
        """Integral gain K_i in 1/s^2."""
        self.proportional = proportional + self.integral * lag_s
        """Proportional gain K_p in 1/s."""
        self.derivative = proportional * lag_s
        """Derivative gain K_d, without unit."""
        self.reset()

    def reset(self) -> None:
        """Empty the integral; the next error has no derivative."""
        self._integrated = 0.0
        self._last_error: float | None = None

    def update(self, error: float) -> float:
        """Return the acceleration in rad/s^2 for an error in rad/s."""
        change = 0.0 if self._last_error is None else error - self._last_error
        self._last_error = error
        action = self.proportional * error + self.derivative * change / PERIOD_S + self._integrated
        self._integrated += self.integral * PERIOD_S * error
        return action

    def unwind(self, excess: float) -> None:
        """
        Reduce the integral by the part of the last action that saturated, `excess` in rad/s^2.

        Back-calculation (Astrom and Hagglund) with the tracking time K_p/K_i.
        """
        self._integrated -= PERIOD_S * self.integral / self.proportional * excess


class EngineShare:
    """
    An engine that moves the slip as a PID requests, within its authority.

    Beyond it the slip would diverge. Then `lacking`, the requested slip acceleration that the
    engine cannot supply, goes to the clutch through a PI: with the PID's anti-windup it is K_p
    times the slip error, and C_f = -(w/(g K_p)) (1 + w/(4 s)) lacking, g = 1/J_m + 1/J_eq, makes a
    slip loop of crossover w, which is the lower, the more the actuator lags. A lag of the engine
    is not counted as lacking.
    """

    def __init__(
        self,
        transmission: RigidTransmission,
        authority: EngineAuthority,
        bandwidth_rad_s: float,
        clutch_lag_s: float,
    ) -> None:
        """Take the bandwidth in rad/s of the PID that acts on the slip, and the clutch's lag."""
        self._transmission = transmission
        self._authority = authority
        self._pid = pid = Pid(bandwidth_rad_s, authority.lag_s)
        crossover = min(TAKEOVER_BANDWIDTH_RAD_S, TAKEOVER_LAG_RAD / clutch_lag_s)
        proportional = crossover / (transmission.slip_gain * pid.proportional)
        self._proportional = proportional
        self._integral_gain = proportional * crossover / 4.0
        self._share = PERIOD_S / (PERIOD_S + pid.derivative / pid.proportional)
        self.reset()

    def reset(self) -> None:
        """Return to the demand."""
        self._response = EngineResponse(self._authority)
        self._pid.reset()
        self._lacking = 0.0
        self._taken_over = 0.0

    @property
    def at_its_limit(self) -> bool:
        """Whether the last request was beyond the engine's authority."""
        return abs(self._lacking) > NEGLIGIBLE_RAD_S2

    @property
    def clutch_torque(self) -> float:
        """Additional torque of the clutch in place of the engine, in N m."""
        return -self._proportional * self._lacking - self._taken_over

    def hold(self, measurement: Measurement) -> float:
        """Return C_m in N m over a period with the driver's demand as the request."""
        return self._response.deliver(measurement.engine_torque, measurement.engine_torque)

    def update(
        self,
        measurement: Measurement,
        clutch_torque: float,
        slip_error: float,
        slip_rate: float,
    ) -> tuple[float, float]:
        """
        Return the request for C_m and the C_m that follows, in N m over the coming period.

        The slip shall have the rate `slip_rate` in rad/s^2 and lose the error in rad/s, with
        `clutch_torque` N m transmitted.
        """
        rate = slip_rate + self._pid.update(slip_error)
        request = self._transmission.engine_torque(measurement, clutch_torque, rate)
        demand, limits = measurement.engine_torque, self._authority
        delivered = self._response.deliver(demand, request)
        reachable = demand + self._response.requested
        reachable = min(max(reachable, limits.minimum_torque_n_m), limits.maximum_torque_n_m)
        lacking = (request - reachable) / self._transmission.engine_inertia
        self._pid.unwind(lacking)
        self._lacking += self._share * (lacking - self._lacking)
        self._taken_over += self._integral_gain * PERIOD_S * self._lacking
        return request, delivered


class ClutchTorqueEstimator:
    """
    A Luenberger observer of J_m dw_m/dt = C_m - C_n - d, with d constant.

    C_n is the clutch torque of the actuator's model, d the torque that the clutch transmits beyond
    it because of wear or another fault. Both poles of the sampled observer are at exp(-bandwidth
    T). Damping of the engine counts as part of d.
    """

    def __init__(self, engine_inertia: float, bandwidth_rad_s: float) -> None:
        """Take J_m in kg m^2 and the bandwidth in rad/s."""
        pole = math.exp(-bandwidth_rad_s * PERIOD_S)
        self._speed_gain = 1.0 - pole**2
        self._torque_gain = -engine_inertia * (1.0 - pole) ** 2 / PERIOD_S
        self._engine_inertia = engine_inertia
        self.reset()

    def reset(self) -> None:
        """Clear the estimate; the next speed starts one with d = 0."""
        self._speed: float | None = None
        self._deviation = 0.0

    def correct(self, engine_speed: float) -> float:
        """Return d in N m for w_m in rad/s."""
        if self._speed is None:
            self._speed = engine_speed
        innovation = engine_speed - self._speed
        self._speed += self._speed_gain * innovation
        self._deviation += self._torque_gain * innovation
        return self._deviation

    def predict(self, engine_torque: float, nominal_clutch_torque: float) -> None:
        """Advance by one period over which C_m and C_n have these means in N m."""
        assert self._speed is not None, 'correct comes first'
        torque = engine_torque - nominal_clutch_torque - self._deviation
        self._speed += PERIOD_S * torque / self._engine_inertia
