# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Estimate of the wear gain of the clutch."""

import numpy as np
import pytest

from ddct_controllers.mpc.estimate.observer import AtRest, Drifts, NoiseLevels
from ddct_controllers.mpc.estimate.wear_observer import (
    LEAST_TORQUE_N_M,
    MOST_TORQUE_N_M,
    WearNoise,
    WearObserver,
)
from ddct_controllers.mpc.estimate.wear_state import (
    GAIN,
    HIGHEST_GAIN,
    LOWEST_GAIN,
    SIZE,
    within_bounds,
)
from ddct_controllers.mpc.model.disturbances import offset_free_model
from ddct_controllers.mpc.model.transmission_model import (
    ENGINE_TORQUE,
    LOAD_TORQUE,
    MEASURED,
    STATES,
    transmission_model,
)
from ddct_plant.models.actuator import Actuator
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')))
DRIVELINE = SETTINGS.scenario.driveline
NOISE = NoiseLevels()
DRIFTS = Drifts.of(SETTINGS.scenario)
LOAD_N_M = 60.0


def make_observer(**noise):
    return WearObserver(
        offset_free_model(DRIVELINE),
        NOISE,
        WearNoise(**noise),
        DRIFTS,
        AtRest(DRIVELINE.halfshaft_stiffness, initial_request=0.0),
    )


def estimates(observer, wear_gain, requests, load_error_n_m=0.0, noise=None):
    """Run the observer beside a plant; return its gain and errors of C_f and C_load, (n, 3)."""
    plant = transmission_model(DRIVELINE)
    transition, effect = plant.a.copy(), plant.a[:4, 4:]
    twist = LOAD_N_M / DRIVELINE.halfshaft_stiffness
    state = plant.at_rest((170.0, 160.0, DRIVELINE.gear.wheel_speed(160.0)), twist, 0.0)
    found = []
    for request, true_gain in np.broadcast(requests, wear_gain):
        error = np.zeros(3) if noise is None else noise.normal(0.0, NOISE.speed_rad_s, 3)
        corrected = observer.correct(tuple(state[:3] + error), LOAD_N_M)
        found.append((observer.wear_gain, *(observer.wear_gain * corrected[STATES:])))
        observer.predict((request, 120.0, LOAD_N_M))
        transition[:4, 4:] = true_gain * effect
        state = transition @ state + plant.b @ (request, 120.0, LOAD_N_M + load_error_n_m)
    return np.array(found)


def follow(observer, wear_gain, requests, load_error_n_m=0.0, noise=None):
    """Return the estimated gain alone, one value per request."""
    return estimates(observer, wear_gain, requests, load_error_n_m, noise)[:, 0]


RAMP = np.minimum(np.arange(100) * 5.0, 150.0)


@pytest.mark.parametrize('wear_gain', [0.7, 0.85, 1.0, 1.15, 1.3])
def test_the_gain_is_found_a_fifth_of_a_second_after_torque_begins_to_flow(wear_gain):
    gains = follow(make_observer(), wear_gain, RAMP)
    assert np.abs(gains[20:] - wear_gain).max() < 0.02
    assert gains[-1] == pytest.approx(wear_gain, abs=1e-4)


def test_without_torque_the_gain_is_not_estimated():
    observer = make_observer()
    gains = follow(observer, 0.7, np.zeros(50), load_error_n_m=300.0)
    assert np.all(gains == 1.0)
    assert observer.wear_gain_deviation == pytest.approx(WearNoise().initial_gain)


def test_an_unknown_load_is_not_taken_for_wear():
    gains = follow(make_observer(), 0.85, RAMP, load_error_n_m=470.0)
    assert np.abs(gains[40:] - 0.85).max() < 0.005


def test_its_errors_are_within_their_estimated_deviation():
    deviations = []
    for seed in range(30):
        observer = make_observer()
        gains = follow(observer, 0.8, RAMP, noise=np.random.default_rng(seed))
        deviations.append((gains[-1] - 0.8) / observer.wear_gain_deviation)
    assert 0.0 < np.sqrt(np.mean(np.square(deviations))) < 1.0
    assert np.abs(deviations).max() < 3.0


