# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The predictive controllers' model is the plant they run in, and their observer follows it."""

import numpy as np
import pytest
from other_actuators import ACTUATORS, AT_ONCE, FAST, LATE, SLOW

from ddct_controllers.mpc.estimate.observer import (
    AtRest,
    NoiseLevels,
    Observer,
    kalman_gain,
    unit_noise_gain,
)
from ddct_controllers.mpc.model.disturbances import offset_free_model, with_disturbances
from ddct_controllers.mpc.model.transmission_model import (
    ENGINE_TORQUE,
    LOAD_TORQUE,
    REQUEST,
    SLIP_ACCELERATION,
    SLIP_SPEED,
    STATES,
    TORSION_SPEED,
    transmission_model,
    with_engine,
)
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.models.actuator import PRINTED_ACTUATOR, Actuator
from ddct_plant.models.clutch import LinearClutch
from ddct_plant.models.driveline_model import driveline_matrices
from ddct_plant.models.initial_state import InitialSide, InitialState
from ddct_plant.models.linear_driveline import Driveline
from ddct_plant.models.parameters import DrivelineParameters, VehicleParameters
from ddct_plant.models.printed import ACTUATOR

DRIVELINE = DrivelineParameters()
MODEL = transmission_model(DRIVELINE)
SIDE = InitialSide(150.0, 35.0, 35.0)
START = InitialState(180.0, DRIVELINE.gear.wheel_speed(150.0), 0.01, 40.0, 60.0, (SIDE,))


def inputs(steps):
    random = np.random.default_rng(4)
    request = 100.0 + 80.0 * np.cumsum(random.normal(size=steps)) / np.sqrt(steps)
    engine = 120.0 + 20.0 * np.sin(np.arange(steps) / 7.0)
    return np.column_stack([np.maximum(request, 0.0), engine, np.full(steps, 60.0)])


def plant_run(rows, wear_gain=1.0, parameters=PRINTED_ACTUATOR):
    """Return w_m, w_p, w_r, w_sr (steps, 4) of the plant's own classes."""
    driveline = Driveline(DRIVELINE, VehicleParameters(), START)
    actuator, clutch = Actuator(SIDE.torque_request, parameters), LinearClutch(wear_gain)
    speeds = []
    for request, engine, load in rows:
        speeds.append(driveline.outputs().joint_speed)
        driveline.step(engine, load, clutch.transmit(actuator.update(request)))
    return np.array(speeds)


def rest(model):
    speeds = (START.engine_speed, SIDE.shaft_speed, START.wheel_speed)
    return model.at_rest(speeds, START.twist, SIDE.torque_request)


def model_run(model, rows):
    states = [rest(model)]
    for row in rows[:-1]:
        states.append(model.a @ states[-1] + model.b @ row)
    return np.array(states)


@pytest.mark.parametrize('wear_gain', [0.7, 1.0, 1.3])
@pytest.mark.parametrize('actuator', ACTUATORS.values(), ids=ACTUATORS)
def test_model_follows_the_plant(actuator, wear_gain):
    rows = inputs(300)
    plant = plant_run(rows, wear_gain, actuator)
    model = transmission_model(DRIVELINE, wear_gain, actuator)
    states = model_run(model, rows)
    peak = np.abs(plant[:, 0] - plant[:, 1]).max()
    # The plant's actuator torque is linear between nodes 1 ms apart.
    assert np.abs(states[:, :3] - plant[:, :3]).max() < 2e-4 * peak
    slip, torsion = (states @ model.c.T)[:, [SLIP_SPEED, TORSION_SPEED]].T
    assert np.allclose(slip, states[:, 0] - states[:, 1])
    assert np.abs(torsion - plant[:, 3]).max() < 2e-4 * peak


def test_slip_acceleration_is_the_derivative_at_the_start_of_a_period():
    """The inputs of a period count from its start: C_m at once, the request not yet."""
    state, u = rest(MODEL), np.array([90.0, 130.0, 60.0])
    state[4:8] += 0.01 * np.arange(1, 5)
    rate = (MODEL.c @ state + MODEL.d @ u)[SLIP_ACCELERATION]
    small = 1e-6
    change = transmission_at(state, u, small) - state[:8]
    assert rate == pytest.approx((change[0] - change[1]) / small, rel=1e-3)


