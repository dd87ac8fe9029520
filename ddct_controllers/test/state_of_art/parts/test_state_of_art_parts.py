# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Parts of the controllers of the state of the art, each by itself."""

import math

import numpy as np
import pytest
from other_actuators import ACTUATORS, FAST, SLOW, keys_of

from ddct_controllers.interface import ControllerContext, Measurement
from ddct_controllers.mpc.model.transmission_model import REQUEST, SLIP_SPEED, transmission_model
from ddct_controllers.mpc.qp.backend import DEFAULT_BACKEND, make_backend
from ddct_controllers.state_of_art.parts.engagement_program import MOVES, engagement_programs
from ddct_controllers.state_of_art.parts.rigid_transmission import RigidTransmission, SpeedPlan
from ddct_controllers.state_of_art.parts.slow_clutch import SlowClutch
from ddct_controllers.state_of_art.parts.speed_loops import (
    TAKEOVER_BANDWIDTH_RAD_S,
    TAKEOVER_LAG_RAD,
    ClutchTorqueEstimator,
    EngineShare,
    Pid,
)
from ddct_plant.base.timebase import PERIOD_S, SUBSTEPS
from ddct_plant.models.actuator import PRINTED_ACTUATOR, Actuator
from ddct_plant.models.engine import EngineAuthority
from ddct_plant.models.static_torque import constant_slip_torque
from ddct_plant.scenario.control import EngineSpeedReference
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.initial_state import initial_request
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')))
DRIVELINE = SETTINGS.scenario.driveline
RIGID = RigidTransmission(DRIVELINE)
NO_POINTS = EngineSpeedReference()


def measurement(step=60, engine=240.0, shaft=190.0, demand=300.0, slip=50.0, rate=-100.0):
    wheel = shaft / DRIVELINE.gear.total_ratio
    return Measurement(step, engine, shaft, wheel, 6.5, demand, [slip], [rate], 60.0, 270.0)


def test_the_rigid_transmission_agrees_with_the_static_controller():
    now = measurement()
    torque = constant_slip_torque(DRIVELINE, now.engine_torque, now.load_torque)
    assert RIGID.engine_torque(now, torque, 0.0) == pytest.approx(now.engine_torque)
    rate = (torque - RIGID.load_at_shaft(now)) / RIGID.vehicle_inertia
    assert RIGID.constant_slip_acceleration(now) == pytest.approx(rate)


def test_the_plan_is_where_the_demand_alone_takes_a_rigid_transmission():
    plan = SpeedPlan(RIGID, NO_POINTS)
    engine, shaft, slip, rate = 240.0, 190.0, 50.0, -100.0
    for step in range(60, 90):
        now = measurement(step, engine, shaft, slip=slip, rate=rate)
        speed, acceleration = plan.update(now)
        assert speed == pytest.approx(engine, rel=1e-12)
        assert acceleration == pytest.approx(
            RIGID.constant_slip_acceleration(now)
            + rate * RIGID.vehicle_inertia / (RIGID.engine_inertia + RIGID.vehicle_inertia)
        )
        engine += PERIOD_S * acceleration
        shaft += PERIOD_S * (acceleration - rate)
        slip += PERIOD_S * rate


def test_the_points_of_a_scenario_prevail():
    plan = SpeedPlan(RIGID, EngineSpeedReference((0.6, 1.6), (200.0, 230.0)))
    assert plan.update(measurement(110)) == pytest.approx((215.0, 30.0))


@pytest.mark.parametrize('lag_s', [0.0, 0.1])
def test_placed_gains_put_both_poles_at_the_given_places(lag_s):
    """The plant is 1/(s (1 + lag s)), once the lag is cancelled."""
    gains = Pid(5.0, lag_s)
    numerator = np.array([gains.derivative, gains.proportional, gains.integral])
    denominator = np.polymul([lag_s, 1.0], [1.0, 0.0, 0.0])
    poles = np.roots(np.trim_zeros(np.polyadd(denominator, numerator), 'f'))
    wanted = [-5.0, -5.0, *([-1.0 / lag_s] if lag_s else [])]
    assert np.sort(poles.real) == pytest.approx(np.sort(wanted), rel=1e-4)
    assert np.abs(poles.imag).max() < 1e-4 * 5.0


def test_a_pid_at_a_limit_does_not_wind_up():
    pid, limit = Pid(10.0), 1.0
    for _ in range(500):
        action = pid.update(3.0)
        pid.unwind(action - min(action, limit))
    # The integral is such that the action exceeded the limit by its proportional part.
    assert pid.update(-1.0) < limit


def test_the_estimator_finds_the_torque_that_the_clutch_transmits_beyond_its_model():
    inertia, beyond, speed = RIGID.engine_inertia, -80.0, 200.0
    estimator = ClutchTorqueEstimator(inertia, 30.0)
    found = []
    for _ in range(100):
        found.append(estimator.correct(speed))
        estimator.predict(300.0, 250.0)
        speed += PERIOD_S * (300.0 - 250.0 - beyond) / inertia
    assert found[0] == 0.0
    assert found[-1] == pytest.approx(beyond, rel=1e-6)
    # What a double pole p leaves after 10 steps.
    pole = math.exp(-30.0 * PERIOD_S)
    assert 1.0 - found[10] / beyond == pytest.approx(pole**10 * (1.0 + 10.0 * (1.0 - pole)))


