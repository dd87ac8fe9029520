# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Two inputs: prediction with the engine, its limits, and its torque as input of the filter."""

import math
from dataclasses import replace

import numpy as np
import pytest
from other_actuators import FAST, LATE, SLOW, keys_of
from refusals import refused

from ddct_controllers.interface import ControllerContext, Measurement
from ddct_controllers.mpc.controller import MpcController
from ddct_controllers.mpc.costs import TwoInputCost
from ddct_controllers.mpc.estimate.observer import AtRest, NoiseLevels, Observer, kalman_gain
from ddct_controllers.mpc.estimators import make_observer
from ddct_controllers.mpc.model.transmission_model import (
    ENGINE_TORQUE,
    SLIP_ACCELERATION,
    SLIP_SPEED,
    STATES,
    transmission_model,
    with_engine,
)
from ddct_controllers.mpc.program.settings import InputTerms, OutputTerms
from ddct_controllers.mpc.variants import PREDICTIVE
from ddct_plant.base.errors import ParameterError
from ddct_plant.models.actuator import PRINTED_ACTUATOR
from ddct_plant.models.engine import Engine, EngineAuthority, EngineResponse
from ddct_plant.models.static_torque import constant_slip_torque
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.initial_state import initial_state
from ddct_plant.scenario.settings import KnownSettings, RunSettings

RUN = RunSettings(KnownSettings(load_scenario('thesis')))
MODEL = transmission_model(RUN.scenario.driveline)
MPC4 = TwoInputCost().settings()
FREE = EngineAuthority()
START = RUN.scenario.control_start_step
STIFFNESS = RUN.scenario.driveline.halfshaft_stiffness
DEMAND = RUN.scenario.engine.torque_n_m[-1]
"""Driver's demand in N m, from before control start on."""
FACTORIES = {'mpc4': PREDICTIVE['mpc4'], 'mpc4_wear': PREDICTIVE['mpc4_wear']}


def controller(authority=FREE, settings=MPC4):
    return MpcController(MODEL, make_observer(RUN.known, MODEL), settings, authority)


class Vehicle:
    """The thesis's vehicle by its sampled model, at control start after `drive_to`."""

    def __init__(self, authority=FREE):
        scenario = RUN.scenario
        self.demand_at = Engine(scenario.engine).demand
        self.engine = EngineResponse(authority)
        start = initial_state(RUN)
        (side,) = start.sides
        speeds = start.engine_speed, side.shaft_speed, start.wheel_speed
        self.step, self.load = 0, start.load_torque
        self.state = MODEL.at_rest(speeds, start.twist, side.torque_request)
        self.start_slip = 0.0

    def measure(self, rate=-110.0, length=8):
        """Return the present measurement; the reference falls from the slip at control start."""
        w_m, w_p, w_r = self.state[:3]
        demand = self.demand_at(self.step)
        ahead = 0.01 * (max(self.step - START, 0) + np.arange(length))
        return Measurement(
            step=self.step,
            engine_speed=w_m,
            shaft_speed=w_p,
            wheel_speed=w_r,
            vehicle_speed=5.4,
            engine_torque=demand,
            slip_reference=self.start_slip + rate * ahead,
            slip_reference_rate=[rate] * length,
            load_torque=self.load,
            open_loop_torque=constant_slip_torque(RUN.scenario.driveline, demand, self.load),
        )

    def advance(self, clutch_torque, engine_torque):
        demand = self.demand_at(self.step)
        delivered = self.engine.deliver(demand, engine_torque)
        self.state = MODEL.a @ self.state + MODEL.b @ [clutch_torque, delivered, self.load]
        self.step += 1
        if self.step <= START:
            self.start_slip = self.state[0] - self.state[1]
        return delivered

    def hold(self, mpc):
        now = self.measure()
        mpc.hold(now)
        self.advance(now.open_loop_torque, now.engine_torque)

    def drive_to_control_start(self, mpc):
        while self.step < START:
            self.hold(mpc)

    def answer(self, mpc):
        now = self.measure()
        command = mpc.update(now)
        self.advance(now.open_loop_torque + command.clutch_torque, command.engine_torque)
        return command


