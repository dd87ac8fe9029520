# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The estimate of the on-coming clutch beside the textbook form of its Kalman filter."""

from typing import Any

import numpy as np
import scipy.linalg

from ddct_controllers.handover.on_coming_estimate import (
    ENGINE_TORQUE_NOISE_N_M,
    FIRST_LOAD_N_M,
    FIRST_TWIST_RAD,
    LOAD_DRIFT_N_M,
    SPEED_NOISE_RAD_S,
    WHEEL_NOISE_RAD_S,
    OnComingEstimate,
    OnComingModel,
)
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.rules.shift import gears_of

SCENARIO = load_scenario('upshift')


def model_of_the_locked_clutch() -> tuple[np.ndarray, np.ndarray]:
    """Return the sampled matrix of w_g, w_r, theta and the error of C_load, and that of C_m."""
    gears = gears_of(SCENARIO)
    p = gears.on_coming
    off_going, on_coming = gears.off_going.shaft_speed(1.0), p.gear.shaft_speed(1.0)
    both = off_going**2 + on_coming**2
    inertia = p.engine_inertia * off_going**2 + p.shaft_inertia * both
    damping = p.engine_damping * off_going**2 + p.shaft_damping * both
    c_sa, k_sa, vehicle = p.halfshaft_damping, p.halfshaft_stiffness, p.vehicle_inertia
    continuous = np.zeros((5, 5))
    continuous[0] = [
        -(damping + c_sa) / inertia,
        c_sa / inertia,
        -k_sa / inertia,
        0,
        off_going / inertia,
    ]
    continuous[1] = [c_sa / vehicle, -c_sa / vehicle, k_sa / vehicle, -1.0 / vehicle, 0.0]
    continuous[2, :2] = 1.0, -1.0
    sampled = scipy.linalg.expm(continuous * PERIOD_S)
    return sampled[:4, :4], sampled[:4, 4]


def test_the_uncertainty_without_torque_is_that_of_the_kalman_filter_of_matrices() -> None:
    step, by_engine = model_of_the_locked_clutch()
    tau = gears_of(SCENARIO).off_going.shaft_speed(1.0)
    noise = np.diag([SPEED_NOISE_RAD_S / tau, WHEEL_NOISE_RAD_S]) ** 2
    drift = ENGINE_TORQUE_NOISE_N_M**2 * np.outer(by_engine, by_engine)
    drift += np.diag([0.0, 0.0, 0.0, LOAD_DRIFT_N_M]) ** 2
    spread = scipy.linalg.block_diag(noise, FIRST_TWIST_RAD**2, FIRST_LOAD_N_M**2)
    measured = np.eye(2, 4)

    model = OnComingModel.of(gears_of(SCENARIO), 0.0, 0.0)
    estimate: Any = OnComingEstimate(model, SCENARIO.actuator)
    estimate.start(200.0, 15.0, 100.0)
    for _ in range(100):
        spread = step @ spread @ step.T + drift
        of_speeds = measured @ spread @ measured.T + noise
        spread = spread - spread @ measured.T @ np.linalg.inv(of_speeds) @ measured @ spread
        estimate.predict((100.0, 0.0), 0.0)
        estimate.correct(200.0, 15.0)
        np.testing.assert_allclose(estimate._spread[:4, :4], spread, rtol=1e-6, atol=1e-12)
