"""What the clutch transmits beyond its model, estimated from the engine's speed."""

import math

from ddct_plant.base.timebase import PERIOD_S


class ClutchTorqueEstimator:
    """
    A Luenberger observer of J_m dw_m/dt = C_m - C_n - d, with d constant.

    C_n is the clutch torque that the actuator's model gives, d what the clutch transmits beyond
    it, which wear or another fault makes. Both poles of the sampled observer are at
    exp(-bandwidth T). Damping of the engine counts as part of d.
    """

    def __init__(self, engine_inertia: float, bandwidth_rad_s: float) -> None:
        """Take J_m in kg m^2 and the bandwidth."""
        pole = math.exp(-bandwidth_rad_s * PERIOD_S)
        self._speed_gain = 1.0 - pole**2
        self._torque_gain = -engine_inertia * (1.0 - pole) ** 2 / PERIOD_S
        self._engine_inertia = engine_inertia
        self.reset()

    def reset(self) -> None:
        """Forget everything; the next speed starts an estimate with d = 0."""
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