def answers(mpc, authority=FREE, steps=12):
    """Return the first commands after control start, engaged in the loop."""
    vehicle = Vehicle(authority)
    vehicle.drive_to_control_start(mpc)
    return [vehicle.answer(mpc) for _ in range(steps)]


def deviations(mpc, authority=FREE, steps=12):
    return [each.engine_torque - DEMAND for each in answers(mpc, authority, steps)]


def test_mpc4_has_the_parameters_of_section_4_3():
    assert MPC4.prediction_steps == 7
    assert MPC4.control_steps == 1
    assert [terms.output for terms in MPC4.outputs] == [SLIP_SPEED, SLIP_ACCELERATION]
    assert [terms.weight**2 for terms in MPC4.outputs] == pytest.approx([1.0, 0.05])
    assert [terms.move_weight for terms in MPC4.inputs] == [0.0, 0.0]


@pytest.mark.parametrize('lag_s', [0.0, 0.03])
def test_the_model_with_an_engine_is_the_engine_before_the_model(lag_s):
    authority = EngineAuthority(lag_s=lag_s)
    engine, model = EngineResponse(authority), with_engine(MODEL, authority.lag_share)
    rng = np.random.default_rng(1)
    x = rng.normal(size=STATES)
    state = np.concatenate((x, (300.0, 0.0)))
    for request in rng.normal(270.0, 30.0, 20):
        torque = engine.deliver(300.0, request)
        inputs = np.array([250.0, torque, 60.0])
        requested = np.array([250.0, request - 300.0, 60.0])
        np.testing.assert_allclose(
            model.c @ state + model.d @ requested, MODEL.c @ x + MODEL.d @ inputs, rtol=1e-12
        )
        x, state = MODEL.a @ x + MODEL.b @ inputs, model.a @ state + model.b @ requested
        np.testing.assert_allclose(state[:STATES], x, rtol=1e-9, atol=1e-9)
        assert state[STATES:] == pytest.approx([300.0, engine.deviation])


@pytest.mark.parametrize('name', FACTORIES)
@pytest.mark.parametrize(
    ('actuator', 'horizon'), [(PRINTED_ACTUATOR, 7), (FAST, 7), (SLOW, 12), (LATE, 16)]
)
def test_the_horizon_is_longer_in_proportion_to_the_lag_of_the_known_actuator(
    name, actuator, horizon
):
    known = KnownSettings(load_scenario('thesis', keys_of(actuator)))
    assert FACTORIES[name](ControllerContext(known, {})).settings.prediction_steps == horizon
    given = FACTORIES[name](ControllerContext(known, {'prediction_steps': 9}))
    assert given.settings.prediction_steps == 9


def test_free_it_is_the_least_squares_solution_for_a_reference_along_its_tangent():
    mpc, vehicle = controller(), Vehicle()
    vehicle.drive_to_control_start(mpc)
    now, x, step = vehicle.measure(), vehicle.state, np.zeros((STATES, 2))
    free, held, inputs = [], [], np.array([0.0, DEMAND, vehicle.load])
    for _ in range(7):
        x, step = MODEL.a @ x + MODEL.b @ inputs, MODEL.a @ step + MODEL.b[:, :2]
        free.append((MODEL.c @ x + MODEL.d @ inputs)[:2])
        held.append((MODEL.c @ step + MODEL.d[:, :2])[:2])
    along = np.array([(vehicle.start_slip - 1.1 * i, -110.0) for i in range(1, 8)])
    weights = np.array([terms.weight for terms in MPC4.outputs])
    rows = (np.array(held) * weights[:, None]).reshape(14, 2)
    rows = np.vstack([rows, [0.0, MPC4.inputs[1].target_weight]])
    wanted = np.append(((along - free) * weights).ravel(), 0.0)
    clutch, deviation = np.linalg.lstsq(rows, wanted, rcond=None)[0]
    command = mpc.update(now)
    assert command.clutch_torque + now.open_loop_torque == pytest.approx(clutch, abs=1e-6)
    assert command.engine_torque - DEMAND == pytest.approx(deviation, abs=1e-6)
    assert mpc.preview_steps == 0


