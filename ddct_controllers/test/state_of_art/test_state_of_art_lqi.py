# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""LQI: an exact predictor, margins that hold for a worn clutch, and no error at rest."""

import numpy as np
import pytest
from other_actuators import ACTUATORS, AT_ONCE, BETWEEN, FAST, LATE, SLOW
from scipy.linalg import solve_discrete_are

from ddct_controllers.design.analysis.loops import sampled_loop, sampled_plant
from ddct_controllers.design.analysis.margins import loop_margins
from ddct_controllers.design.analysis.worst_corner import plant_corners, worst_corner
from ddct_controllers.interface import ControllerContext
from ddct_controllers.registry import make_controller
from ddct_controllers.state_of_art import lqi
from ddct_controllers.state_of_art.parts.rigid_transmission import RigidTransmission
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import PERIOD_S, SUBSTEPS
from ddct_plant.base.units import RAD_S_PER_RPM
from ddct_plant.models.actuator import PRINTED_ACTUATOR
from ddct_plant.models.clutch import FrictionParameters
from ddct_plant.models.driveline_model import driveline_matrices
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')))
DRIVELINE = DrivelineParameters()
NOISE = lqi.noise_levels(FrictionParameters())
FREQUENCY = lqi.OPTIONS['natural_frequency_rad_s'].default
MODEL = lqi.lqi_model(DRIVELINE, PRINTED_ACTUATOR, NOISE, FREQUENCY)


def response(model, omega, column):
    """Return the slip's response to one input."""
    identity = np.eye(len(model.a))
    return np.array(
        [
            model.c[0] @ np.linalg.solve(1j * w * identity - model.a, model.b[:, column])
            for w in omega
        ]
    )


@pytest.mark.parametrize('column', [0, 1, 2])
def test_the_slip_model_is_the_driveline_but_for_the_drag(column):
    omega = np.geomspace(0.5, 300.0, 50)
    ours = response(lqi.slip_model(DRIVELINE), omega, column)
    whole = response(driveline_matrices(DRIVELINE), omega, column)
    assert np.abs(ours / whole - 1.0).max() < 0.02


def test_it_is_linear_and_has_a_linear_model():
    model = make_controller('lqi', SETTINGS.known).linear_model()
    assert np.array_equal(model.a, MODEL.a)
    assert np.linalg.matrix_rank(MODEL.a) <= len(MODEL.a) == 9
    assert 1.0 in np.linalg.eigvals(MODEL.a).real.round(9), 'the integral'


@pytest.mark.parametrize('wear_gain', [0.7, 1.0, 1.3])
@pytest.mark.parametrize(
    ('actuator', 'most_sensitivity', 'least_phase'),
    [
        (PRINTED_ACTUATOR, 1.55, 50.0),
        (SLOW, 1.65, 45.0),
        (FAST, 1.55, 50.0),
        (AT_ONCE, 1.55, 50.0),
        (BETWEEN, 1.6, 50.0),
        (LATE, 1.8, 40.0),
    ],
)
def test_the_sampled_loop_keeps_its_margins_with_wear(
    actuator, most_sensitivity, least_phase, wear_gain
):
    model = lqi.lqi_model(DRIVELINE, actuator, NOISE, FREQUENCY)
    margins = loop_margins(sampled_loop(model, wear_gain=wear_gain, actuator=actuator))
    assert margins.stable
    assert margins.sensitivity_peak < most_sensitivity
    assert margins.phase_margin_deg > least_phase
    assert margins.gain_margin_db > 10.0


def test_no_corner_of_the_driveline_is_unstable():
    worst = worst_corner(MODEL, plant_corners())
    assert worst.unstable_corners == 0
    assert worst.sensitivity_peak < 3.0


@pytest.mark.parametrize('wear_gain', [0.7, 1.3])
@pytest.mark.parametrize('option', ['at_least', 'at_most'])
def test_every_frequency_that_it_takes_is_stable(option, wear_gain):
    frequency = getattr(lqi.OPTIONS['natural_frequency_rad_s'], option)
    model = lqi.lqi_model(DRIVELINE, PRINTED_ACTUATOR, NOISE, frequency)
    loop = sampled_loop(model, wear_gain=wear_gain)
    assert loop_margins(loop).sensitivity_peak < 2.0


