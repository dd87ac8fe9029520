"""Estimate of the wear gain and the predictive controller that uses it."""

from dataclasses import replace

import numpy as np
import pytest

from ddct_controllers.interface import ControllerContext, Measurement
from ddct_controllers.mpc.horizon import condense
from ddct_controllers.mpc.observer import NoiseLevels
from ddct_controllers.mpc.transmission_model import (
    LOAD_TORQUE,
    transmission_model,
    with_disturbances,
)
from ddct_controllers.mpc.wear_mpc import make_wear_mpc
from ddct_controllers.mpc.wear_observer import HIGHEST_GAIN, WearNoise, WearObserver
from ddct_plant.errors import DdctError, ParameterError
from ddct_plant.run_settings import RunSettings
from ddct_plant.scenario_file import load_scenario

SETTINGS = RunSettings(load_scenario('thesis'))
DRIVELINE = SETTINGS.scenario.driveline
NOISE = NoiseLevels()
LOAD_N_M = 60.0


def make_observer():
    model = transmission_model(DRIVELINE)
    return WearObserver(
        model, NOISE, WearNoise(), DRIVELINE.halfshaft_stiffness, initial_request=0.0
    )


def follow(observer, wear_gain, requests, load_error_n_m=0.0, noise=None):
    """Let the observer follow a plant; return its estimates of the gain, one per request."""
    plant = transmission_model(DRIVELINE, wear_gain)
    twist = LOAD_N_M / DRIVELINE.halfshaft_stiffness
    state = plant.at_rest((170.0, 160.0, 160.0 / DRIVELINE.total_ratio), twist, 0.0)
    gains = []
    for request in requests:
        error = np.zeros(3) if noise is None else noise.normal(0.0, NOISE.speed_rad_s, 3)
        observer.correct(tuple(state[:3] + error), LOAD_N_M)
        gains.append(observer.wear_gain)
        observer.predict((request, 120.0, LOAD_N_M))
        state = plant.a @ state + plant.b @ (request, 120.0, LOAD_N_M + load_error_n_m)
    return np.array(gains)


RAMP = np.minimum(np.arange(100) * 5.0, 150.0)


@pytest.mark.parametrize('wear_gain', [0.7, 0.85, 1.0, 1.15, 1.3])
def test_it_knows_the_gain_a_fifth_of_a_second_after_torque_begins_to_flow(wear_gain):
    gains = follow(make_observer(), wear_gain, RAMP)
    assert np.abs(gains[20:] - wear_gain).max() < 0.02
    assert gains[-1] == pytest.approx(wear_gain, abs=1e-4)


def test_it_says_nothing_without_torque():
    observer = make_observer()
    gains = follow(observer, 0.7, np.zeros(50), load_error_n_m=300.0)
    assert np.all(gains == 1.0)
    assert observer.wear_gain_deviation == pytest.approx(WearNoise().initial_gain)


def test_an_unknown_load_is_not_taken_for_wear():
    gains = follow(make_observer(), 0.85, RAMP, load_error_n_m=470.0)
    assert np.abs(gains[40:] - 0.85).max() < 0.005


def test_its_errors_are_within_what_it_says_of_them():
    deviations = []
    for seed in range(30):
        observer = make_observer()
        gains = follow(observer, 0.8, RAMP, noise=np.random.default_rng(seed))
        deviations.append((gains[-1] - 0.8) / observer.wear_gain_deviation)
    assert 0.0 < np.sqrt(np.mean(np.square(deviations))) < 1.0
    assert np.abs(deviations).max() < 3.0


def test_the_estimate_stays_within_its_bounds():
    assert follow(make_observer(), 2.0, RAMP).max() == HIGHEST_GAIN


def test_a_reset_observer_is_a_new_one():
    used = make_observer()
    follow(used, 0.7, RAMP)
    used.reset()
    assert used.wear_gain == 1.0
    np.testing.assert_array_equal(
        follow(used, 1.2, RAMP), follow(make_observer(), 1.2, RAMP), strict=True
    )


def make_controller(options=None, settings=SETTINGS):
    return make_wear_mpc(ControllerContext(settings, options or {}))


@pytest.mark.parametrize('wear_gain', [0.7, 1.3])
def test_dividing_by_the_gain_gives_the_moves_of_the_worn_clutch_s_own_program(wear_gain):
    controller = make_controller()
    settings = controller.settings
    worn = transmission_model(DRIVELINE, wear_gain)
    worn = with_disturbances(worn, worn.b[:, LOAD_TORQUE : LOAD_TORQUE + 1])
    weight = settings.inputs[0].move_weight * wear_gain
    own = condense(
        worn, replace(settings, inputs=(replace(settings.inputs[0], move_weight=weight),))
    )
    random = np.random.default_rng(1)
    driveline, actuator, load_error = random.normal(size=4), random.normal(size=5), 20.0
    before, known, target = 150.0, np.array([300.0, 70.0]), 0.0
    references = random.normal(size=settings.prediction_steps)
    given = np.concatenate(
        [driveline, actuator, [load_error, before], known, [target], references]
    )
    scale = np.ones(len(given))
    scale[[*range(4), 9, *range(11, 13), *range(14, len(given))]] = wear_gain
    new = controller.program
    expected = np.linalg.solve(own.structure.hessian, own.gradient @ given)
    moves = np.linalg.solve(new.structure.hessian, new.gradient @ (given / scale))
    np.testing.assert_allclose(moves, expected, rtol=1e-9)


def measurement(step, speed=170.0):
    return Measurement(
        step=step,
        engine_speed=speed,
        shaft_speed=150.0,
        wheel_speed=150.0 / DRIVELINE.total_ratio,
        vehicle_speed=5.0,
        engine_torque=200.0,
        slip_reference=[20.0 - 0.5 * i for i in range(23)],
        slip_reference_rate=[-50.0] * 23,
        load_torque=60.0,
        open_loop_torque=170.0,
    )


def test_a_reset_controller_is_a_new_one():
    used, new = make_controller(), make_controller()
    used.hold(measurement(0))
    for step in range(1, 5):
        used.update(measurement(step, 170.0 + step))
    used.reset()
    for step in range(4):
        assert used.update(measurement(step)) == new.update(measurement(step))


def test_status_shows_the_estimate():
    status = dict(make_controller().update(measurement(0)).status)
    assert float(status['wear_gain_estimate']) == 1.0
    assert float(status['wear_gain_deviation']) == pytest.approx(WearNoise().initial_gain)


def test_nan_is_refused():
    with pytest.raises(DdctError, match='at step 3'):
        make_controller().update(measurement(3, float('nan')))


@pytest.mark.parametrize(
    ('options', 'complaint'),
    [
        ({'gain_drift': -0.1}, 'controllers.mpc_wear.gain_drift is -0.1'),
        ({'load_drift_n_m': None}, 'controllers.mpc_wear.load_drift_n_m is None'),
        ({'torsion_weight': 1.0}, 'torsion_weight is not a key of mpc_wear'),
    ],
)
def test_bad_options_are_named(options, complaint):
    with pytest.raises(ParameterError, match=complaint):
        make_controller(options)