@pytest.mark.parametrize(('wear_gain', 'bound'), [(0.4, LOWEST_GAIN), (2.0, HIGHEST_GAIN)])
def test_at_a_bound_the_rest_is_an_error_of_the_clutch_torque(wear_gain, bound):
    observer = make_observer()
    found = estimates(observer, wear_gain, RAMP, load_error_n_m=100.0)
    gains, clutch_errors, load_errors = found.T
    assert np.all((gains >= LOWEST_GAIN) & (gains <= HIGHEST_GAIN))
    assert np.any(gains == bound)
    assert gains[-1] * RAMP[-1] + clutch_errors[-1] == pytest.approx(
        wear_gain * RAMP[-1], rel=1e-3
    )
    assert load_errors[-1] == pytest.approx(100.0, rel=1e-2)


def test_a_bound_is_reported():
    observer = make_observer()
    assert not observer.wear_gain_at_bound
    at_bound = []
    for request in RAMP:
        observer.correct((170.0, 160.0, DRIVELINE.gear.wheel_speed(160.0)), LOAD_N_M)
        observer.predict((request, 0.0, LOAD_N_M))
        at_bound.append(observer.wear_gain_at_bound)
        assert at_bound[-1] == (observer.wear_gain in (LOWEST_GAIN, HIGHEST_GAIN))
    assert any(at_bound)


def test_within_the_bounds_no_error_of_the_clutch_torque_is_estimated():
    assert np.all(estimates(make_observer(), 0.7, RAMP)[:, 1] == 0.0)


def test_after_a_bound_the_true_gain_is_found_once_the_torque_changes():
    swing = 100.0 + 50.0 * np.cos(0.1 * np.arange(200))
    true_gains = np.repeat([2.0, 1.2], [100, 200])
    gains = follow(make_observer(), true_gains, np.concatenate([RAMP, swing]))
    assert np.any(gains[:100] == HIGHEST_GAIN)
    assert gains[-1] == pytest.approx(1.2, abs=0.02)


@pytest.mark.parametrize(('ends_at_n_m', 'rank'), [(150.0, 6), (300.0, 7)])
def test_gain_and_error_of_the_clutch_torque_are_observable_while_it_changes(ends_at_n_m, rank):
    """Rank of the observability matrix of (driveline, K_usura, both errors) along a torque."""
    model = offset_free_model(DRIVELINE)
    transition = np.eye(7)
    transition[:4, :4], transition[:4, 5:] = model.a[:4, :4], model.a[:4, STATES:]
    seen, rows = np.eye(7), []
    for torque_n_m in np.linspace(150.0, ends_at_n_m, 30):
        rows.append(seen[:MEASURED])
        transition[:4, 4] = torque_n_m * model.clutch[:4]
        seen = transition @ seen
    matrix = np.vstack(rows)
    assert np.linalg.matrix_rank(matrix / np.linalg.norm(matrix, axis=0), tol=1e-6) == rank


