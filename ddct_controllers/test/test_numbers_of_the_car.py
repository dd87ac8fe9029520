# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Numbers that controllers take from the car that they know: those of the C635, and of others."""

import pytest

from ddct_controllers.interface import ControllerContext
from ddct_controllers.least_jerk.design import LeastJerkDesign
from ddct_controllers.least_jerk.options import LeastJerkOptions
from ddct_controllers.mpc.estimate.observer import Drifts
from ddct_controllers.state_of_art.lqi import noise_levels
from ddct_plant.models.clutch import FrictionParameters
from ddct_plant.scenario.control import ClosingParameters
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SMALL = (
    'vehicle.mass_kg=1150.0',
    'vehicle.wheel_radius_m=0.29',
    'friction.most_n_m=250.0',
    'engine_limits.idle_rad_s=78.54',
)
"""A small car with a small clutch."""


def design(scenario: str, *overrides: str, **gains: float) -> LeastJerkDesign:
    settings = RunSettings(KnownSettings(load_scenario(scenario, overrides)))
    values = {name: each.default for name, each in LeastJerkOptions().options.items()}
    return LeastJerkDesign.of(ControllerContext(settings.known, values | gains))


def test_the_numbers_of_the_c635_are_those_that_its_controllers_were_tuned_with():
    of_launch = design('launch')
    assert of_launch.most_request == 500.0
    assert of_launch.most_torque == 340.0
    assert of_launch.speeds.least == 80.0
    scenario = load_scenario('launch')
    assert ClosingParameters().most_request(scenario.friction) == 500.0
    assert Drifts.of(scenario) == (13.0, 47.0)
    noise = noise_levels(scenario.friction)
    assert (noise.engine_torque_n_m, noise.clutch_torque_n_m) == (30.0, 30.0)


def test_a_smaller_car_has_smaller_numbers():
    of_launch = design('launch', *SMALL)
    assert of_launch.most_request == pytest.approx(250.0 / 0.7)
    assert of_launch.most_torque == 243.0
    assert of_launch.speeds.least == 67.0
    scenario = load_scenario('launch', SMALL)
    assert Drifts.of(scenario) == (9.0, 33.0)
    assert noise_levels(scenario.friction).clutch_torque_n_m == pytest.approx(150.0 / 7.0)


def test_given_numbers_go_before_those_of_the_car():
    given = design('launch', *SMALL, most_torque_n_m=200.0, least_speed_rad_s=50.0)
    assert (given.most_torque, given.speeds.least) == (200.0, 50.0)
    assert ClosingParameters(most_n_m=400.0).most_request(FrictionParameters()) == 400.0
    assert Drifts.of(load_scenario('launch'), 3.0, 0.0) == (3.0, 0.0)


def test_an_engine_without_limits_has_no_least_speed():
    assert design('tip_in').speeds.least == 0.0
    assert design('tip_in', least_speed_rad_s=60.0).speeds.least == 60.0