def test_the_slow_clutch_passes_constant_slip_at_once_and_the_rest_as_a_low_pass():
    clutch = SlowClutch(ControllerContext(SETTINGS.known, {}), 0.5)
    now = measurement()
    static = constant_slip_torque(DRIVELINE, now.engine_torque, now.load_torque)
    wanted = RIGID.constant_slip_acceleration(now) + 10.0
    torques = [clutch.torque(now, wanted) for _ in range(600)]
    assert torques[0] == pytest.approx(static)
    assert torques[-1] == pytest.approx(static + 10.0 * RIGID.vehicle_inertia)
    corner = RIGID.rigid_below_rad_s / 2.0
    passed = (torques[50] - static) / (torques[-1] - static)
    assert passed == pytest.approx(1.0 - (1.0 + corner * 0.5) * math.exp(-corner * 0.5))


@pytest.mark.parametrize('actuator', ACTUATORS.values(), ids=ACTUATORS)
def test_the_slow_clutch_knows_the_torque_and_the_lag_of_its_actuator(actuator):
    settings = RunSettings(KnownSettings(load_scenario('thesis', keys_of(actuator))))
    clutch = SlowClutch(ControllerContext(settings.known, {}), 0.5)
    corner = RIGID.rigid_below_rad_s / 2.0
    assert clutch.pid.derivative == pytest.approx(2.0 * 0.5 * (2.0 / corner + actuator.lag_s))
    first = initial_request(settings.known)
    plant = Actuator(first, actuator)
    for request in (first + 50.0, first, first + 20.0, first + 80.0):
        nodes = plant.update(request)
        assert clutch.nominal(request) == pytest.approx(np.trapezoid(nodes) / SUBSTEPS)


def share(clutch_lag_s=PRINTED_ACTUATOR.lag_s, **authority):
    return EngineShare(RIGID, EngineAuthority(**authority), 10.0, clutch_lag_s)


def taken_over(clutch_lag_s):
    """Return what the clutch takes over of an engine without authority in the first period."""
    engine = share(clutch_lag_s, deviation_n_m=0.0)
    engine.update(measurement(), 270.0, 5.0, 0.0)
    return engine.clutch_torque


def test_the_clutch_takes_over_more_slowly_the_more_it_lags_but_never_faster_than_as_printed():
    usual = taken_over(PRINTED_ACTUATOR.lag_s)
    assert taken_over(FAST.lag_s) == usual
    slower = TAKEOVER_LAG_RAD / SLOW.lag_s / TAKEOVER_BANDWIDTH_RAD_S
    assert slower < 0.6
    assert taken_over(SLOW.lag_s) == pytest.approx(slower * usual, rel=0.01)


def test_an_engine_with_authority_leaves_nothing_to_the_clutch():
    engine = share()
    request, delivered = engine.update(measurement(), 250.0, 5.0, -100.0)
    assert request == delivered
    assert not engine.at_its_limit
    assert engine.clutch_torque == 0.0


def test_a_lag_alone_is_no_limit():
    engine = share(lag_s=0.1)
    request, delivered = engine.update(measurement(), 250.0, 5.0, -100.0)
    assert request != delivered
    assert not engine.at_its_limit


@pytest.mark.parametrize(('slip_error', 'sign'), [(5.0, -1.0), (-5.0, 1.0)])
def test_the_clutch_supplies_what_the_engine_cannot(slip_error, sign):
    """Too little slip needs less clutch torque; in the end K_p times the error is lacking."""
    engine = share(deviation_n_m=0.0)
    for _ in range(300):
        _, delivered = engine.update(measurement(), 270.0, slip_error, 0.0)
    assert delivered == measurement().engine_torque
    assert engine.at_its_limit
    before = engine.clutch_torque
    engine.update(measurement(), 270.0, slip_error, 0.0)
    integral_part = engine.clutch_torque - before
    assert sign * before > 0.0
    # w^2/(4 g) per rad/s of slip and second.
    assert integral_part == pytest.approx(
        -slip_error * PERIOD_S * 25.0 / (4.0 * RIGID.slip_gain), rel=1e-3
    )


def test_an_engagement_ends_at_rest_for_the_least_squared_moves():
    """The program's requests, each held over its periods, bring the model's slip to zero."""
    model = transmission_model(DRIVELINE)
    horizon = 60
    program = engagement_programs(model, horizon, horizon)[horizon]
    ratio, shaft_rate = DRIVELINE.gear.total_ratio, (270.0 - DRIVELINE.gear.wheel_speed(60.0))
    shaft_rate /= RIGID.vehicle_inertia
    shaft_torque = ratio * (270.0 - DRIVELINE.shaft_inertia * shaft_rate)
    twist = shaft_torque / DRIVELINE.halfshaft_stiffness
    state = model.at_rest((240.0, 190.0, 190.0 / ratio), twist, 270.0)
    known = (270.0, 300.0, 60.0, 0.0)
    moves = (
        make_backend(DEFAULT_BACKEND, program.structure)
        .solve(
            program.gradient @ np.concatenate((state, known)),
            np.full(MOVES, -270.0),
            np.full(MOVES, np.inf),
        )
        .z
    )
    slips, request = [], 270.0
    for period in range(horizon):
        if period % (horizon // MOVES) == 0:
            request += moves[period // (horizon // MOVES)]
        inputs = np.array([0.0, 300.0, 60.0])
        inputs[REQUEST] = request
        state = model.a @ state + model.b @ inputs
        slips.append(model.c[SLIP_SPEED] @ state)
    assert abs(slips[-1]) < 0.1
    assert abs(slips[-1] - slips[-2]) / PERIOD_S < 2.0
    assert min(slips) > -1.0, 'of 50 rad/s at the start'