def conditioned(requests, engine_n_m, loads_n_m, measured, wear):
    """
    Return mean (7,) and covariance (7, 7) of the last state given all measured speeds (N, 3).

    No recursion of the filter: the states and the speeds of a run are linear in the start and in
    the noise of each period, so they are jointly Gaussian, and one conditional expectation is the
    answer. The equations are those of the driveline, sampled, with C_f = K_usura times the
    actuator's torque plus its error.
    """
    plant = transmission_model(DRIVELINE)
    twist_per_torque = 1.0 / DRIVELINE.halfshaft_stiffness
    actuator = plant.at_rest((0.0, 0.0, 0.0), 0.0, 0.0)[4:]
    start = np.array([*measured[0], loads_n_m[0] * twist_per_torque, 1.0, 0.0, 0.0])
    # The start: speeds as measured, gain 1 +- 0.2, and a second's drift of an unknown load.
    drift = 10.0 * DRIFTS.load
    start_factor = np.zeros((7, 5))
    start_factor[[0, 1, 2], [0, 1, 2]] = NOISE.speed_rad_s
    start_factor[4, 3] = wear.initial_gain
    start_factor[[3, 6], 4] = drift * twist_per_torque, drift
    mean, factors = start, start_factor
    seen: list[tuple[np.ndarray, np.ndarray]] = []
    for k in range(len(requests)):
        effect = plant.a[:4, 4:] @ actuator
        step = np.eye(7)
        step[:4, :4], step[:4, 4] = plant.a[:4, :4], effect
        step[:4, 5], step[:4, 6] = plant.clutch[:4], plant.b[:4, LOAD_TORQUE]
        noise = np.zeros((7, 5))
        noise[:4, 0] = NOISE.engine_torque_n_m * plant.b[:4, ENGINE_TORQUE]
        noise[:4, 1] = NOISE.load_torque_n_m * plant.b[:4, LOAD_TORQUE]
        noise[:4, 2] = NOISE.clutch_torque_n_m * plant.clutch[:4]
        noise[6, 3] = DRIFTS.load
        flowing = effect[0] / plant.clutch[0] > LEAST_TORQUE_N_M
        noise[4, 4] = wear.gain_drift if flowing else 0.0
        known = plant.b[:4, [ENGINE_TORQUE, LOAD_TORQUE]] @ [engine_n_m[k], loads_n_m[k]]
        mean = step @ mean + np.append(known, np.zeros(3))
        factors = np.hstack([step @ factors, noise])
        seen = [(m, np.hstack([f, np.zeros((3, 5))])) for m, f in seen]
        seen.append((mean[:3], factors[:3]))
        actuator = plant.a[4:, 4:] @ actuator + plant.b[4:, 0] * requests[k]
    means, rows = np.concatenate([m for m, _ in seen]), np.vstack([f for _, f in seen])
    covariance = rows @ rows.T + NOISE.speed_rad_s**2 * np.eye(len(rows))
    gain = np.linalg.solve(covariance, rows @ factors.T).T
    return mean + gain @ (measured[1:].ravel() - means), factors @ factors.T - gain @ (
        rows @ factors.T
    )


@pytest.mark.parametrize('periods', [3, 12, 30])
def test_it_is_the_conditional_expectation_of_all_that_was_measured(periods):
    """Gain and deviation are those of the Gaussian given all measurements, for a rising torque."""
    rng, observer, wear = np.random.default_rng(8), make_observer(), WearNoise()
    requests, engine = 4.0 * np.arange(periods), rng.normal(120.0, 5.0, periods)
    loads = rng.normal(LOAD_N_M, 10.0, periods)
    plant = transmission_model(DRIVELINE)
    transition, effect = plant.a.copy(), plant.a[:4, 4:]
    twist = 1.3 * loads[0] / DRIVELINE.halfshaft_stiffness
    state = plant.at_rest((170.0, 160.0, DRIVELINE.gear.wheel_speed(160.0)), twist, 0.0)
    measured = [state[:3]]
    transition[:4, 4:] = 0.8 * effect
    observer.correct(tuple(measured[0]), loads[0])
    for k in range(periods):
        inputs = np.array([requests[k], engine[k], loads[k]])
        observer.predict(tuple(inputs))
        state = transition @ state + plant.b @ (inputs + [0.0, 0.0, 20.0])
        measured.append(state[:3] + rng.normal(0.0, NOISE.speed_rad_s, 3))
        corrected = observer.correct(tuple(measured[-1]), loads[min(k + 1, periods - 1)])
    mean, covariance = conditioned(requests, engine, loads, np.array(measured), wear)
    assert LOWEST_GAIN < mean[4] < HIGHEST_GAIN
    assert observer.wear_gain == pytest.approx(mean[4], rel=1e-7)
    assert observer.wear_gain_deviation == pytest.approx(np.sqrt(covariance[4, 4]), rel=1e-7)
    assert corrected[:4] * mean[4] == pytest.approx(mean[:4], rel=1e-7)
    assert corrected[STATES:] * mean[4] == pytest.approx(mean[5:], rel=1e-6, abs=1e-9)


