"""PID control of a speed, from its error to an acceleration, with gains by pole placement."""

from ddct_plant.base.timebase import PERIOD_S


class Pid:
    """
    u_k = K_p e_k + K_d (e_k - e_(k-1))/T + i_k, i_(k+1) = i_k + K_i T e_k.

    The gains are those for a speed that follows its acceleration command after a lag. Without lag
    the plant is 1/s, and K_p = 2 w, K_i = w^2 put both closed-loop poles at -w. The series form
    (K_p + K_i/s)(1 + lag s) cancels a first-order lag in front of it.
    """

    def __init__(self, bandwidth_rad_s: float, lag_s: float = 0.0) -> None:
        """Start without memory."""
        proportional = 2.0 * bandwidth_rad_s
        self.integral = bandwidth_rad_s**2
        """K_i in 1/s^2."""
        self.proportional = proportional + self.integral * lag_s
        """K_p in 1/s."""
        self.derivative = proportional * lag_s
        """K_d without unit."""
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
        Take back what could not be carried out, `excess` in rad/s^2 of the last action.

        Back-calculation (Astrom and Hagglund) with the tracking time K_p/K_i.
        """
        self._integrated -= PERIOD_S * self.integral / self.proportional * excess
