# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The controllers of the state of the art keep the rules of every controller."""

import math
from dataclasses import replace
from typing import Any

import pytest

from ddct_controllers.interface import ControllerContext, Measurement
from ddct_controllers.mpc.qp.backend import QpBackend
from ddct_controllers.mpc.qp.problem import QpSolution
from ddct_controllers.registry import controller_names, make_controller
from ddct_controllers.state_of_art.controllers import STATE_OF_ART
from ddct_controllers.state_of_art.pedal_mpc import engagement_time_s
from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')))
TWO_INPUTS = ('torque_estimator', 'decoupled_pid')


def measurement(step, engine=240.0, shaft=190.0, demand=308.0):
    slip = 50.0 - max(step - 60, 0)
    return Measurement(
        step, engine, shaft, shaft / 9.34, 6.5, demand, [slip], [-100.0], 60.0, 271.0
    )


def answers(controller):
    for step in range(60):
        controller.hold(measurement(step))
    return [controller.update(measurement(60 + i, 240.0 - i, 190.0 + i)) for i in range(30)]


def test_they_are_in_the_registry():
    assert set(STATE_OF_ART) <= set(controller_names())
    for name in STATE_OF_ART:
        assert make_controller(name, SETTINGS.known).commands_engine == (name in TWO_INPUTS)
    assert make_controller('pedal_mpc', SETTINGS.known).linear_model() is None


@pytest.mark.parametrize('name', STATE_OF_ART)
def test_a_reset_controller_is_a_new_one_to_the_bit(name):
    controller = make_controller(name, SETTINGS.known)
    first = answers(controller)
    controller.reset()
    assert answers(controller) == first == answers(make_controller(name, SETTINGS.known))
    assert len({command.clutch_torque for command in first}) == len(first)


@pytest.mark.parametrize('name', TWO_INPUTS)
def test_the_engine_makes_the_slip_fall(name):
    """It does at once, by J_m times the requested rate; the clutch follows slowly."""
    commands = {}
    for rate in (0.0, -100.0):
        controller = make_controller(name, SETTINGS.known)
        for step in range(60):
            controller.hold(measurement(step))
        commands[rate] = controller.update(replace(measurement(60), slip_reference_rate=[rate]))
    less = commands[0.0].engine_torque - commands[-100.0].engine_torque
    assert less == pytest.approx(100.0 * SETTINGS.scenario.driveline.engine_inertia)
    assert commands[0.0].clutch_torque == pytest.approx(commands[-100.0].clutch_torque, abs=0.1)
    assert ('engine_at_its_limit', 'false') in commands[0.0].status


@pytest.mark.parametrize('name', TWO_INPUTS)
def test_they_follow_an_engine_speed_that_the_scenario_gives(name):
    commands = {}
    for start in (240.0, 260.0):
        points = {'time_s': [0.6, 1.6], 'speed_rad_s': [start, start + 10.0]}
        changes = [f'engine_speed_reference.{key}={value}' for key, value in points.items()]
        controller = make_controller(name, KnownSettings(load_scenario('thesis', changes)))
        commands[start] = answers(controller)[-1]
    reference = float(dict(commands[260.0].status)['engine_speed_reference_rad_s'])
    assert reference == pytest.approx(262.9)
    assert commands[260.0].clutch_torque > commands[240.0].clutch_torque + 5.0


@pytest.mark.parametrize('pedal', [0.0, 0.25, 1.0])
def test_the_engagement_time_falls_with_the_pedal(pedal):
    settings = RunSettings(KnownSettings(load_scenario('thesis', [f'pedal_position={pedal}'])))
    context = ControllerContext(settings.known, {'slowest_engagement_s': 2.0})
    assert engagement_time_s(context) == pytest.approx(2.0 - 1.6 * pedal)
    command = answers(make_controller('pedal_mpc', settings.known))[0]
    assert float(dict(command.status)['horizon_s']) == pytest.approx(1.2 - 0.8 * pedal)


def test_the_horizon_shrinks_to_a_third_and_stays():
    controller = make_controller('pedal_mpc', SETTINGS.known)
    horizons = [
        float(dict(controller.update(measurement(step)).status)['horizon_s'])
        for step in range(58, 160)
    ]
    assert horizons[:5] == pytest.approx([0.26, 0.26, 0.8, 0.79, 0.78])
    assert horizons[-1] == 0.26
    assert sorted(horizons[2:], reverse=True) == horizons[2:]


def test_without_a_solution_the_request_stays_and_is_counted(monkeypatch):
    controller: Any = make_controller('pedal_mpc', SETTINGS.known)
    controller.hold(measurement(59))
    before = controller.update(measurement(60)).clutch_torque

    def failing(self, f, lower, upper):
        return QpSolution(f * math.nan, 7, 'iteration limit')

    monkeypatch.setattr(QpBackend, 'solve', failing)
    command = controller.update(measurement(61))
    assert command.clutch_torque == before
    status = dict(command.status)
    assert (status['qp_status'], status['fallbacks']) == ('iteration limit', '1')


@pytest.mark.parametrize(
    ('name', 'options', 'complaint'),
    [
        ('decoupled_pid', {'gain': 1.0}, 'controllers.decoupled_pid.gain is not a key'),
        ('decoupled_pid', {'slip_bandwidth_rad_s': 2.0}, 'it must be at least 5'),
        ('torque_estimator', {'estimator_bandwidth_rad_s': 1e3}, 'it must be at most 60'),
        ('torque_estimator', {'shaft_bandwidth_rad_s': math.nan}, 'shaft_bandwidth_rad_s is nan'),
        ('pedal_mpc', {'fastest_engagement_s': 0.1}, 'fastest_engagement_s is 0.1'),
        ('pedal_mpc', {'slowest_engagement_s': 0.35}, 'it must be at most slowest_engagement_s'),
        ('pedal_mpc', {'fastest_engagement_s': True}, 'fastest_engagement_s is True'),
    ],
)
def test_a_bad_option_is_named(name, options, complaint):
    scenario = replace(SETTINGS.scenario, controllers={name: options})
    with pytest.raises(ParameterError) as caught:
        make_controller(name, KnownSettings(scenario))
    assert complaint in str(caught.value)
