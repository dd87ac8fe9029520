# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Observer of the states that are not measured, with a constant gain; design of that gain."""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ddct_controllers.interface import Status
from ddct_controllers.mpc.model.transmission_model import (
    ENGINE_TORQUE,
    LOAD_TORQUE,
    MEASURED,
    SLIP_SPEED,
    TransmissionModel,
)
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.models.clutch import FrictionParameters
from ddct_plant.models.parameters import VehicleParameters
from ddct_plant.scenario.scenario import Scenario

OF_CLUTCH = '0.3 times 6/7 `friction.most_n_m`, over the root of 50, in whole N m'
OF_LOAD = 'a tenth of the load of a 10 % slope, in whole N m'
"""Defaults of both drifts on pages."""
WORN, RISE_S = 0.3, 0.5
"""Wear of a clutch, and time in s in which C_f rises to `working_torque` in an engagement."""
GRADE, UPHILL_S = 0.1, 1.0
"""Slope of a road as a grade, and time in s in which a car gets onto it."""


def clutch_drift(friction: FrictionParameters) -> float:
    """
    Return the drift of the error of C_f per period, in whole N m.

    A random walk reaches it times the root of the number of periods: that of a clutch worn by 0.3
    is wrong by 0.3 of its working torque when C_f has risen to that, after half a second.
    """
    return float(round(WORN * friction.working_torque / math.sqrt(RISE_S / PERIOD_S)))


def load_drift(vehicle: VehicleParameters) -> float:
    """
    Return the drift of the error of C_load per period, in whole N m.

    In a second it reaches m g r_w sin(alpha), the load of a slope of 10 %.
    """
    weight = vehicle.mass_kg * vehicle.gravity_m_s2
    load = weight * vehicle.wheel_radius_m * math.sin(math.atan(GRADE))
    return float(round(load / math.sqrt(UPHILL_S / PERIOD_S)))


class Drifts(NamedTuple):
    """Drifts of both errors in N m per period."""

    clutch: float
    """That of C_f."""
    load: float
    """That of C_load."""

    @classmethod
    def of(
        cls, scenario: Scenario, clutch: float | None = None, load: float | None = None
    ) -> 'Drifts':
        """Return given drifts in N m, and where there are none those of the scenario's car."""
        return cls(
            clutch_drift(scenario.friction) if clutch is None else clutch,
            load_drift(scenario.vehicle) if load is None else load,
        )


@dataclass(frozen=True)
class NoiseLevels:
    """Standard deviations of noise and drift, from which the gain of the filter follows."""

    speed_rad_s: float = 0.05
    """Noise of each measured speed in rad/s: about the resolution of a wheel-speed sensor."""
    engine_torque_n_m: float = 2.0
    """Deviation of C_m from its known value in N m."""
    clutch_torque_n_m: float = 5.0
    """Deviation of C_f from the torque of the actuator's model in N m."""
    load_torque_n_m: float = 20.0
    """Deviation of C_load from its computed value in N m."""
    drift: tuple[float, ...] = ()
    """Drift per period of each estimated disturbance, in its unit."""


def torque_noise(model: TransmissionModel, noise: NoiseLevels) -> np.ndarray:
    """Return the covariance (n, n) that a period adds, from torque noise held over it."""
    torques = np.column_stack(
        [
            noise.engine_torque_n_m * model.b[:, ENGINE_TORQUE],
            noise.load_torque_n_m * model.b[:, LOAD_TORQUE],
            noise.clutch_torque_n_m * model.clutch,
        ]
    )
    return torques @ torques.T


@lru_cache  # runs with equal known settings share one
def kalman_gain(model: TransmissionModel, noise: NoiseLevels) -> np.ndarray:
    """
    Return the stationary filter gain (n, 3) of p c' (c p c' + r)^-1.

    p solves the filter's algebraic Riccati equation. Torque noise enters as held over a period;
    raise ParameterError when no stationary gain exists.
    """
    if len(noise.drift) != model.disturbances:
        raise ParameterError(
            f'observer: {len(noise.drift)} drifts given for {model.disturbances} disturbances: '
            'give one for each',
            key='drifts',
        )
    process = torque_noise(model, noise)
    process[model.transmission :, model.transmission :] += np.diag(np.square(noise.drift))
    measured = np.eye(MEASURED, len(model.a))
    error = noise.speed_rad_s**2 * np.eye(MEASURED)
    complaint = f'observer: no stationary Kalman gain for {noise} (%s): give positive levels'
    covariance = riccati(model.a.T, measured.T, process, error, complaint)
    innovation = measured @ covariance @ measured.T + error
    return np.linalg.solve(innovation, measured @ covariance).T


