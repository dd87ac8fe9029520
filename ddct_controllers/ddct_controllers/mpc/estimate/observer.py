"""Observer of the states that are not measured, with a constant gain."""

from dataclasses import dataclass

import numpy as np

from ddct_controllers.interface import Status
from ddct_controllers.mpc.model.transmission_model import MEASURED, TransmissionModel


@dataclass(frozen=True)
class AtRest:
    """Start of an estimate: speeds as measured, half-shaft and actuator at rest."""

    halfshaft_stiffness: float
    """In N m/rad; the half-shaft balances the load, inf for one that is not known."""
    initial_request: float
    """In N m, on which the actuator rests."""


class Observer:
    """
    x_(k|k) = x_(k|k-1) + l ((w_m, w_p, w_r)_k - x_(k|k-1)[:3]), x_(k+1|k) = a x_(k|k) + b u_k.

    What is measured, and how far it is trusted, is all in the constant gain l. The clutch is taken
    for a new one.
    """

    wear_gain = 1.0
    """K_usura as estimated, by which the states of the driveline are divided."""
    status: Status = ()
    """What `controller/status` shows of the estimate."""

    def __init__(self, model: TransmissionModel, gain: np.ndarray, start: AtRest | None) -> None:
        """Take the gain (n, 3), and how the estimate starts; None starts it at zero."""
        self.model, self.gain, self.start = model, gain, start
        self.reset()

    def at_rest(
        self, start: AtRest, speeds: tuple[float, float, float], load_torque: float
    ) -> np.ndarray:
        """Return x_(k|k), (n,), at the first measurement; speeds in rad/s, C_load in N m."""
        twist = load_torque / start.halfshaft_stiffness
        return self.model.at_rest(speeds, twist, start.initial_request)

    def reset(self) -> None:
        """Forget the estimate; the next measurement starts another one."""
        self._started = self.start is None
        self._state = np.zeros(len(self.model.a))

    def correct(self, speeds: tuple[float, float, float], load_torque: float) -> np.ndarray:
        """Return x_(k|k), (n,), for w_m, w_p, w_r in rad/s and C_load in N m."""
        if not self._started and self.start is not None:
            self._state = self.at_rest(self.start, speeds, load_torque)
            self._started = True
        else:
            self._state = self._state + self.gain @ (speeds - self._state[:MEASURED])
        return self._state

    def predict(self, inputs: tuple[float, float, float]) -> None:
        """Advance by one period with the saturated request, C_m and C_load in N m."""
        self._state = self.model.a @ self._state + self.model.b @ inputs
