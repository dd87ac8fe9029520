# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Kalman filter that estimates the wear gain of the clutch while torque flows."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ddct_controllers.interface import Status
from ddct_controllers.mpc.estimate.observer import (
    OF_CLUTCH,
    OF_LOAD,
    AtRest,
    Drifts,
    NoiseLevels,
    torque_noise,
)
from ddct_controllers.mpc.estimate.wear_state import (
    CLUTCH_ERROR,
    FILTER_STATES,
    GAIN,
    HIGHEST_GAIN,
    LOAD_ERROR,
    LOWEST_GAIN,
    SIZE,
    within_bounds,
)
from ddct_controllers.mpc.model.transmission_model import (
    DRIVELINE,
    ENGINE_TORQUE,
    LOAD_TORQUE,
    MEASURED,
    REQUEST,
    TransmissionModel,
)
from ddct_controllers.mpc.program.settings import MOST
from ddct_plant.base.options import OptionGroup, option

ENGINE_SPEED, TWIST = FILTER_STATES.places('engine_speed', 'twist')
LEAST_TORQUE_N_M = 5.0
"""Actuator torque in N m below which K_usura does not drift: C_f may be wrong by as much."""
MOST_TORQUE_N_M = MOST
"""
Largest request in N m that the filter takes as the actuator's torque.

No clutch carries a thousandth of it, but a loop that diverges soon requests 1e11 N m. With so much
known torque P loses the digits of the measurement's noise, and then has no gain.
"""


@dataclass(frozen=True)
class WearNoise(OptionGroup):
    """Standard deviations of the filter; a scenario may change the drifts per period."""

    initial_gain: float = 0.2
    """Deviation of K_usura from 1 before the first measurement, without unit."""
    gain_drift: float = option(
        0.01,  # 0.1 within a second, an engagement: the fade of a hot clutch
        'drift of K_usura per period; the bounds of its estimate are 0.5 and 1.5',
        at_least=0.0,
        at_most=1.0,
    )
    clutch_drift_n_m: float | None = option(
        None,
        'drift of the error of C_f per period while a bound holds K_usura; 0 leaves a slip '
        'error there',
        'N m',
        otherwise=OF_CLUTCH,
        at_least=0.0,
        at_most=MOST,
    )
    load_drift_n_m: float | None = option(
        None,
        'drift of the error of C_load per period',
        'N m',
        otherwise=OF_LOAD,
        at_least=0.0,
        at_most=MOST,
    )


@dataclass(frozen=True, eq=False)
class WearFilter:
    """Matrices, variances and start of the filter, constant over a run."""

    transition: np.ndarray
    """Transition of the state but for the torque of the clutch, which K_usura multiplies."""
    known: np.ndarray
    """Effect of C_m and C_load on the driveline, (4, 2)."""
    transmission: np.ndarray
    """Effect of the actuator's states on the driveline, (4, actuator states)."""
    at_once: np.ndarray
    """The same of the request, (4,)."""
    actuator_a: np.ndarray
    actuator_b: np.ndarray
    """Transition of the actuator's states, and the effect of the request on them."""
    process: np.ndarray
    """Covariance that each period adds, (SIZE, SIZE)."""
    measurement_noise: np.ndarray
    """Covariance of the measured speeds, (3, 3)."""
    gain_variance: float
    """Variance that a period with torque adds to K_usura."""
    clutch_variance: float
    """Variance that a period with K_usura at a bound adds to the error of C_f."""
    clutch_effect: float
    """Change of w_m by a constant torque of a new clutch, in rad/s per N m."""
    twist_per_torque: float
    """Twist of the half-shaft by C_load at rest, in rad per N m."""
    actuator_at_rest: np.ndarray
    """States of the actuator before the first measurement."""
    first_covariance: np.ndarray
    """Covariance of the state at the first measurement, (SIZE, SIZE)."""


@lru_cache  # runs with equal known settings share one
def wear_filter(
    model: TransmissionModel,
    noise: NoiseLevels,
    wear: WearNoise,
    drifts: Drifts,
    start: AtRest,
) -> WearFilter:
    """Return the filter of an `offset_free_model` of a new clutch, and of the start."""
    driveline, actuator = DRIVELINE, slice(DRIVELINE.stop, model.transmission)
    transition = np.eye(SIZE)
    transition[driveline, driveline] = model.a[driveline, driveline]
    transition[driveline, CLUTCH_ERROR:] = model.a[driveline, model.transmission :]
    process = np.zeros((SIZE, SIZE))
    process[driveline, driveline] = torque_noise(model, noise)[driveline, driveline]
    process[LOAD_ERROR, LOAD_ERROR] = drifts.load**2
    measurement_noise = noise.speed_rad_s**2 * np.eye(MEASURED)
    twist_per_torque = 1.0 / start.halfshaft_stiffness
    # A second's drift of the load, which has twisted the half-shaft by as much.
    load = np.zeros(SIZE)
    load[[TWIST, LOAD_ERROR]] = twist_per_torque, 1.0
    load *= 10.0 * drifts.load
    first_covariance = np.outer(load, load)
    first_covariance[GAIN, GAIN] = wear.initial_gain**2
    first_covariance[:MEASURED, :MEASURED] = measurement_noise
    return WearFilter(
        transition=transition,
        known=model.b[driveline, [ENGINE_TORQUE, LOAD_TORQUE]],
        transmission=model.a[driveline, actuator],
        at_once=model.b[driveline, REQUEST],
        actuator_a=model.a[actuator, actuator],
        actuator_b=model.b[actuator, REQUEST],
        process=process,
        measurement_noise=measurement_noise,
        gain_variance=wear.gain_drift**2,
        clutch_variance=drifts.clutch**2,
        clutch_effect=float(model.clutch[ENGINE_SPEED]),
        twist_per_torque=twist_per_torque,
        actuator_at_rest=model.at_rest((0.0, 0.0, 0.0), 0.0, start.initial_request)[actuator],
        first_covariance=first_covariance,
    )


