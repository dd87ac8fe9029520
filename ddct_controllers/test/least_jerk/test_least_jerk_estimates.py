# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Estimates of `least_jerk`: actuator, torque, slip and demand."""

import numpy as np
import pytest
from other_actuators import ACTUATORS

from ddct_controllers.least_jerk.actuator_model import ActuatorTorque
from ddct_controllers.least_jerk.demand_trend import LONGEST, DemandTrend
from ddct_controllers.least_jerk.slip_estimate import RigidSlip
from ddct_controllers.least_jerk.torque_covariance import (
    AT_TORQUE_N_M,
    ENGINE_TORQUE_NOISE_N_M,
    INITIAL_GAIN,
    INITIAL_OFFSET_N_M,
    LEAST_TORQUE_N_M,
    SPEED_NOISE_RAD_S,
    TorqueNoise,
)
from ddct_controllers.least_jerk.torque_estimate import CarriedTorque
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.actuator import Actuator
from ddct_plant.models.parameters import DrivelineParameters

DRIVELINE = DrivelineParameters()
J_M = DRIVELINE.engine_inertia
NOISE = TorqueNoise(gain_drift=0.002, offset_drift_n_m=0.4)


def requests(count):
    return 100.0 + 80.0 * np.sin(0.3 * np.arange(count))


@pytest.mark.parametrize('actuator', ACTUATORS.values(), ids=ACTUATORS)
def test_the_mean_torque_is_that_of_the_plants_actuator(actuator):
    model, plant = ActuatorTorque(actuator), Actuator(60.0, actuator)
    model.reset(60.0)
    for request in requests(60):
        nodes = plant.update(request)
        mean = (sum(nodes) - 0.5 * (nodes[0] + nodes[-1])) / (len(nodes) - 1)
        assert model.mean_torque(request) == pytest.approx(mean, abs=0.05)
        model.advance(request)


@pytest.mark.parametrize('actuator', ACTUATORS.values(), ids=ACTUATORS)
def test_the_torque_ahead_is_the_sum_of_the_means_to_come_over_the_lag(actuator):
    model = ActuatorTorque(actuator)
    assert model.ahead == round(actuator.lag_s / PERIOD_S)
    for request in requests(20):
        model.advance(request)
    ahead, total = model.torque_ahead(), 0.0
    for _ in range(model.ahead):
        total += model.mean_torque(model.request)
        model.advance(model.request)
    assert ahead == pytest.approx(total, rel=1e-12)


