# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Estimate of what the on-coming clutch carries while the off-going one is locked."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.sampling import hold_inputs
from ddct_plant.models.actuator import Actuator, ActuatorParameters
from ddct_plant.models.gearbox import EngagedGear
from ddct_plant.shift.gear_pair import GearPair

SPEED_NOISE_RAD_S = 0.1
"""Standard deviation of the measured w_m."""
WHEEL_NOISE_RAD_S = 0.05
"""Standard deviation of the speed of the wheels out of V_x, twice that of a coarse V_x."""
ENGINE_TORQUE_NOISE_N_M = 1.0
"""Standard deviation of C_m per period."""
LOAD_DRIFT_N_M = 2.0
"""Drift of the error of C_load per period."""
FIRST_TWIST_RAD = 0.3
"""Standard deviation of the first twist of the half-shafts."""
FIRST_LOAD_N_M = 100.0
"""Standard deviation of the error of C_load at the first step."""
FIRST_GAIN = 1.0
"""Standard deviation of the wear gain from 1: so wide that the estimate does not lean to 1."""
FIRST_OFFSET_N_M = 10.0
"""Standard deviation of the offset, which the kiss point of a hot clutch makes."""
DELAY_SPREAD_S = 0.005
"""Standard deviation of the delay in s of an actuator beyond that of its model."""
LEAST_GAIN, MOST_GAIN = 0.5, 1.6
"""Bounds of the wear gain that a request is made for."""
CARRIES_FROM_N_M = 0.5
"""Torque of the actuator from which the clutch carries the offset."""
ENGINE, WHEEL, TWIST, LOAD, GAIN, OFFSET, DELAY = range(7)
"""Places of the states of the filter."""


@dataclass(frozen=True)
class OnComingModel:
    """
    The driveline with both gears engaged and a locked off-going clutch, sampled.

    Engine and gearbox then turn as one. With their inertia J = J_m tau_i^2 + J_p (tau_i^2 +
    tau_j^2) at the wheels, and damping c likewise, J dw_g/dt = tau_i C_m - (tau_i - tau_j) C_2 -
    C_s - c w_g (docs/develop/gear_shift.md). Its states are w_g, w_r, theta and the error of
    C_load, its inputs C_m, C_2 and C_load.
    """

    gear: EngagedGear
    """Off-going gear."""
    stiffness: float
    """k_sa in N m/rad."""
    delay_s: float
    """Delay in s of the measured w_m."""
    step: np.ndarray
    """Matrix (4, 4) from the states to those a period later."""
    held: np.ndarray
    """Matrix (4, 3) from the held inputs to the states a period later."""
    measured: np.ndarray
    """Matrix (2, 7) from all states of the filter to the speeds of engine and wheels."""
    measured_load: float
    """Share of C_load in the measured speed of the wheels, rad/s per N m."""
    drift: np.ndarray
    """Covariance (7, 7) that a period adds."""
    noise: np.ndarray
    """Covariance (2, 2) of the measured speeds."""

    @classmethod
    def of(cls, gears: GearPair, delay_s: float, vehicle_delay_s: float) -> Self:
        """Sample the model of the gears; w_m and V_x are measured with these delays in s."""
        p, off_going, on_coming = gears.on_coming, gears.off_going, gears.on_coming.gear
        # Inertia and damping of the shafts at the wheels, per unit at a shaft.
        one, other = (gear.wheel_torque(gear.shaft_speed(1.0)) for gear in (off_going, on_coming))
        inertia = p.engine_inertia * one + p.shaft_inertia * (one + other)
        damping = p.engine_damping * one + p.shaft_damping * (one + other)
        stiffness, shafts, vehicle = p.halfshaft_stiffness, p.halfshaft_damping, p.vehicle_inertia
        a, b = np.zeros((4, 4)), np.zeros((4, 3))
        a[ENGINE, :3] = -(damping + shafts) / inertia, shafts / inertia, -stiffness / inertia
        a[WHEEL] = shafts / vehicle, -shafts / vehicle, stiffness / vehicle, -1.0 / vehicle
        a[TWIST, :2] = 1.0, -1.0
        of_engine, of_clutch = off_going.wheel_torque(1.0), on_coming.wheel_torque(1.0)
        b[ENGINE, :2] = of_engine / inertia, (of_clutch - of_engine) / inertia
        b[WHEEL, 2] = -1.0 / vehicle
        later_s = vehicle_delay_s - delay_s
        measured = np.eye(2, 7)
        measured[1, :4] -= later_s * a[WHEEL]
        step, held = hold_inputs(a, b, PERIOD_S)
        by_engine = ENGINE_TORQUE_NOISE_N_M * held[:, 0]
        drift = np.zeros((7, 7))
        drift[:4, :4] = np.outer(by_engine, by_engine)
        drift[LOAD, LOAD] += LOAD_DRIFT_N_M**2
        noise = np.diag([off_going.wheel_speed(SPEED_NOISE_RAD_S) ** 2, WHEEL_NOISE_RAD_S**2])
        load = -later_s * b[WHEEL, 2]
        return cls(off_going, stiffness, delay_s, step, held, measured, load, drift, noise)