class WearObserver:
    """
    Time-varying Kalman filter of w_m, w_p, w_r, theta_sr, K_usura and the errors of C_f, C_load.

    The actuator's torque follows from the requests alone, so it is a known signal, and the clutch
    transmits K_usura times as much. Then K_usura enters the driveline's equations linearly, times
    that signal: x+ = a x + K_usura g_k + b u + b_d d, and the filter needs no linearisation. Its
    covariance contains how much each period informs about K_usura: nothing without torque. Under a
    constant torque K_usura and an error of C_f have the same effect, so the latter drifts only
    while a bound limits the former.
    """

    def __init__(
        self,
        model: TransmissionModel,
        noise: NoiseLevels,
        wear: WearNoise,
        drifts: Drifts,
        start: AtRest,
    ) -> None:
        """Take the `offset_free_model` of a new clutch, and the start of the estimate."""
        self.filter = wear_filter(model, noise, wear, drifts, start)
        """What is constant over a run."""
        self._transition = self.filter.transition.copy()
        self.reset()

    def reset(self) -> None:
        """Clear the estimate; the next measurement starts another one."""
        self._started = False
        self._state = np.zeros(SIZE)
        self._state[GAIN] = 1.0
        self._actuator = self.filter.actuator_at_rest
        self._covariance = self.filter.first_covariance

    @property
    def wear_gain(self) -> float:
        """Estimate of K_usura, without unit; 1 before the first measurement."""
        return float(self._state[GAIN])

    @property
    def wear_gain_deviation(self) -> float:
        """Standard deviation of the estimate of K_usura, from the filter's covariance."""
        return float(np.sqrt(self._covariance[GAIN, GAIN]))

    @property
    def wear_gain_at_bound(self) -> bool:
        """Whether the estimate is at a bound, so that the rest is in the error of C_f."""
        return self.wear_gain in (LOWEST_GAIN, HIGHEST_GAIN)

    @property
    def status(self) -> Status:
        """Pairs (key, value): estimate, standard deviation, and whether it is at a bound."""
        return (
            ('wear_gain_estimate', repr(self.wear_gain)),
            ('wear_gain_deviation', repr(self.wear_gain_deviation)),
            ('wear_gain_at_bound', str(self.wear_gain_at_bound).lower()),
        )

    def correct(self, speeds: tuple[float, float, float], load_torque: float) -> np.ndarray:
        """
        Return x_(k|k) divided by K_usura, (n,), for w_m, w_p, w_r in rad/s and C_load in N m.

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
            (self._state[DRIVELINE] / gain, self._actuator, self._state[CLUTCH_ERROR:] / gain)
        )

    def predict(self, inputs: tuple[float, float, float]) -> None:
        """Advance by one period with the saturated request, C_m and C_load in N m."""
        request, engine_torque, load_torque = inputs
        request = min(request, MOST_TORQUE_N_M)
        own, transition = self.filter, self._transition
        effect = own.transmission @ self._actuator + own.at_once * request
        transition[DRIVELINE, GAIN] = effect
        self._state = transition @ self._state
        self._state[DRIVELINE] += own.known @ (engine_torque, load_torque)
        self._covariance = transition @ self._covariance @ transition.T + own.process
        # The constant torque of a new clutch that would change w_m as much.
        if effect[ENGINE_SPEED] / own.clutch_effect > LEAST_TORQUE_N_M:
            self._covariance[GAIN, GAIN] += own.gain_variance
        if self.wear_gain_at_bound:
            self._covariance[CLUTCH_ERROR, CLUTCH_ERROR] += own.clutch_variance
        self._actuator = own.actuator_a @ self._actuator + own.actuator_b * request

    def _start(self, speeds: tuple[float, float, float], load_torque: float) -> None:
        self._state[:MEASURED] = speeds
        self._state[TWIST] = load_torque * self.filter.twist_per_torque
        self._started = True

    def _update(self, speeds: tuple[float, float, float]) -> None:
        covariance, noise = self._covariance, self.filter.measurement_noise
        innovation = covariance[:MEASURED, :MEASURED] + noise
        gain = np.linalg.solve(innovation, covariance[:MEASURED]).T
        self._state = self._state + gain @ (speeds - self._state[:MEASURED])
        # Joseph's form: it stays symmetric and positive whatever is rounded.
        kept = np.eye(SIZE)
        kept[:, :MEASURED] -= gain
        self._covariance = kept @ covariance @ kept.T + gain @ noise @ gain.T
        self._state = within_bounds(self._state, self._covariance)
