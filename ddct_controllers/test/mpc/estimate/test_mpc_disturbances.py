# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Disturbance model and observer of the offset-free predictive controllers."""

from dataclasses import replace

import numpy as np
import pytest
from refusals import refused

from ddct_controllers.interface import ControllerContext
from ddct_controllers.mpc.estimate.observer import (
    AtRest,
    Drifts,
    NoiseLevels,
    Observer,
    kalman_gain,
)
from ddct_controllers.mpc.model.disturbances import (
    offset_free_model,
    require_detectable,
    with_disturbances,
)
from ddct_controllers.mpc.model.transmission_model import (
    ENGINE_TORQUE,
    LOAD_TORQUE,
    SLIP_SPEED,
    STATES,
    TORSION_SPEED,
    transmission_model,
)
from ddct_controllers.mpc.variants import PREDICTIVE
from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')))
DRIVELINE = SETTINGS.scenario.driveline
PLANT = transmission_model(DRIVELINE)
COLUMNS = {
    'engine': PLANT.b[:, ENGINE_TORQUE],
    'clutch': PLANT.clutch,
    'load': PLANT.b[:, LOAD_TORQUE],
}


def disturbed(*names):
    return with_disturbances(PLANT, np.column_stack([COLUMNS[name] for name in names]))


@pytest.mark.parametrize(
    'names', [('clutch', 'load'), ('engine', 'load'), ('engine', 'clutch'), ('clutch',)]
)
def test_up_to_two_torques_are_determined_by_the_speeds(names):
    require_detectable(disturbed(*names))


@pytest.mark.parametrize('names', [('engine', 'clutch', 'load'), ('load', 'load')])
def test_more_are_not(names):
    with pytest.raises(ParameterError, match='do not determine'):
        require_detectable(disturbed(*names))


def test_its_disturbances_are_torques_at_the_clutch_and_at_the_wheel():
    np.testing.assert_array_equal(
        offset_free_model(DRIVELINE).a[:STATES, STATES:],
        np.column_stack([COLUMNS['clutch'], COLUMNS['load']]),
    )


def estimate(errors_n_m, drift=(), model=PLANT, periods=400, driveline=DRIVELINE):
    """Run the plant with constant torque errors; return the last innovation and estimate."""
    noise = NoiseLevels(drift=drift)
    start = AtRest(driveline.halfshaft_stiffness, initial_request=0.0)
    observer = Observer(model, kalman_gain(model, noise), start)
    plant = transmission_model(driveline)
    columns = {'engine': plant.b[:, ENGINE_TORQUE], 'clutch': plant.clutch}
    columns['load'] = plant.b[:, LOAD_TORQUE]
    state = plant.at_rest((170.0, 160.0, driveline.gear.wheel_speed(160.0)), 0.01, 0.0)
    predicted = None
    for _ in range(periods):
        corrected = observer.correct(tuple(state[:3]), load_torque=60.0)
        innovation = 0.0 if predicted is None else np.abs(state[:3] - predicted[:3]).max()
        inputs = np.array([100.0, 120.0, 60.0])
        observer.predict(tuple(inputs))
        predicted = model.a @ corrected + model.b @ inputs
        state = plant.a @ state + plant.b @ inputs
        for name, error in errors_n_m.items():
            state = state + error * columns[name]
    return innovation, corrected


OFFSET_FREE_NOISE = NoiseLevels(drift=Drifts.of(load_scenario('thesis')))
OFFSET_FREE = {'drift': OFFSET_FREE_NOISE.drift, 'model': offset_free_model(DRIVELINE)}


def test_observer_finds_the_errors_of_clutch_and_load():
    innovation, corrected = estimate({'clutch': -30.0, 'load': 200.0}, **OFFSET_FREE)
    assert corrected[STATES:] == pytest.approx([-30.0, 200.0], rel=1e-3)
    assert innovation < 1e-4


def test_an_error_of_the_engine_is_explained_by_the_pair_as_well():
    innovation, corrected = estimate({'engine': 20.0}, **OFFSET_FREE)
    assert innovation < 1e-4
    assert corrected[STATES:] == pytest.approx(
        [-20.0, DRIVELINE.gear.wheel_torque(-20.0)], rel=1e-2
    )


def test_without_disturbances_the_observer_stays_wrong():
    innovation, _ = estimate({'clutch': -30.0})
    assert innovation > 0.1


def test_every_disturbance_needs_a_drift():
    with refused(ParameterError, 'drifts'):
        kalman_gain(offset_free_model(DRIVELINE), NoiseLevels(drift=(1.0,)))


