# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The gearbox: gears by number, conversions across a gear, and models that ask it."""

from dataclasses import replace

import numpy as np
import pytest
from refusals import refused

from ddct_plant.base.errors import ParameterError
from ddct_plant.models.driveline_model import clutch_to_slip, driveline_matrices
from ddct_plant.models.gearbox import C635, EngagedGear, Gearbox
from ddct_plant.models.parameters import DrivelineParameters, DrivelineSection
from ddct_plant.models.static_torque import constant_slip_torque
from ddct_plant.scenario.content import scenario_content, scenario_from_mapping
from ddct_plant.scenario.file import load_scenario

GEAR = EngagedGear(8.0)
THESIS = load_scenario('thesis')


def test_a_gear_converts_speeds_torques_and_inertias_without_loss() -> None:
    assert GEAR.shaft_speed(20.0) == 160.0
    assert GEAR.wheel_speed(160.0) == 20.0
    assert GEAR.wheel_torque(50.0) * GEAR.wheel_speed(160.0) == 50.0 * 160.0
    assert GEAR.shaft_torque(GEAR.wheel_torque(50.0)) == 50.0
    energy = GEAR.at_shaft(128.0) * GEAR.shaft_speed(20.0) ** 2
    assert energy == pytest.approx(128.0 * 20.0**2)


def test_a_torque_over_the_inertia_across_the_gear_accelerates_it() -> None:
    shaft_acceleration = GEAR.shaft_torque(400.0) / 0.5
    assert pytest.approx(shaft_acceleration) == 400.0 / GEAR.across(0.5)
    wheel_acceleration = GEAR.wheel_torque(50.0) / 128.0
    assert wheel_acceleration == pytest.approx(GEAR.shaft_speed(50.0) / 128.0)


def test_the_identified_gear_has_the_identified_ratio_and_others_the_published_ones() -> None:
    assert C635.gear(2) == C635.gear(None) == EngagedGear() == DrivelineParameters().gear
    assert C635.gear(1) == EngagedGear(3.9 * 4.118)
    assert [C635.numbers(C635.gear(number)) for number in range(1, 7)] == [
        [number] for number in range(1, 7)
    ]
    assert C635.numbers(EngagedGear(12.0)) == []


def test_each_gear_has_the_final_drive_of_its_output_shaft() -> None:
    box = Gearbox((4.0, 2.0, 1.5), (4.0, 5.0, 4.0), identified=2)
    assert box.gear(1) == EngagedGear(16.0)
    assert box.gear(3) == EngagedGear(6.0)


@pytest.mark.parametrize('ratio', [0.0, -3.0, float('nan'), float('inf'), 'second'])
def test_a_gear_without_a_positive_ratio_is_refused(ratio: float) -> None:
    with refused(ParameterError, 'driveline.total_ratio'):
        EngagedGear(ratio)


def test_the_model_of_another_gear_is_that_of_a_driveline_with_its_ratio() -> None:
    first = DrivelineParameters().in_gear(C635.gear(1))
    given = DrivelineParameters().with_values(total_ratio=3.9 * 4.118)
    assert first == given
    assert driveline_matrices(first).a.tolist() == driveline_matrices(given).a.tolist()
    assert clutch_to_slip(first) != clutch_to_slip(DrivelineParameters())
    assert constant_slip_torque(first, 100.0, 60.0) != constant_slip_torque(
        DrivelineParameters(), 100.0, 60.0
    )


def test_values_by_key_make_the_same_driveline_again() -> None:
    driveline = DrivelineParameters(engine_damping=0.02).in_gear(EngagedGear(5.0))
    assert DrivelineParameters.from_values(driveline.values()) == driveline
    section = DrivelineSection.of(driveline)
    assert section.engaged(EngagedGear(), 1.0) == driveline


def test_ratio_and_vehicle_inertia_follow_where_they_are_used() -> None:
    heavy = replace(THESIS, vehicle=replace(THESIS.vehicle, mass_kg=3000.0), gear=1)
    assert heavy.driveline.vehicle_inertia == 2.0 * THESIS.driveline.vehicle_inertia
    assert heavy.driveline.gear == C635.gear(1)
    assert heavy.driveline.engine_inertia == THESIS.driveline.engine_inertia


def test_a_given_vehicle_inertia_and_ratio_prevail() -> None:
    section = DrivelineSection(total_ratio=12.0, vehicle_inertia=180.0)
    given = replace(THESIS, given_driveline=section, gear=1)
    assert given.driveline.gear == EngagedGear(12.0)
    assert given.driveline.vehicle_inertia == 180.0


def test_a_written_scenario_has_every_value_of_the_driveline() -> None:
    assert scenario_content(THESIS)['driveline'] == DrivelineParameters().values()
    assert THESIS.given_driveline == DrivelineSection()


@pytest.mark.parametrize(
    'overrides',
    [[], ['vehicle.mass_kg=1800'], ['driveline.vehicle_inertia=180'], ['gear=1'], ['gear=2']],
)
def test_the_content_of_a_scenario_gives_back_an_equal_one(overrides: list[str]) -> None:
    scenario = load_scenario('thesis', overrides)
    again = scenario_from_mapping(scenario_content(scenario))
    assert again == scenario
    assert again.driveline == scenario.driveline


def test_a_gear_of_many_runs_converts_arrays() -> None:
    gear = object.__new__(EngagedGear)
    object.__setattr__(gear, 'total_ratio', np.array([8.0, 16.0]))
    assert gear.wheel_speed(160.0).tolist() == [20.0, 10.0]