@pytest.mark.parametrize(('gain', 'bounded'), [(0.4, 0.5), (1.7, 1.5), (0.51, 0.51), (1.49, 1.49)])
def test_the_bounds_leave_the_likeliest_state_that_keeps_them(gain, bounded):
    """Bounds 0.5 and 1.5; the least (x - x_0)' P^-1 (x - x_0) by its normal equations."""
    rng = np.random.default_rng(9)
    factor, state = rng.normal(size=(SIZE, SIZE)), rng.normal(size=SIZE)
    state[GAIN] = gain
    covariance = factor @ factor.T
    weight = np.linalg.inv(covariance)
    others = np.arange(SIZE) != GAIN
    expected = state.copy()
    expected[GAIN] = bounded
    pull = weight[np.ix_(others, [GAIN])] @ [bounded - gain]
    expected[others] -= np.linalg.solve(weight[np.ix_(others, others)], pull)
    assert within_bounds(state, covariance) == pytest.approx(expected, rel=1e-9)
    assert within_bounds(state, covariance)[GAIN] == bounded


def test_the_gain_does_not_drift_below_the_least_torque_of_the_actuator():
    drifting, constant = make_observer(), make_observer(gain_drift=0.0)
    actuator = Actuator()
    for _ in range(20):
        transmitted = np.mean(actuator.update(100.0))
        for observer in (drifting, constant):
            observer.correct((170.0, 160.0, DRIVELINE.gear.wheel_speed(160.0)), LOAD_N_M)
        before = drifting.wear_gain_deviation, constant.wear_gain_deviation
        for observer in (drifting, constant):
            observer.predict((100.0, 120.0, LOAD_N_M))
        assert constant.wear_gain_deviation == before[1]
        assert (drifting.wear_gain_deviation > before[0]) == (transmitted > LEAST_TORQUE_N_M)


def test_a_reset_observer_is_a_new_one():
    used = make_observer()
    follow(used, 0.7, RAMP)
    used.reset()
    assert used.wear_gain == 1.0
    np.testing.assert_array_equal(
        follow(used, 1.2, RAMP), follow(make_observer(), 1.2, RAMP), strict=True
    )


def test_gain_drift_sets_how_fast_the_estimate_may_move():
    slow, fast = make_observer(gain_drift=0.0), make_observer(gain_drift=0.1)
    for observer in (slow, fast):
        follow(observer, 0.7, RAMP)
    assert fast.wear_gain_deviation > 1.5 * slow.wear_gain_deviation


def test_a_request_that_no_clutch_can_carry_leaves_the_covariance_positive():
    """A loop that diverges requests 1e11 N m within three seconds, and twice that 0.1 s later."""
    observer = make_observer()
    speeds = (500.0, 200.0, 20.0)
    for step in range(1000):
        observer.correct(speeds, LOAD_N_M)
        assert np.linalg.eigvalsh(observer._covariance).min() > -1e-6
        assert 0.0 < observer.wear_gain_deviation < 1.0
        observer.predict((1.08**step, 1000.0, LOAD_N_M))


def test_a_request_up_to_the_most_is_taken_as_it_is_and_above_it_as_the_most():
    effects = []
    for request in (0.9 * MOST_TORQUE_N_M, MOST_TORQUE_N_M, 7.0 * MOST_TORQUE_N_M):
        observer = make_observer()
        observer.correct((160.0, 160.0, 17.0), LOAD_N_M)
        observer.predict((request, 0.0, LOAD_N_M))
        effects.append(observer._actuator / MOST_TORQUE_N_M)
    np.testing.assert_allclose(effects[0], 0.9 * effects[1], rtol=1e-12)
    np.testing.assert_array_equal(effects[1], effects[2])