def transmission_at(state, u, time_s):
    """Return the first eight states a short time into a period, by fine Euler steps."""
    plant, actuator = driveline_matrices(DRIVELINE), ACTUATOR.to_state_space()
    x, steps = state[:8].copy(), 200
    for _ in range(steps):
        c_f = (actuator.c @ x[4:])[0]
        rate = np.concatenate(
            [
                plant.a @ x[:4] + plant.b @ [u[1], c_f, u[2]],
                actuator.a @ x[4:] + actuator.b[:, 0] * state[8],
            ]
        )
        x += rate * time_s / steps
    return x


def test_disturbances_are_constants_that_push_through_their_columns():
    columns = np.column_stack([MODEL.clutch, MODEL.b[:, LOAD_TORQUE]])
    model = with_disturbances(MODEL, columns)
    assert model.disturbances == 2
    state = np.concatenate([rest(MODEL), [7.0, -3.0]])
    after = model.a @ state
    assert after[STATES:].tolist() == [7.0, -3.0]
    assert np.allclose(after[:STATES], MODEL.a @ state[:STATES] + columns @ [7.0, -3.0])


def test_clutch_column_is_a_held_torque_beside_the_actuator():
    """A C_f of 1 N m, held, pushes engine and shaft apart as the driveline's step does."""
    steps = np.full(11, 35.0)
    moved, still = (Driveline(DRIVELINE, VehicleParameters(), START) for _ in range(2))
    moved.step(40.0, 60.0, (steps + 1.0).tolist())
    still.step(40.0, 60.0, steps.tolist())
    difference = np.subtract(moved.outputs().joint_speed, still.outputs().joint_speed)
    assert MODEL.clutch[:3] == pytest.approx(difference[:3], rel=1e-9)


def test_the_delay_is_one_period_and_nothing_else():
    """Without it, the request of a period acts as that of the period before does with it."""
    rows = inputs(50)
    earlier = rows.copy()
    earlier[1:, 0], earlier[0, 0] = rows[:-1, 0], rest(MODEL)[8]
    at_once = model_run(transmission_model(DRIVELINE, actuator=AT_ONCE), earlier)
    delayed = model_run(MODEL, rows)
    np.testing.assert_allclose(at_once[:, :8], delayed[:, :8], atol=1e-9)


def test_an_unknown_load_drives_nothing():
    rows = inputs(50)
    unloaded = rows * [1.0, 1.0, 0.0]
    found = model_run(MODEL.without_load, rows)
    np.testing.assert_array_equal(found, model_run(MODEL, unloaded))


@pytest.mark.parametrize('load_known', [True, False])
def test_unit_noise_is_of_one_n_m_on_each_known_input_and_of_one_rpm_on_the_slip(load_known):
    """The reference is the filter by the doubling algorithm for Riccati's equation."""
    model = transmission_model(DRIVELINE, actuator=AT_ONCE)
    model = model if load_known else model.without_load
    output = rpm_from_rad_s(1.0) * np.array([1.0, -1.0, 0, 0, 0, 0, 0, 0, 0])
    known = model.b[:, : 2 + load_known]
    a, g, covariance = model.a.T, np.outer(output, output), known @ known.T
    for _ in range(30):
        w = np.linalg.inv(np.eye(STATES) + g @ covariance)
        a, g, covariance = (
            a @ w @ a,
            g + a @ w @ g @ a.T,
            covariance + a.T @ covariance @ w @ a,
        )
    gain = covariance @ output / (output @ covariance @ output + 1.0)
    expected = np.outer(gain, output[:3])
    np.testing.assert_allclose(unit_noise_gain(model), expected, rtol=1e-6, atol=1e-9)


def test_an_estimate_that_starts_at_zero_corrects_with_the_first_measurement():
    gain = np.outer(np.arange(1.0, 10.0), [1.0, -1.0, 0.0])
    observer = Observer(MODEL, gain, start=None)
    for _ in range(2):
        np.testing.assert_allclose(observer.correct((210.0, 200.0, 20.0), 60.0), 10.0 * gain[:, 0])
        observer.reset()


