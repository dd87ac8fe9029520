"""Observer of the states that are not measured, and the Kalman gain for three speeds."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ddct_controllers.mpc.model.transmission_model import (
    ENGINE_TORQUE,
    LOAD_TORQUE,
    MEASURED,
    STATES,
    TransmissionModel,
)
from ddct_plant.base.errors import ParameterError


@dataclass(frozen=True)
class NoiseLevels:
    """Standard deviations that set how far the filter trusts its model and the measurements."""

    speed_rad_s: float = 0.05
    """Of each measured speed; about the resolution of a wheel-speed sensor."""
    engine_torque_n_m: float = 2.0
    """Of C_m about its known value."""
    clutch_torque_n_m: float = 5.0
    """Of C_f about what the actuator's model gives."""
    load_torque_n_m: float = 20.0
    """Of C_load about its computed value."""
    drift: tuple[float, ...] = ()
    """Per period, of each estimated disturbance, in its unit."""


class StateEstimator(Protocol):
    """What a predictive controller needs of an observer."""

    def reset(self) -> None:
        """Forget the estimate; the next measurement starts another one."""

    def correct(self, speeds: tuple[float, float, float], load_torque: float) -> np.ndarray:
        """Return x_(k|k), (n,), for w_m, w_p, w_r in rad/s and C_load in N m."""

    def predict(self, inputs: tuple[float, float, float]) -> None:
        """Advance by one period with the saturated request, C_m and C_load in N m."""


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

    What is measured, and how far it is trusted, is all in the constant gain l.
    """

    def __init__(self, model: TransmissionModel, gain: np.ndarray, start: AtRest | None) -> None:
        """Take the gain (n, 3), and how the estimate starts; None starts it at zero."""
        self._model = model
        self._a, self._b = model.a, model.b
        self._gain = gain
        self._start = start
        self.reset()

    @property
    def model(self) -> TransmissionModel:
        """The model that it follows."""
        return self._model

    @property
    def gain(self) -> np.ndarray:
        """l, (n, 3)."""
        return self._gain

    @property
    def start(self) -> AtRest | None:
        """How the estimate starts."""
        return self._start

    def at_rest(
        self, start: AtRest, speeds: tuple[float, float, float], load_torque: float
    ) -> np.ndarray:
        """Return x_(k|k), (n,), at the first measurement; speeds in rad/s, C_load in N m."""
        twist = load_torque / start.halfshaft_stiffness
        return self._model.at_rest(speeds, twist, start.initial_request)

    def reset(self) -> None:
        """Forget the estimate; the next measurement starts another one."""
        self._started = self._start is None
        self._state = np.zeros(len(self._a))

    def correct(self, speeds: tuple[float, float, float], load_torque: float) -> np.ndarray:
        """Return x_(k|k), (n,), for w_m, w_p, w_r in rad/s and C_load in N m."""
        if not self._started and self._start is not None:
            self._state = self.at_rest(self._start, speeds, load_torque)
            self._started = True
        else:
            self._state = self._state + self._gain @ (speeds - self._state[:MEASURED])
        return self._state

    def predict(self, inputs: tuple[float, float, float]) -> None:
        """Advance by one period with the saturated request, C_m and C_load in N m."""
        self._state = self._a @ self._state + self._b @ inputs


def kalman_gain(model: TransmissionModel, noise: NoiseLevels) -> np.ndarray:
    """
    Return the stationary filter gain (n, 3) of p c' (c p c' + r)^-1.

    p solves the filter's algebraic Riccati equation. Torque noise enters as held over a period;
    raise ParameterError when no stationary gain exists.
    """
    # Imported here: only runs with an observer need it.
    from scipy.linalg import solve_discrete_are

    size = len(model.a)
    if len(noise.drift) != model.disturbances:
        raise ParameterError(
            f'observer: {len(noise.drift)} drifts given for {model.disturbances} disturbances: '
            'give one for each'
        )
    torque = np.zeros((size, 3))
    torque[:, 0] = noise.engine_torque_n_m * model.b[:, ENGINE_TORQUE]
    torque[:, 1] = noise.load_torque_n_m * model.b[:, LOAD_TORQUE]
    torque[:, 2] = noise.clutch_torque_n_m * model.clutch
    process = torque @ torque.T
    process[STATES:, STATES:] += np.diag(np.square(noise.drift))
    measured = np.eye(MEASURED, size)
    error = noise.speed_rad_s**2 * np.eye(MEASURED)
    try:
        covariance = solve_discrete_are(model.a.T, measured.T, process, error)
    except (np.linalg.LinAlgError, ValueError) as failure:
        raise ParameterError(
            f'observer: no stationary Kalman gain for {noise} ({failure}): give positive levels'
        ) from failure
    innovation = measured @ covariance @ measured.T + error
    gain: np.ndarray = np.linalg.solve(innovation, measured @ covariance).T
    return gain