def test_the_filter_of_the_torque_is_the_kalman_filter_of_matrices():
    """Covariances and gains of the six entries, beside the textbook form."""
    estimate = CarriedTorque(J_M, 0.0, NOISE)
    estimate.follow(100.0)
    state = np.array([100.0, 1.0, 0.0])
    spread = np.diag([SPEED_NOISE_RAD_S, INITIAL_GAIN, INITIAL_OFFSET_N_M]) ** 2
    rng, step = np.random.default_rng(1), PERIOD_S / J_M
    for torque in (0.0, 3.0, 40.0, 80.0, 120.0, 110.0, 90.0):
        speed = state[0] + 0.05 * rng.standard_normal()
        a = np.array([[1.0, -step * torque, -step], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
        drift = NOISE.gain_drift if torque > LEAST_TORQUE_N_M else 0.0
        offset_drift = NOISE.offset_drift_n_m * torque / AT_TORQUE_N_M
        process = np.diag([step * ENGINE_TORQUE_NOISE_N_M, drift, offset_drift]) ** 2
        state = a @ state + [step * torque, 0.0, 0.0]
        spread = a @ spread @ a.T + process
        gain = spread[:, 0] / (spread[0, 0] + SPEED_NOISE_RAD_S**2)
        state = state + gain * (speed - state[0])
        spread = spread - np.outer(gain, spread[0])
        estimate.update(speed, torque, torque)
        assert (estimate.gain, estimate.offset) == pytest.approx((state[1], state[2]), abs=1e-9)


@pytest.mark.parametrize(('gain', 'offset'), [(0.7, 0.0), (1.3, 4.0)])
def test_it_finds_wear_and_offset_while_the_torque_changes(gain, offset):
    estimate, speed = CarriedTorque(J_M, 0.0, NOISE), 120.0
    estimate.follow(speed)
    for torque in np.concatenate([requests(150), np.linspace(100.0, 150.0, 50)]):
        speed += PERIOD_S / J_M * (140.0 - gain * torque - offset)
        estimate.update(speed, 140.0, torque)
    assert estimate.carried(torque) == pytest.approx(gain * torque + offset, abs=0.3)
    assert estimate.gain == pytest.approx(gain, abs=0.02)
    assert estimate.carried(estimate.request(77.0)) == pytest.approx(77.0, abs=0.3)
    assert estimate.applied(estimate.request(77.0)) == pytest.approx(77.0)


def test_requests_follow_the_estimate_slowly_against_its_noise():
    slow = CarriedTorque(J_M, 0.0, NOISE)
    at_once = CarriedTorque(J_M, 0.0, NOISE, applied_share=1.0)
    for estimate in (slow, at_once):
        estimate.follow(100.0)
        estimate.update(90.0, 100.0, 100.0)
    assert at_once.request(50.0) == pytest.approx((50.0 - at_once.offset) / at_once.gain)
    assert 50.0 > slow.request(50.0) > at_once.request(50.0) + 1.0


def test_without_torque_the_wear_stays():
    estimate = CarriedTorque(J_M, 0.0, NOISE)
    estimate.follow(100.0)
    for _ in range(50):
        estimate.update(103.0, 0.0, 0.0)
    assert estimate.gain == 1.0


def test_the_slip_of_a_rigid_car_is_found_from_a_twisted_one_with_an_error_of_the_torque():
    slip = RigidSlip(DRIVELINE, 8.0)
    rate, error, true, surplus = -150.0, 6.0, 90.0, 40.0
    slip.follow(true - slip.twist_s2 * rate)
    for _ in range(120):
        surplus += PERIOD_S * rate * 0.1
        true -= PERIOD_S / slip.inertia * (surplus + error)
        slip.update(true - slip.twist_s2 * 0.1 * rate, surplus, 0.1 * PERIOD_S * rate)
    assert slip.surplus_error == pytest.approx(error, abs=0.05)
    assert slip.slip == pytest.approx(true, abs=0.05)


def test_the_twist_is_that_of_a_torque_that_rises_steadily():
    """The half-shaft has the torque that accelerates the vehicle with the shaft."""
    slip = RigidSlip(DRIVELINE, 5.0)
    p = DRIVELINE
    wheel_share = p.gear.at_shaft(p.vehicle_inertia) / p.vehicle_side_inertia
    twisting = p.gear.wheel_torque(wheel_share) / p.halfshaft_stiffness
    assert slip.twist_s2 == pytest.approx(p.gear.shaft_speed(twisting))


def test_the_trend_of_a_ramp_is_the_ramp():
    trend = DemandTrend()
    for step in range(200):
        trend.update(2.0 * step)
    assert trend.rate == pytest.approx(200.0, rel=1e-3)
    assert trend.level == pytest.approx(398.0, abs=0.01)


def test_the_first_values_are_fitted_as_least_squares_do():
    values = [3.0, 5.0, 4.0, 6.0, 5.0, 8.0]
    trend = DemandTrend()
    for value in values:
        trend.update(value)
    slope, start = np.polyfit(np.arange(len(values)), values, 1)
    assert trend.level == pytest.approx(start + slope * (len(values) - 1))
    assert trend.rate == pytest.approx(slope / PERIOD_S)


def test_a_steady_torque_is_known_better_than_it_is_measured():
    rng, trend, errors = np.random.default_rng(2), DemandTrend(), []
    for step in range(600):
        trend.update(round(25.0 + rng.standard_normal()))
        if step > LONGEST:
            errors.append(trend.level - 25.0)
    assert np.std(errors) < 0.35


@pytest.mark.parametrize('rate', [0.0, 300.0])
def test_a_change_of_the_demand_is_followed_at_once(rate):
    """A step of 40 N m, or the start of a ramp."""
    trend, torque = DemandTrend(), 25.0
    for _ in range(200):
        trend.update(torque)
    torque += 0.0 if rate else 40.0
    for _ in range(15):
        torque += PERIOD_S * rate
        trend.update(torque)
    assert trend.level == pytest.approx(torque, abs=4.0)