def test_with_preview_it_follows_the_coming_reference():
    mpc, along = controller(settings=replace(MPC4, preview=True)), controller()
    assert mpc.preview_steps == 7
    for each in (mpc, along):
        vehicle = Vehicle()
        vehicle.drive_to_control_start(each)
    now = vehicle.measure()
    speeds = np.maximum(now.slip_reference, now.slip_reference[2])
    corner = replace(now, slip_reference=speeds, slip_reference_rate=[-110.0] * 2 + [0.0] * 6)
    previewed, continued = (each.update(corner).engine_torque for each in (mpc, along))
    assert previewed > continued + 5.0


@pytest.mark.parametrize('settings', [MPC4, replace(MPC4, control_steps=3)])
@pytest.mark.parametrize(
    'authority',
    [
        EngineAuthority(deviation_n_m=12.0),
        EngineAuthority(slew_n_m_s=300.0),
        EngineAuthority(deviation_n_m=9.0, slew_n_m_s=200.0, lag_s=0.05),
        EngineAuthority(minimum_torque_n_m=290.0, maximum_torque_n_m=400.0),
        EngineAuthority(maximum_torque_n_m=250.0, deviation_n_m=20.0),
        EngineAuthority(deviation_n_m=0.0),
        EngineAuthority(slew_n_m_s=0.0),
    ],
)
def test_it_requests_nothing_that_the_engine_cannot_deliver(authority, settings):
    mpc, engine = controller(authority, settings), EngineResponse(authority)
    for command in answers(mpc, authority):
        lowest, highest = engine.reachable(DEMAND, 1)
        requested = command.engine_torque - DEMAND
        assert lowest - 1e-6 <= requested <= highest + 1e-6
        engine.deliver(DEMAND, command.engine_torque)
    assert mpc.fallbacks == 0
    free = deviations(controller(settings=settings))
    assert max(np.abs(np.subtract(free, deviations(mpc, authority)))) > 5.0, 'a limit binds'


def test_each_move_ahead_has_the_limits_that_the_engine_can_reach_by_then():
    """They are 3, 6 and 9 N m either way, from the demand at 300 N m/s."""
    mpc = controller(EngineAuthority(slew_n_m_s=300.0), replace(MPC4, control_steps=3))
    vehicle = Vehicle()
    vehicle.drive_to_control_start(mpc)
    vehicle.answer(mpc)
    assert mpc.engine.reachable == pytest.approx(np.array([[-3.0, -6.0, -9.0], [3.0, 6.0, 9.0]]))


def test_the_clutch_supplies_the_torque_beyond_the_engines_authority():
    authority = EngineAuthority(deviation_n_m=10.0)
    free, limited = answers(controller()), answers(controller(authority), authority)
    assert sum(each.clutch_torque for each in limited) > 5.0 + sum(
        each.clutch_torque for each in free
    )


def test_the_filter_receives_the_torque_that_the_engine_delivers():
    engine_torques = []

    class InputRecorder(Observer):
        def predict(self, inputs):
            engine_torques.append(inputs[ENGINE_TORQUE])
            super().predict(inputs)

    gain = kalman_gain(MODEL, NoiseLevels())
    observer = InputRecorder(MODEL, gain, AtRest(STIFFNESS, initial_request=0.0))
    authority = EngineAuthority(lag_s=0.05, slew_n_m_s=400.0)
    mpc = MpcController(MODEL, observer, MPC4, authority)
    commands, engine = answers(mpc, authority), EngineResponse(authority)
    delivered = [engine.deliver(DEMAND, command.engine_torque) for command in commands]
    assert engine_torques[START:] == delivered
    shown = [dict(command.status)['engine_torque_deviation_n_m'] for command in commands]
    assert shown == [repr(torque - DEMAND) for torque in delivered]


def test_on_hold_the_engine_goes_back_to_the_demand_at_its_rate():
    authority = EngineAuthority(slew_n_m_s=500.0)
    mpc, vehicle = controller(authority), Vehicle(authority)
    vehicle.drive_to_control_start(mpc)
    last = [vehicle.answer(mpc) for _ in range(3)][-1].engine_torque - DEMAND
    assert last == pytest.approx(-15.0)
    vehicle.hold(mpc)
    assert vehicle.engine.deviation == pytest.approx(-10.0)
    resumed = mpc.update(vehicle.measure(rate=200.0)).engine_torque - DEMAND
    assert resumed == pytest.approx(-5.0)