def test_the_predictor_is_exact():
    """The gain with prediction over the delay is that of LQ with the delay as a state."""
    plant = lqi._plant(DRIVELINE, PRINTED_ACTUATOR.dynamics(), 0)
    states = len(plant.a)
    gain = lqi._feedback_gain(plant, DRIVELINE, 5.0)
    # x, integral of the error, delayed request; the cost has x and the integral one step later.
    a = np.zeros((states + 2, states + 2))
    a[:states, :states], a[:states, -1] = plant.a, plant.b[:, 0]
    a[states, states], a[states, :states] = 1.0, -PERIOD_S * plant.c[0]
    b = np.zeros((states + 2, 1))
    b[-1] = 1.0
    ratio = 5.0 / RigidTransmission(DRIVELINE).slip_gain
    weights = np.zeros((states + 2, states + 2))
    weights[:states, :states] = 2.0 * ratio**2 * plant.c.T @ plant.c
    weights[states, states] = (5.0 * ratio) ** 2
    cost = solve_discrete_are(a, b, weights, np.eye(1))
    with_delay = np.linalg.solve(1.0 + b.T @ cost @ b, b.T @ cost @ a)[0]
    predicted = gain @ np.hstack([a[:-1, :-1], a[:-1, -1:]])
    assert with_delay == pytest.approx(predicted, rel=1e-5, abs=1e-6)


@pytest.mark.parametrize('actuator', ACTUATORS.values(), ids=ACTUATORS)
def test_the_request_is_that_of_the_state_when_it_acts(actuator):
    """A copy of the plant whose states are known has the request of K, predicted step by step."""
    periods, late = divmod(actuator.delay_substeps, SUBSTEPS)
    plant = lqi._plant(DRIVELINE, actuator.dynamics(), late)
    gain = lqi._feedback_gain(plant, DRIVELINE, FREQUENCY)
    correction = lqi._filter_gain(plant, DRIVELINE, NOISE)[:, 0]
    model = lqi.lqi_model(DRIVELINE, actuator, NOISE, FREQUENCY)
    states, integral, requests = np.zeros(len(plant.a)), 0.0, [0.0] * periods
    own, random = np.zeros(len(model.a)), np.random.default_rng(7)
    for error_rpm in random.normal(size=40):
        error = RAD_S_PER_RPM * error_rpm
        states = states + correction * (-error - plant.c[0] @ states)
        ahead, of_error = states, integral
        for period, acting in enumerate(requests):
            of_error += PERIOD_S * (-plant.c[0] @ ahead if period else error)
            ahead = plant.a @ ahead + plant.b[:, 0] * acting
        request = -gain @ [*ahead, of_error]
        assert (model.c @ own + model.d[:, 0] * error_rpm)[0] == pytest.approx(request, rel=1e-9)
        own = model.a @ own + model.b[:, 0] * error_rpm
        requests = [*requests, request]
        states = plant.a @ states + plant.b[:, 0] * requests.pop(0)
        integral += PERIOD_S * error


def test_on_a_rigid_driveline_the_weights_give_the_double_pole(monkeypatch):
    from ddct_plant.linear.lti import StateSpace
    from ddct_plant.linear.sampling import discretise_zoh

    slip_gain = RigidTransmission(DRIVELINE).slip_gain
    rigid = StateSpace(np.zeros((1, 1)), np.array([[-slip_gain]]), np.eye(1), np.zeros((1, 1)))
    plant = discretise_zoh(rigid, PERIOD_S)
    gain = lqi._feedback_gain(plant, DRIVELINE, 5.0)
    a = np.array([[1.0, 0.0], [-PERIOD_S, 1.0]])
    closed = a - np.append(plant.b[:, 0], 0.0)[:, None] * gain
    poles = np.log(np.linalg.eigvals(closed)) / PERIOD_S
    assert poles.real == pytest.approx([-5.0, -5.0], rel=0.05)
    assert np.abs(poles.imag).max() < 1.0


@pytest.mark.parametrize('wear_gain', [0.7, 1.0, 1.3])
def test_a_constant_torque_error_leaves_no_slip(wear_gain):
    plant = sampled_plant(DRIVELINE, wear_gain)
    state, own = np.zeros(len(plant.a)), np.zeros(len(MODEL.a))
    for _ in range(1000):
        error = -(plant.c @ state)
        torque = MODEL.c @ own + MODEL.d @ error
        own = MODEL.a @ own + MODEL.b @ error
        state = plant.a @ state + plant.b @ (torque + 50.0)
    assert abs((plant.c @ state)[0]) < 0.05


@pytest.mark.parametrize(
    ('options', 'complaint'),
    [
        ({'bandwidth': 3.0}, 'controllers.lqi.bandwidth is not a key of lqi: it has natural_fr'),
        ({'natural_frequency_rad_s': 0.0}, 'controllers.lqi.natural_frequency_rad_s is 0'),
        ({'natural_frequency_rad_s': 50.0}, 'it must be at most 8'),
        ({'natural_frequency_rad_s': 'high'}, "is 'high'"),
    ],
)
def test_a_bad_option_is_named(options, complaint):
    with pytest.raises(ParameterError) as caught:
        lqi.SPEC(ControllerContext(SETTINGS.known, options))
    assert complaint in str(caught.value)
