"""PID control of a speed, from its error to an acceleration, with gains by pole placement."""

from dataclasses import dataclass

from ddct_plant.base.timebase import PERIOD_S


@dataclass(frozen=True)
class PidGains:
    """K_p in 1/s, K_i in 1/s^2, K_d without unit."""

    proportional: float
    integral: float
    derivative: float = 0.0


def placed_gains(bandwidth_rad_s: float, lag_s: float = 0.0) -> PidGains:
    """
    Return the gains for a speed that follows its acceleration command after a lag.

    Without lag the plant is 1/s, and K_p = 2 w, K_i = w^2 put both closed-loop poles at -w. The
    series form (K_p + K_i/s)(1 + lag s) cancels a first-order lag in front of it.
    """
    proportional, integral = 2.0 * bandwidth_rad_s, bandwidth_rad_s**2
    return PidGains(proportional + integral * lag_s, integral, proportional * lag_s)


class Pid:
    """u_k = K_p e_k + K_d (e_k - e_(k-1))/T + i_k, i_(k+1) = i_k + K_i T e_k."""

    def __init__(self, gains: PidGains) -> None:
        """Start without memory."""
        self._gains = gains
        self.reset()

    def reset(self) -> None:
        """Empty the integral; the next error has no derivative."""
        self._integral = 0.0
        self._last_error: float | None = None

    def update(self, error: float) -> float:
        """Return the acceleration in rad/s^2 for an error in rad/s."""
        gains = self._gains
        change = 0.0 if self._last_error is None else error - self._last_error
        self._last_error = error
        action = gains.proportional * error + gains.derivative * change / PERIOD_S + self._integral
        self._integral += gains.integral * PERIOD_S * error
        return action

    def unwind(self, excess: float) -> None:
        """
        Take back what could not be carried out, `excess` in rad/s^2 of the last action.

        Back-calculation (Astrom and Hagglund) with the tracking time K_p/K_i.
        """
        self._integral -= PERIOD_S * self._gains.integral / self._gains.proportional * excess
