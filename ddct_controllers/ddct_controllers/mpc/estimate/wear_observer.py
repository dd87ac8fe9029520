"""Kalman filter that estimates the wear gain of the clutch while torque flows."""

import numpy as np

from ddct_controllers.interface import Status
from ddct_controllers.mpc.estimate.gains import NoiseLevels
from ddct_controllers.mpc.estimate.observer import AtRest
from ddct_controllers.mpc.estimate.wear_model import (
    CLUTCH_ERROR,
    DRIVELINE,
    GAIN,
    HIGHEST_GAIN,
    LOAD_ERROR,
    LOWEST_GAIN,
    SIZE,
    WearNoise,
    process_noise,
    within_bounds,
)
from ddct_controllers.mpc.model.transmission_model import (
    ENGINE_TORQUE,
    LOAD_TORQUE,
    MEASURED,
    REQUEST,
    STATES,
    TransmissionModel,
)

LEAST_TORQUE_N_M = 5.0
"""Torque of the actuator below which K_usura does not drift: C_f may be wrong by as much."""


class WearObserver:
    """
    Time-varying Kalman filter of w_m, w_p, w_r, theta_sr, K_usura and the errors of C_f, C_load.

    The actuator's torque follows from the requests alone, so it is known, and the clutch transmits
    K_usura times as much. Then K_usura enters the driveline's equations linearly, times a known
    signal: x+ = a x + K_usura g_k + b u + b_d d, and the filter needs no linearisation. Its
    covariance tells how much each period says about K_usura: nothing without torque. A constant
    torque does not tell K_usura from an error of C_f, so the latter drifts only while a bound
    holds the former.
    """

    def __init__(
        self,
        model: TransmissionModel,
        noise: NoiseLevels,
        wear: WearNoise,
        start: AtRest,
    ) -> None:
        """Take the `offset_free_model` of a new clutch, and how the estimate starts."""
        driveline, actuator = slice(DRIVELINE), slice(DRIVELINE, STATES)
        self._model = model
        self._wear = wear
        self._initial_request = start.initial_request
        self._twist_per_torque = 1.0 / start.halfshaft_stiffness
        self._transition = np.eye(SIZE)
        self._transition[driveline, driveline] = model.a[driveline, driveline]
        self._transition[driveline, CLUTCH_ERROR:] = model.a[driveline, STATES:]
        self._known = model.b[driveline, [ENGINE_TORQUE, LOAD_TORQUE]]
        self._transmission = model.a[driveline, actuator]
        self._actuator_a = model.a[actuator, actuator]
        self._actuator_b = model.b[actuator, REQUEST]
        self._process = process_noise(model, noise, wear)
        self._measurement_noise = noise.speed_rad_s**2 * np.eye(MEASURED)
        self.reset()

    def reset(self) -> None:
        """Forget the estimate; the next measurement starts another one."""
        self._started = False
        self._state = np.zeros(SIZE)
        self._state[GAIN] = 1.0
        self._actuator = np.zeros(STATES - DRIVELINE)
        self._covariance = np.zeros((SIZE, SIZE))
        self._covariance[GAIN, GAIN] = self._wear.initial_gain**2

    @property
    def wear_gain(self) -> float:
        """The estimate of K_usura; 1 before the first measurement."""
        return float(self._state[GAIN])

    @property
    def wear_gain_deviation(self) -> float:
        """Standard deviation of the estimate by the filter's own account."""
        return float(np.sqrt(self._covariance[GAIN, GAIN]))

    @property
    def wear_gain_at_bound(self) -> bool:
        """Whether a bound holds the estimate, so that the error of C_f has the rest."""
        return self.wear_gain in (LOWEST_GAIN, HIGHEST_GAIN)

    @property
    def status(self) -> Status:
        """The estimate, its standard deviation and whether a bound holds it."""
        return (
            ('wear_gain_estimate', repr(self.wear_gain)),
            ('wear_gain_deviation', repr(self.wear_gain_deviation)),
            ('wear_gain_at_bound', str(self.wear_gain_at_bound).lower()),
        )

    def correct(self, speeds: tuple[float, float, float], load_torque: float) -> np.ndarray:
        """
        Return x_(k|k) divided by K_usura, (11,), for w_m, w_p, w_r in rad/s and C_load in N m.

        The last states are the errors of C_f and C_load. Divided by K_usura, the driveline's
        states and what drives them obey the equations of a new clutch with the actuator's states
        as they are.
        """
        if self._started:
            self._update(speeds)
        else:
            self._start(speeds, load_torque)
        gain = self._state[GAIN]
        return np.concatenate(
            (self._state[:DRIVELINE] / gain, self._actuator, self._state[CLUTCH_ERROR:] / gain)
        )

    def predict(self, inputs: tuple[float, float, float]) -> None:
        """Advance by one period with the saturated request, C_m and C_load in N m."""
        request, engine_torque, load_torque = inputs
        transition = self._transition
        effect = self._transmission @ self._actuator
        transition[:DRIVELINE, GAIN] = effect
        self._state = transition @ self._state
        self._state[:DRIVELINE] += self._known @ (engine_torque, load_torque)
        self._covariance = transition @ self._covariance @ transition.T + self._process
        # The constant torque of a new clutch that would change w_m as much.
        if effect[0] / self._model.clutch[0] > LEAST_TORQUE_N_M:
            self._covariance[GAIN, GAIN] += self._wear.gain_drift**2
        if self.wear_gain_at_bound:
            self._covariance[CLUTCH_ERROR, CLUTCH_ERROR] += self._wear.clutch_drift_n_m**2
        self._actuator = self._actuator_a @ self._actuator + self._actuator_b * request

    def _start(self, speeds: tuple[float, float, float], load_torque: float) -> None:
        twist = load_torque * self._twist_per_torque
        start = self._model.at_rest(speeds, twist, self._initial_request)
        self._actuator = start[DRIVELINE:STATES]
        self._state[:DRIVELINE] = start[:DRIVELINE]
        # A second's drift of the load, which has twisted the half-shaft by as much.
        load = np.zeros(SIZE)
        load[[DRIVELINE - 1, LOAD_ERROR]] = self._twist_per_torque, 1.0
        load *= 10.0 * self._wear.load_drift_n_m
        self._covariance += np.outer(load, load)
        self._covariance[:MEASURED, :MEASURED] = self._measurement_noise
        self._started = True

    def _update(self, speeds: tuple[float, float, float]) -> None:
        covariance = self._covariance
        innovation = covariance[:MEASURED, :MEASURED] + self._measurement_noise
        gain = np.linalg.solve(innovation, covariance[:MEASURED]).T
        self._state = self._state + gain @ (speeds - self._state[:MEASURED])
        # Joseph's form: it stays symmetric and positive whatever is rounded.
        kept = np.eye(SIZE)
        kept[:, :MEASURED] -= gain
        self._covariance = kept @ covariance @ kept.T + gain @ self._measurement_noise @ gain.T
        self._state = within_bounds(self._state, self._covariance)
