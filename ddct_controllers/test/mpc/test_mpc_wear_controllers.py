# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The predictive controllers that use the estimate of the wear gain."""

from dataclasses import replace

import numpy as np
import pytest
from refusals import refused

from ddct_controllers.interface import ControllerContext, Measurement
from ddct_controllers.mpc.controller import divided
from ddct_controllers.mpc.estimate.wear_observer import WearNoise
from ddct_controllers.mpc.model.disturbances import offset_free_model, with_disturbances
from ddct_controllers.mpc.model.transmission_model import STATES, transmission_model
from ddct_controllers.mpc.program.horizon import condense
from ddct_controllers.mpc.qp.problem import QpSolution
from ddct_controllers.mpc.variants import PREDICTIVE
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')))
DRIVELINE = SETTINGS.scenario.driveline
MAKERS = {'mpc_wear': PREDICTIVE['mpc_wear'], 'mpc4_wear': PREDICTIVE['mpc4_wear']}


def make_controller(options=None, name='mpc_wear'):
    return MAKERS[name](ControllerContext(SETTINGS.known, options or {}))


@pytest.mark.parametrize('wear_gain', [0.7, 1.3])
def test_dividing_by_the_gain_gives_the_moves_of_the_worn_clutch_s_own_program(wear_gain):
    controller = make_controller()
    settings = controller.settings
    worn = transmission_model(DRIVELINE, wear_gain)
    worn = with_disturbances(worn, offset_free_model(DRIVELINE).a[:STATES, STATES:])
    weight = settings.inputs[0].move_weight * wear_gain
    own = condense(
        worn, replace(settings, inputs=(replace(settings.inputs[0], move_weight=weight),))
    )
    random = np.random.default_rng(1)
    driveline, actuator, errors = random.normal(size=4), random.normal(size=5), [-15.0, 20.0]
    before, known, target = 150.0, np.array([300.0, 70.0]), 0.0
    references = random.normal(size=settings.prediction_steps)
    given = np.concatenate([driveline, actuator, errors, [before], known, [target], references])
    scale = np.ones(len(given))
    scale[[*range(4), *range(9, 11), *range(12, 14), *range(15, len(given))]] = wear_gain
    new = controller.program
    expected = np.linalg.solve(own.structure.hessian, own.gradient @ given)
    moves = np.linalg.solve(new.structure.hessian, new.gradient @ (given / scale))
    np.testing.assert_allclose(moves, expected, rtol=1e-9)


def measurement(step, speed=170.0):
    return Measurement(
        step=step,
        engine_speed=speed,
        shaft_speed=150.0,
        wheel_speed=DRIVELINE.gear.wheel_speed(150.0),
        vehicle_speed=5.0,
        engine_torque=200.0,
        slip_reference=[20.0 - 0.5 * i for i in range(23)],
        slip_reference_rate=[-50.0] * 23,
        load_torque=60.0,
        open_loop_torque=170.0,
    )


def test_torques_that_drive_the_slip_are_divided_and_the_request_is_not():
    given, scaled = measurement(7), divided(measurement(7), 0.8)
    assert scaled.engine_torque == 250.0
    assert scaled.load_torque == 75.0
    assert np.array(scaled.slip_reference) * 0.8 == pytest.approx(given.slip_reference)
    assert np.array(scaled.slip_reference_rate) * 0.8 == pytest.approx(given.slip_reference_rate)
    kept = ('open_loop_torque', 'engine_speed', 'shaft_speed', 'wheel_speed', 'step')
    assert all(getattr(scaled, name) == getattr(given, name) for name in kept)


class Solved:
    """A solver with the same solution for every program."""

    def __init__(self, *moves):
        self._moves = np.array(moves)

    def reset(self):
        pass

    def solve(self, f, lower, upper):
        return QpSolution(self._moves, 1, 'solved')


def test_the_moves_of_the_engine_are_multiplied_by_the_gain_and_those_of_the_clutch_are_not():
    controller = make_controller(name='mpc4_wear')
    for step in range(20):
        controller.hold(measurement(step, 170.0 + 0.5 * step))
    controller.solver = Solved(2.0, 5.0)
    command = controller.update(measurement(20, 180.0))
    gain = float(dict(command.status)['wear_gain_estimate'])
    assert abs(gain - 1.0) > 0.05
    assert command.clutch_torque == pytest.approx(2.0)
    assert command.engine_torque == pytest.approx(200.0 + 5.0 * gain)
    second = controller.update(measurement(21, 180.5))
    later = float(dict(second.status)['wear_gain_estimate'])
    assert second.clutch_torque == pytest.approx(4.0)
    assert second.engine_torque == pytest.approx(200.0 + 5.0 * gain + 5.0 * later)


def test_a_reset_controller_is_a_new_one():
    used, new = make_controller(), make_controller()
    used.hold(measurement(0))
    for step in range(1, 5):
        used.update(measurement(step, 170.0 + step))
    used.reset()
    for step in range(4):
        assert used.update(measurement(step)) == new.update(measurement(step))


@pytest.mark.parametrize('name', MAKERS)
def test_status_shows_the_estimate(name):
    status = dict(make_controller(name=name).update(measurement(0)).status)
    assert float(status['wear_gain_estimate']) == 1.0
    assert float(status['wear_gain_deviation']) == pytest.approx(WearNoise().initial_gain)
    assert status['wear_gain_at_bound'] == 'false'


def test_nan_is_refused():
    with refused(DdctError, key='engine_speed'):
        make_controller().update(measurement(3, float('nan')))


@pytest.mark.parametrize('name', MAKERS)
@pytest.mark.parametrize(
    ('options', 'key'),
    [
        ({'gain_drift': -0.1}, 'gain_drift'),
        ({'gain_drift': 1e160}, 'gain_drift'),
        ({'load_drift_n_m': 'much'}, 'load_drift_n_m'),
        ({'load_drift_n_m': 1e160}, 'load_drift_n_m'),
        ({'clutch_drift_n_m': 1e160}, 'clutch_drift_n_m'),
        ({'torsion_weight': 1.0}, 'torsion_weight'),
    ],
)
def test_bad_options_are_named(options, key, name):
    with refused(ParameterError, key=f'controllers.{name}.{key}'):
        make_controller(options, name)


@pytest.mark.parametrize('name', MAKERS)
def test_the_largest_drifts_that_are_taken_leave_a_finite_estimate(name):
    controller = make_controller(
        {'gain_drift': 1.0, 'load_drift_n_m': 1e6, 'clutch_drift_n_m': 1e6}, name
    )
    for step in range(20):
        command = controller.update(measurement(step, 170.0 + step))
        assert np.isfinite(command.clutch_torque)
        assert np.isfinite(controller.observer.wear_gain_deviation)
