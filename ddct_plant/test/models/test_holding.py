# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Holding torque and the torque of air and slope add up to the road load."""

import math

import pytest
from refusals import refused

from ddct_plant.base.errors import ParameterError
from ddct_plant.models.load import (
    BrakeProfile,
    HoldingTorque,
    LoadParameters,
    RoadLoad,
    SlopeProfile,
    air_and_slope,
)
from ddct_plant.models.parameters import VehicleParameters

VEHICLE = VehicleParameters()


@pytest.mark.parametrize('slope', [-0.2, 0.0, 0.12])
@pytest.mark.parametrize('speed', [0.0, 3.0, 40.0])
def test_without_brake_rolling_and_the_rest_are_the_load_of_a_car_that_rolls_forward(slope, speed):
    load = LoadParameters(slope_rad=slope, wind_speed_m_s=3.0)
    rest = air_and_slope(load, VEHICLE).torque(speed)
    rolling = HoldingTorque(RoadLoad(load, VEHICLE), BrakeProfile()).capacity(0.0)
    assert rest + rolling == pytest.approx(RoadLoad(load, VEHICLE).torque(speed), rel=1e-13)


def test_rolling_resistance_is_that_of_the_normal_force():
    load = LoadParameters(rolling_coefficient=0.02, slope_rad=0.1)
    expected = 1500.0 * 9.81 * 0.02 * math.cos(0.1) * VEHICLE.wheel_radius_m
    found = HoldingTorque(RoadLoad(load, VEHICLE), BrakeProfile()).capacity(7.0)
    assert found == pytest.approx(expected, rel=1e-12)


def test_the_brake_is_linear_between_its_points_and_holds_its_ends():
    brake = BrakeProfile((0.5, 1.5), (1000.0, 0.0))
    found = [brake.at(time_s) for time_s in (0.0, 0.5, 1.0, 1.5, 9.0)]
    assert found == pytest.approx([1000.0, 1000.0, 500.0, 0.0, 0.0])
    rolling = HoldingTorque(RoadLoad(LoadParameters(), VEHICLE), BrakeProfile()).capacity(0.0)
    both = HoldingTorque(RoadLoad(LoadParameters(), VEHICLE), brake).capacity(1.0)
    assert both == pytest.approx(rolling + 500.0)


@pytest.mark.parametrize(
    ('times', 'torques', 'key'),
    [
        ((0.0, 0.0), (1.0, 1.0), 'brake.time_s'),
        ((1.0, 0.5), (1.0, 1.0), 'brake.time_s'),
        ((0.0,), (-1.0,), 'brake.torque_n_m[0]'),
        ((0.0,), (), 'brake.torque_n_m'),
        (('now',), (1.0,), 'brake.time_s[0]'),
    ],
)
def test_a_bad_brake_is_named(times, torques, key):
    with refused(ParameterError, key=key):
        BrakeProfile(times, torques)


def test_a_slope_over_time_is_at_each_instant_the_constant_one():
    slope = SlopeProfile((0.0, 2.0), (-0.1, 0.3))
    there = LoadParameters(slope_rad=slope.at(1.5))
    assert there.slope_rad == pytest.approx(0.2)
    load = LoadParameters()
    assert RoadLoad(load, VEHICLE, slope).torque(9.0, 1.5) == RoadLoad(there, VEHICLE).torque(9.0)
    rest = air_and_slope(load, VEHICLE, slope).torque(9.0, 1.5)
    assert rest == air_and_slope(there, VEHICLE).torque(9.0)
    brake = BrakeProfile()
    held = HoldingTorque(RoadLoad(load, VEHICLE, slope), brake).capacity(1.5)
    assert held == HoldingTorque(RoadLoad(there, VEHICLE), brake).capacity(1.5)
