# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The road load of Section 1.4.4: the air resists as fast as it comes towards the car."""

import pytest

from ddct_plant.models.load import LoadParameters, RoadLoad, SlopeProfile
from ddct_plant.models.parameters import VehicleParameters

VEHICLE = VehicleParameters()
AIR = LoadParameters(rolling_coefficient=0.0)
DRAG = 0.5 * AIR.air_density_kg_m3 * AIR.frontal_area_m2 * AIR.drag_coefficient
"""kg/m."""


@pytest.mark.parametrize(
    ('wind', 'speed', 'relative'),
    [(0.0, 20.0, 20.0), (5.0, 20.0, 25.0), (-5.0, 20.0, 15.0), (8.0, 0.0, 8.0)],
)
def test_a_head_wind_adds_to_the_speed_of_the_car_and_a_tail_wind_takes_from_it(
    wind, speed, relative
):
    load = RoadLoad(LoadParameters(rolling_coefficient=0.0, wind_speed_m_s=wind), VEHICLE)
    expected = DRAG * relative**2 * VEHICLE.wheel_radius_m
    assert load.torque(speed) == pytest.approx(expected, rel=1e-12)


def test_a_tail_wind_stronger_than_the_car_is_fast_pushes_it():
    load = RoadLoad(LoadParameters(rolling_coefficient=0.0, wind_speed_m_s=-30.0), VEHICLE)
    assert load.torque(10.0) == pytest.approx(-DRAG * 20.0**2 * VEHICLE.wheel_radius_m)


def test_a_slope_that_changes_is_that_of_the_scenario_time():
    slope = SlopeProfile((0.0, 2.0), (0.0, 0.2))
    load = RoadLoad(AIR, VEHICLE, slope)
    constant = RoadLoad(LoadParameters(rolling_coefficient=0.0, slope_rad=0.1), VEHICLE)
    assert load.torque(3.0, 1.0) == pytest.approx(constant.torque(3.0), rel=1e-12)
    assert load.torque(0.0) == 0.0
