"""Kalman filter that estimates the wear gain of the clutch while torque flows."""

from dataclasses import dataclass

import numpy as np

from ddct_controllers.mpc.observer import NoiseLevels
from ddct_controllers.mpc.transmission_model import (
    ENGINE_TORQUE,
    LOAD_TORQUE,
    MEASURED,
    REQUEST,
    STATES,
    TransmissionModel,
)

LOWEST_GAIN, HIGHEST_GAIN = 0.5, 1.5
"""Bounds of the estimate, beyond the 0.7 to 1.3 that a clutch is taken to reach."""
LEAST_TORQUE_N_M = 5.0
"""Below which the estimate rests; C_f may be wrong by as much anyway."""
_DRIVELINE = 4
_SIZE = _DRIVELINE + 2
_GAIN, _LOAD = _DRIVELINE, _DRIVELINE + 1


@dataclass(frozen=True)
class WearNoise:
    """What the filter believes of K_usura and of the load's error."""

    initial_gain: float = 0.2
    """Standard deviation of K_usura about 1 before the first measurement."""
    gain_drift: float = 0.01
    """Per period; within a second, an engagement, 0.1: the fade of a hot clutch."""
    load_drift_n_m: float = 47.0
    """Per period, of the error of C_load; the same as in the offset-free controllers."""


class WearObserver:
    """
    Time-varying Kalman filter of w_m, w_p, w_r, theta_sr, K_usura and the error of C_load.

    The actuator's torque follows from the requests alone, so it is known, and the clutch transmits
    K_usura times as much. Then K_usura enters the driveline's equations linearly, times a known
    signal: x+ = a x + K_usura g_k + b u, and the filter needs no linearisation. Its covariance
    tells how much each period says about K_usura: nothing without torque.
    """

    def __init__(
        self,
        model: TransmissionModel,
        noise: NoiseLevels,
        wear: WearNoise,
        halfshaft_stiffness: float,
        initial_request: float,
    ) -> None:
        """
        Take the model of a new clutch, without disturbances.

        Before the first measurement the half-shaft of `halfshaft_stiffness` in N m/rad balances
        the load and the actuator is at rest on `initial_request` in N m.
        """
        driveline, actuator = slice(_DRIVELINE), slice(_DRIVELINE, STATES)
        self._model = model
        self._wear = wear
        self._twist_per_torque = 1.0 / halfshaft_stiffness
        self._initial_request = initial_request
        self._transition = np.eye(_SIZE)
        self._transition[driveline, driveline] = model.a[driveline, driveline]
        self._transition[driveline, _LOAD] = model.b[driveline, LOAD_TORQUE]
        self._known = model.b[driveline, [ENGINE_TORQUE, LOAD_TORQUE]]
        self._transmission = model.a[driveline, actuator]
        self._actuator_a = model.a[actuator, actuator]
        self._actuator_b = model.b[actuator, REQUEST]
        self._process = _process_noise(model, noise, wear)
        self._measurement_noise = noise.speed_rad_s**2 * np.eye(MEASURED)
        self._measured = np.eye(MEASURED, _SIZE)
        self._identity = np.eye(_SIZE)
        self.reset()

    def reset(self) -> None:
        """Forget the estimate; the next measurement starts another one."""
        self._started = False
        self._state = np.zeros(_SIZE)
        self._state[_GAIN] = 1.0
        self._actuator = np.zeros(STATES - _DRIVELINE)
        self._covariance = np.zeros((_SIZE, _SIZE))
        self._covariance[_GAIN, _GAIN] = self._wear.initial_gain**2

    @property
    def wear_gain(self) -> float:
        """The estimate of K_usura; 1 before the first measurement."""
        return float(self._state[_GAIN])

    @property
    def wear_gain_deviation(self) -> float:
        """Standard deviation of the estimate by the filter's own account."""
        return float(np.sqrt(self._covariance[_GAIN, _GAIN]))

    def correct(self, speeds: tuple[float, float, float], load_torque: float) -> np.ndarray:
        """
        Return x_(k|k) divided by K_usura, (10,), for w_m, w_p, w_r in rad/s and C_load in N m.

        The last state is the error of C_load. Divided by K_usura, the driveline's states and what
        drives them obey the equations of a new clutch with the actuator's states as they are.
        """
        if self._started:
            self._update(speeds)
        else:
            self._start(speeds, load_torque)
        gain = self._state[_GAIN]
        return np.concatenate(
            (self._state[:_DRIVELINE] / gain, self._actuator, self._state[_LOAD:] / gain)
        )

    def predict(self, inputs: tuple[float, float, float]) -> None:
        """Advance by one period with the saturated request, C_m and C_load in N m."""
        request, engine_torque, load_torque = inputs
        transition = self._transition
        transition[:_DRIVELINE, _GAIN] = self._transmission @ self._actuator
        self._state = transition @ self._state
        self._state[:_DRIVELINE] += self._known @ (engine_torque, load_torque)
        self._covariance = transition @ self._covariance @ transition.T + self._process
        if self._actuator[-1] > LEAST_TORQUE_N_M:
            self._covariance[_GAIN, _GAIN] += self._wear.gain_drift**2
        self._actuator = self._actuator_a @ self._actuator + self._actuator_b * request

    def _start(self, speeds: tuple[float, float, float], load_torque: float) -> None:
        twist = load_torque * self._twist_per_torque
        start = self._model.at_rest(speeds, twist, self._initial_request)
        self._actuator = start[_DRIVELINE:]
        self._state[:_DRIVELINE] = start[:_DRIVELINE]
        # A second's drift of the load, which has twisted the half-shaft by as much.
        load = np.zeros(_SIZE)
        load[[_DRIVELINE - 1, _LOAD]] = self._twist_per_torque, 1.0
        load *= 10.0 * self._wear.load_drift_n_m
        self._covariance += np.outer(load, load)
        self._covariance[:MEASURED, :MEASURED] = self._measurement_noise
        self._started = True

    def _update(self, speeds: tuple[float, float, float]) -> None:
        covariance = self._covariance
        innovation = covariance[:MEASURED, :MEASURED] + self._measurement_noise
        gain = np.linalg.solve(innovation, covariance[:MEASURED]).T
        self._state = self._state + gain @ (speeds - self._state[:MEASURED])
        self._state[_GAIN] = min(max(self._state[_GAIN], LOWEST_GAIN), HIGHEST_GAIN)
        # Joseph's form: it stays symmetric and positive whatever is rounded.
        kept = self._identity - gain @ self._measured
        self._covariance = kept @ covariance @ kept.T + gain @ self._measurement_noise @ gain.T


def _process_noise(model: TransmissionModel, noise: NoiseLevels, wear: WearNoise) -> np.ndarray:
    """Return the covariance (6, 6) that a period adds, without the drift of K_usura."""
    torques = np.zeros((_SIZE, 3))
    torques[:_DRIVELINE, 0] = noise.engine_torque_n_m * model.b[:_DRIVELINE, ENGINE_TORQUE]
    torques[:_DRIVELINE, 1] = noise.load_torque_n_m * model.b[:_DRIVELINE, LOAD_TORQUE]
    torques[:_DRIVELINE, 2] = noise.clutch_torque_n_m * model.clutch[:_DRIVELINE]
    process = torques @ torques.T
    process[_LOAD, _LOAD] = wear.load_drift_n_m**2
    return process
