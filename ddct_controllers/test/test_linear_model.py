# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The linear model of a controller gives the torques of its updates."""

import numpy as np
import pytest
from linear_controllers import LINEAR

from ddct_controllers.interface import Command, Controller, Measurement
from ddct_controllers.registry import controller_names, make_controller
from ddct_plant.base.units import rad_s_from_rpm
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')))


def torque(controller: Controller, error_rpm: float) -> float:
    measurement = Measurement(
        step=0,
        engine_speed=-rad_s_from_rpm(error_rpm),
        shaft_speed=0.0,
        wheel_speed=0.0,
        vehicle_speed=0.0,
        engine_torque=0.0,
        slip_reference=[0.0] * (controller.preview_steps + 1),
        slip_reference_rate=[0.0] * (controller.preview_steps + 1),
    )
    return controller.update(measurement).clutch_torque


def test_the_printed_controllers_and_the_pi_are_linear():
    assert {'pi', *(f'ls{i}' for i in range(1, 10)), 'hinf1', 'hinf2', 'hinf3'} <= set(LINEAR)


def test_the_linear_controllers_are_those_with_a_linear_model():
    made = {name: make_controller(name, SETTINGS.known) for name in controller_names()}
    assert [name for name in made if made[name].linear_model() is not None] == LINEAR


@pytest.mark.parametrize('name', LINEAR)
def test_it_gives_the_torques_that_the_controller_gives(name):
    """They agree within 1e-9 of the largest torque for a random error."""
    controller = make_controller(name, SETTINGS.known)
    model = controller.linear_model()
    state, expected, found = np.zeros(len(model.a)), [], []
    for error_rpm in np.random.default_rng(0).normal(size=300):
        expected.append(model.c[0] @ state + model.d[0, 0] * error_rpm)
        state = model.a @ state + model.b[:, 0] * error_rpm
        found.append(torque(controller, error_rpm))
    assert found == pytest.approx(expected, abs=1e-9 * max(map(abs, expected)))


def test_that_of_the_pi_has_its_present_gains():
    controller = make_controller('pi', SETTINGS.known)
    controller.set_gain('proportional_gain', 0.5)
    assert controller.linear_model().d[0, 0] == -0.5


def test_a_controller_without_a_linear_model_is_not_linear():
    class Constant(Controller):
        def reset(self):
            pass

        def update(self, measurement):
            return Command(1.0)

    assert Constant().linear_model() is None