@lru_cache
def unit_noise_gain(model: TransmissionModel, noise_rpm: float = 1.0) -> np.ndarray:
    """
    Return the stationary filter gain (n, 3) for w_d in rpm as the only measured output.

    It is that of the filter that the MPC Toolbox gives an MPC without further options. By default
    the toolbox's estimator assumes white noise of unit variance on each manipulated variable and
    measured disturbance, held over a period, and on each measured output:

        x_(k+1) = a x_k + b (u_k + w_k), y_k = c x_k + v_k, E[w w'] = I, E[v v'] = 1.

    So its Kalman filter has Q = b b' (1 N m on C_f, C_m and, where it is known, C_load) and R = 1
    (1 rpm on w_d, `noise_rpm`), and l = p c' (c p c' + R)^-1 with

        p = a p a' - a p c' (c p c' + R)^-1 c p a' + Q.

    The integrator that it would add to the output is dropped: C_m to w_d is an integrator already,
    P_1 = 4/s, and of two that act on one output only the sum is observable.

    l acts on the error of w_d, which is [1, -1, 0] times that of w_m, w_p and w_r. Raise
    ParameterError when there is no stationary gain.
    """
    output = rpm_from_rad_s(1.0) * model.c[SLIP_SPEED : SLIP_SPEED + 1]
    noise = noise_rpm**2 * np.eye(1)
    complaint = (
        'observer: no stationary Kalman gain of w_d for this driveline (%s): measure the speeds'
    )
    covariance = riccati(model.a.T, output.T, model.b @ model.b.T, noise, complaint)
    gain = covariance @ output.T / (output @ covariance @ output.T + noise)
    return gain @ output[:, :MEASURED]


def riccati(
    a: np.ndarray, b: np.ndarray, q: np.ndarray, r: np.ndarray, complaint: str
) -> np.ndarray:
    """
    Return the stabilising solution p of p = a' p a - a' p b (b' p b + r)^-1 b' p a + q.

    Without one raise ParameterError with the text `complaint`, whose %s is the reason.
    """
    # Imported here: only runs with such a gain need it.
    from scipy.linalg import solve_discrete_are

    try:
        return solve_discrete_are(a, b, q, r)
    except (np.linalg.LinAlgError, ValueError) as failure:
        raise ParameterError(complaint % failure) from failure


@dataclass(frozen=True)
class AtRest:
    """Start of an estimate: speeds as measured, half-shaft and actuator at rest."""

    halfshaft_stiffness: float
    """
    Stiffness in N m/rad of the half-shaft, which balances the load; inf if the load is unknown.
    """
    initial_request: float
    """Clutch torque request in N m at which the actuator rests."""


class Observer:
    """
    x_(k|k) = x_(k|k-1) + l ((w_m, w_p, w_r)_k - x_(k|k-1)[:3]), x_(k+1|k) = a x_(k|k) + b u_k.

    The constant gain l selects the measured signals and weighs them against the model. The clutch
    is taken for a new one.
    """

    wear_gain = 1.0
    """Estimated K_usura, without unit, by which the states of the driveline are divided."""
    status: Status = ()
    """Pairs (key, value) of the estimate for `controller/status`."""

    def __init__(self, model: TransmissionModel, gain: np.ndarray, start: AtRest | None) -> None:
        """Take the gain (n, 3) and the start of the estimate; without one it starts at zero."""
        self.model, self.gain, self.start = model, gain, start
        self.reset()

    def at_rest(
        self, start: AtRest, speeds: tuple[float, float, float], load_torque: float
    ) -> np.ndarray:
        """Return x_(k|k), (n,), at the first measurement; speeds in rad/s, C_load in N m."""
        twist = load_torque / start.halfshaft_stiffness
        return self.model.at_rest(speeds, twist, start.initial_request)

    def reset(self) -> None:
        """Clear the estimate; the next measurement starts another one."""
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