class OnComingEstimate:
    """
    Kalman filter of `OnComingModel` for what the on-coming clutch carries.

    The torque C_s of the half-shafts follows from the speeds, so C_2 = g f + d - g t df/dt follows
    from w_m: f is the mean torque of the actuator's model, g the wear gain, d an offset, and t the
    delay of the torque in w_m. The states are those of the model, g, d and g t. f is known, so the
    filter is linear with known coefficients that change with time. All of them are those of the
    time of the measured w_m. Where V_x is late by T more, it is compared with w_r - T dw_r/dt.
    """

    def __init__(self, model: OnComingModel, actuator: ActuatorParameters) -> None:
        """Start with the actuator at rest on a request of zero."""
        self._model = model
        self._actuator, self._torque, self._load = Actuator(0.0, actuator), 0.0, 0.0
        self._states, self._spread = np.zeros(7), np.zeros((7, 7))

    @property
    def wear_gain(self) -> float:
        """Estimate of the wear gain, within the bounds for requests."""
        return min(max(float(self._states[GAIN]), LEAST_GAIN), MOST_GAIN)

    @property
    def offset(self) -> float:
        """Estimate of the offset in N m."""
        return float(self._states[OFFSET])

    def start(self, engine_speed: float, wheel_speed: float, engine_torque: float) -> None:
        """Take the first w_m and wheel speed in rad/s, and C_m in N m; called before all else."""
        first = np.array([self._model.gear.wheel_speed(engine_speed), wheel_speed])
        twist = self._model.gear.wheel_torque(engine_torque) / self._model.stiffness
        self._states = np.array([*first, twist, 0.0, 1.0, 0.0, self._model.delay_s])
        deviations = FIRST_TWIST_RAD, FIRST_LOAD_N_M, FIRST_GAIN, FIRST_OFFSET_N_M, DELAY_SPREAD_S
        self._spread = np.diag([*np.diag(self._model.noise), *np.square(deviations)])

    def predict(self, torques: tuple[float, float], request: float) -> None:
        """Take C_m and C_load of a period and the request of the on-coming clutch, all in N m."""
        torque = self._actuator.mean_torque(request)
        step = np.eye(7)
        step[:4, :4] = self._model.step
        by_torque = self._model.held[:, 1]
        step[:4, GAIN] = by_torque * torque
        step[:4, OFFSET] = by_torque if torque > CARRIES_FROM_N_M else 0.0
        step[:4, DELAY] = by_torque * (self._torque - torque) / PERIOD_S
        self._torque, self._load = torque, torques[1]
        states = step @ self._states
        states[:4] += self._model.held[:, 0] * torques[0] + self._model.held[:, 2] * torques[1]
        self._states = states
        self._spread = step @ self._spread @ step.T + self._model.drift

    def correct(self, engine_speed: float, wheel_speed: float) -> None:
        """Take w_m and the wheel speed in rad/s; the off-going clutch is locked."""
        states, spread = self._states, self._spread
        measured = np.array([self._model.gear.wheel_speed(engine_speed), wheel_speed])
        error = measured - self._model.measured @ states
        error[1] -= self._model.measured_load * self._load
        by_states = self._model.measured @ spread
        share = np.linalg.solve(
            by_states @ self._model.measured.T + self._model.noise, by_states
        ).T
        self._states = states + share @ error
        spread = spread - share @ by_states
        self._spread = 0.5 * (spread + spread.T)