def test_the_pull_alone_keeps_the_engine_on_the_demand():
    outputs = tuple(OutputTerms(terms.output, 0.0) for terms in MPC4.outputs)
    inputs = (InputTerms(move_weight=1.0), MPC4.inputs[1])
    mpc = controller(settings=replace(MPC4, outputs=outputs, inputs=inputs))
    assert deviations(mpc) == pytest.approx([0.0] * 12, abs=1e-9)


@pytest.mark.parametrize('name', FACTORIES)
def test_a_reset_controller_is_a_new_one(name):
    make, context = FACTORIES[name], ControllerContext(RUN.known, {})
    mpc = make(context)
    first = answers(mpc)
    mpc.reset()
    assert answers(mpc) == first == answers(make(context))


def test_one_input_is_refused():
    with refused(ParameterError, 'inputs'):
        controller(settings=replace(MPC4, inputs=MPC4.inputs[:1]))


@pytest.mark.parametrize('iteration_limit', [None, 1])
def test_the_rate_of_the_clutch_goes_before_its_level(iteration_limit):
    """The engine is limited too; with and without a solution."""
    clutch = replace(MPC4.inputs[0], highest=200.0, rate_n_m_s=400.0)
    authority = EngineAuthority(deviation_n_m=12.0, slew_n_m_s=300.0)
    settings = replace(
        MPC4, inputs=(clutch, MPC4.inputs[1]), control_steps=3, iteration_limit=iteration_limit
    )
    mpc, vehicle = controller(authority, settings), Vehicle(authority)
    vehicle.drive_to_control_start(mpc)
    request = vehicle.measure().open_loop_torque
    while request > 204.0:
        before, open_loop = request, vehicle.measure().open_loop_torque
        request = open_loop + vehicle.answer(mpc).clutch_torque
        assert request == pytest.approx(before - 4.0, abs=1e-5)
    assert open_loop + vehicle.answer(mpc).clutch_torque <= 200.0 + 1e-6
    assert (mpc.fallbacks > 0) == (iteration_limit == 1)


def test_without_a_solution_the_plan_is_followed_within_the_limits_and_counted():
    authority = EngineAuthority(deviation_n_m=12.0)
    settings = replace(MPC4, iteration_limit=1, control_steps=3)
    mpc = controller(authority, settings)
    requested = deviations(mpc, authority)
    assert mpc.fallbacks > 0
    assert max(map(abs, requested)) <= 12.0 + 1e-9


@pytest.mark.parametrize('name', FACTORIES)
@pytest.mark.parametrize(
    ('options', 'key'),
    [
        ({'demand': 1.0}, 'controllers.{}.demand'),
        ({'demand_weight': -1.0}, 'controllers.{}.demand_weight'),
        ({'demand_weight': 1e200}, 'controllers.{}.demand_weight'),
        ({'prediction_steps': 1}, 'MPC: prediction_steps'),
        ({'demand_weight': 'some'}, 'controllers.{}.demand_weight'),
        ({'slip_acceleration_weight': math.nan}, 'controllers.{}.slip_acceleration_weight'),
        ({'preview': 1}, 'controllers.{}.preview'),
        ({'control_steps': 8}, 'MPC: control_steps'),
    ],
)
def test_bad_options_are_named(name, options, key):
    with refused(ParameterError, key=key.replace('{}', name)):
        FACTORIES[name](ControllerContext(RUN.known, options))


def test_options_reach_the_program():
    options = {'slip_acceleration_weight': 0.05, 'demand_weight': 0.3, 'preview': True}
    settings = PREDICTIVE['mpc4'](ControllerContext(RUN.known, options)).settings
    assert settings.outputs[1].weight == 0.05
    assert settings.inputs[1].target_weight == 0.3
    assert settings.preview


def test_the_estimate_of_the_wear_is_shown():
    mpc = PREDICTIVE['mpc4_wear'](ControllerContext(RUN.known, {}))
    shown = float(dict(answers(mpc)[-1].status)['wear_gain_estimate'])
    assert 0.5 <= shown <= 1.5
    assert shown == mpc.observer.wear_gain