def test_the_gain_is_what_the_covariance_recursion_settles_on():
    """The recursion is Joseph's form for 5000 periods, noise by its levels: no Riccati solver."""
    model, noise = offset_free_model(DRIVELINE), OFFSET_FREE_NOISE
    columns = [
        noise.engine_torque_n_m * model.b[:, ENGINE_TORQUE],
        noise.load_torque_n_m * model.b[:, LOAD_TORQUE],
        noise.clutch_torque_n_m * model.clutch,
        13.0 * np.eye(STATES + 2)[STATES],
        47.0 * np.eye(STATES + 2)[STATES + 1],
    ]
    process = sum(np.outer(column, column) for column in columns)
    measured, error = np.eye(3, STATES + 2), noise.speed_rad_s**2 * np.eye(3)
    covariance = np.eye(STATES + 2)
    for _ in range(5000):
        gain = np.linalg.solve(measured @ covariance @ measured.T + error, measured @ covariance).T
        kept = np.eye(STATES + 2) - gain @ measured
        covariance = kept @ covariance @ kept.T + gain @ error @ gain.T
        covariance = model.a @ covariance @ model.a.T + process
    assert kalman_gain(model, noise) == pytest.approx(gain, rel=1e-6, abs=1e-9)


def test_torsion_speed_is_weighted_as_at_the_primary_shaft():
    slip, torsion = PREDICTIVE['mpc_torsion'](
        ControllerContext(SETTINGS.known, {})
    ).settings.outputs
    assert (slip.output, torsion.output) == (SLIP_SPEED, TORSION_SPEED)
    assert torsion.weight == pytest.approx(slip.weight * DRIVELINE.gear.total_ratio)


def test_each_option_changes_its_own_setting():
    options = {'torsion_weight': 0.0, 'preview': False, 'load_drift_n_m': 1.0}
    controller = PREDICTIVE['mpc_torsion'](ControllerContext(SETTINGS.known, options))
    assert controller.settings.outputs[1].weight == 0.0
    assert controller.preview_steps == 0
    default = PREDICTIVE['mpc_torsion'](ControllerContext(SETTINGS.known, {}))
    assert not np.allclose(controller.observer.gain, default.observer.gain)


@pytest.mark.parametrize('name', ['mpc_offset_free', 'mpc_torsion'])
@pytest.mark.parametrize(
    ('options', 'key'),
    [
        ({'clutch_drift_n_m': 0.0}, 'controllers.{}.clutch_drift_n_m'),
        ({'load_drift_n_m': float('nan')}, 'controllers.{}.load_drift_n_m'),
        ({'clutch_drift_n_m': 'fast'}, 'controllers.{}.clutch_drift_n_m'),
        ({'clutch_drift_n_m': 1e160}, 'controllers.{}.clutch_drift_n_m'),
        ({'drift': 1.0}, 'controllers.{}.drift'),
        ({'prediction_steps': 2}, 'MPC: control_steps'),
    ],
)
def test_bad_options_are_named(name, options, key):
    with refused(ParameterError, key=key.replace('{}', name)):
        PREDICTIVE[name](ControllerContext(SETTINGS.known, options))


def test_a_negative_torsion_weight_is_refused():
    with refused(ParameterError, key='controllers.mpc_torsion.torsion_weight'):
        PREDICTIVE['mpc_torsion'](ControllerContext(SETTINGS.known, {'torsion_weight': -1.0}))


def test_a_torsion_weight_whose_square_is_infinite_is_refused():
    with refused(ParameterError, key='controllers.mpc_torsion.torsion_weight'):
        PREDICTIVE['mpc_torsion'](ControllerContext(SETTINGS.known, {'torsion_weight': 1e200}))


def test_a_torsion_weight_is_no_key_of_the_other_controller():
    with refused(ParameterError, key='controllers.mpc_offset_free.torsion_weight'):
        PREDICTIVE['mpc_offset_free'](ControllerContext(SETTINGS.known, {'torsion_weight': 1.0}))


def test_behind_a_stiffer_half_shaft_the_errors_are_found_too():
    """It is fifteen times as stiff: the rank condition must not take it for rigid."""
    stiff = replace(DRIVELINE, halfshaft_stiffness=1e5)
    parts = {'drift': OFFSET_FREE_NOISE.drift, 'model': offset_free_model(stiff)}
    innovation, corrected = estimate({'clutch': -30.0, 'load': 200.0}, **parts, driveline=stiff)
    assert corrected[STATES:] == pytest.approx([-30.0, 200.0], rel=1e-3)
    assert innovation < 1e-4