def test_gain_is_the_stationary_kalman_filter():
    import control

    noise = NoiseLevels()
    gain = kalman_gain(MODEL, noise)
    torque = np.column_stack([MODEL.b[:, ENGINE_TORQUE], MODEL.b[:, LOAD_TORQUE], MODEL.clutch])
    levels = (noise.engine_torque_n_m, noise.load_torque_n_m, noise.clutch_torque_n_m)
    process = torque @ np.diag(np.square(levels)) @ torque.T
    _, covariance, _ = control.dlqe(
        MODEL.a, np.eye(STATES), np.eye(3, STATES), process, noise.speed_rad_s**2 * np.eye(3)
    )
    measured = np.eye(3, STATES)
    # dlqe gives the covariance of the prediction in some releases, of the update in others.
    candidates = [covariance, MODEL.a @ covariance @ MODEL.a.T + process]
    expected = [
        p
        @ measured.T
        @ np.linalg.inv(measured @ p @ measured.T + noise.speed_rad_s**2 * np.eye(3))
        for p in candidates
    ]
    assert min(np.abs(gain - each).max() for each in expected) < 1e-6


def test_observer_finds_the_twist_that_is_not_measured():
    rows = inputs(200)
    states = model_run(MODEL, rows)
    observer = Observer(
        MODEL, kalman_gain(MODEL, NoiseLevels()), AtRest(DRIVELINE.halfshaft_stiffness, 35.0)
    )
    for row, state in zip(rows, states, strict=True):
        estimate = observer.correct(tuple(state[:3]), load_torque=500.0)
        observer.predict(tuple(row))
    assert states[0, 3] != pytest.approx(500.0 / DRIVELINE.halfshaft_stiffness)
    assert estimate[3] == pytest.approx(states[-1, 3], abs=1e-4)


def test_a_reset_observer_is_a_new_one():
    observers = [
        Observer(
            MODEL, kalman_gain(MODEL, NoiseLevels()), AtRest(DRIVELINE.halfshaft_stiffness, 35.0)
        )
        for _ in range(2)
    ]
    observers[0].correct((200.0, 100.0, 10.0), 50.0)
    observers[0].predict((10.0, 20.0, 30.0))
    observers[0].reset()
    first, second = (each.correct((180.0, 150.0, 16.0), 60.0) for each in observers)
    assert np.array_equal(first, second)


def test_noise_that_leaves_no_gain_is_refused():
    with pytest.raises(ParameterError, match='no stationary Kalman gain'):
        kalman_gain(MODEL, NoiseLevels(speed_rad_s=0.0, clutch_torque_n_m=float('nan')))


def test_inputs_have_the_indices_of_their_names():
    assert (REQUEST, ENGINE_TORQUE, LOAD_TORQUE) == (0, 1, 2)
    pushed = MODEL.b[:, ENGINE_TORQUE]
    assert pushed[0] == pytest.approx(0.01 / DRIVELINE.engine_inertia, rel=1e-3)
    assert MODEL.b[2, LOAD_TORQUE] < 0.0 < MODEL.b[8, REQUEST]


@pytest.mark.parametrize(
    ('actuator', 'waiting'),
    [
        (AT_ONCE, ['delayed_request']),
        (FAST, ['delayed_request']),
        (SLOW, ['delayed_request_2', 'delayed_request']),
        (LATE, [*(f'delayed_request_{periods}' for periods in (4, 3, 2)), 'delayed_request']),
    ],
)
def test_requests_that_wait_have_names_and_rest_on_the_first_request(actuator, waiting):
    model = offset_free_model(DRIVELINE, actuator)
    assert list(model.states)[8:-2] == waiting
    assert model.transmission == 8 + len(waiting)
    assert model.disturbances == 2
    rest = model.at_rest((170.0, 160.0, 17.0), 0.01, 40.0)
    after = model.a @ rest + model.b @ [40.0, 0.0, 0.0]
    np.testing.assert_allclose(after[4:], rest[4:], rtol=1e-12, atol=1e-12)
    assert rest[model.states.places(*waiting)].tolist() == [40.0] * len(waiting)


def test_every_state_of_a_model_and_of_its_variants_has_a_name():
    variants = [MODEL, with_engine(MODEL, 0.5), offset_free_model(DRIVELINE)]
    assert [len(each.states) for each in variants] == [len(each.a) for each in variants]
    assert variants[1].states['torque_demand'] == STATES
    assert list(variants[2].states)[STATES:] == ['disturbance_1', 'disturbance_2']
    rest = variants[2].at_rest((170.0, 160.0, 17.0), 0.01, 40.0)
    places = rest[MODEL.states.places('engine_speed', 'wheel_speed', 'twist', 'delayed_request')]
    assert places.tolist() == [170.0, 17.0, 0.01, 40.0]
