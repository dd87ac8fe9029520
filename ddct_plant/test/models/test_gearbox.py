# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The gearbox: gears by number, conversions across a gear, and models that ask it."""

from dataclasses import replace

import numpy as np
import pytest
from refusals import refused

from ddct_plant.base.errors import ParameterError
from ddct_plant.models.driveline_model import clutch_to_slip, driveline_matrices
from ddct_plant.models.gearbox import EngagedGear, Gearbox
from ddct_plant.models.parameters import DrivelineParameters, DrivelineSection
from ddct_plant.models.static_torque import constant_slip_torque
from ddct_plant.scenario.content import scenario_content, scenario_from_mapping
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.rules.shift import gears_of

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
    assert Gearbox().gear(2) == EngagedGear() == DrivelineParameters().gear
    assert Gearbox().gear(1) == EngagedGear(3.9 * 4.118)
    assert THESIS.driveline.gear == EngagedGear()


def test_a_measured_ratio_belongs_to_the_gear_that_is_near_it() -> None:
    box = Gearbox()
    assert [box.with_measured(box.gear(number)) for number in range(1, 7)] == [
        (box, number) for number in range(1, 7)
    ]
    measured, number = box.with_measured(EngagedGear(16.1))
    assert (number, measured.gear(1), measured.gear(2)) == (1, EngagedGear(16.1), box.gear(2))
    again, number = measured.with_measured(EngagedGear(9.3))
    assert (number, again.gear(1), again.gear(2)) == (2, EngagedGear(16.1), EngagedGear(9.3))


def test_a_measured_ratio_that_no_gear_has_makes_a_gearbox_of_one_gear() -> None:
    box, number = Gearbox().with_measured(EngagedGear(12.0))
    assert (box.gears, number, box.gear(1)) == (1, 1, EngagedGear(12.0))


def test_each_gear_has_the_final_drive_of_its_output_shaft() -> None:
    box = Gearbox((4.0, 2.0, 1.5), (4.0, 5.0, 4.0), (2,), (10.01,))
    assert [box.gear(number) for number in (1, 2, 3)] == [
        EngagedGear(16.0),
        EngagedGear(10.01),
        EngagedGear(6.0),
    ]


@pytest.mark.parametrize(
    ('values', 'key'),
    [
        ({'ratios': ()}, 'gearbox.ratios'),
        ({'ratios': (3.9, 2.269)}, 'gearbox.final_drives'),
        ({'ratios': (3.9, 2.269, 1.435, 0.978, 0.755, 0.0)}, 'gearbox.ratios[5]'),
        ({'measured_gears': ()}, 'gearbox.measured_ratios'),
        ({'measured_gears': (7,)}, 'gearbox.measured_gears[0]'),
        ({'measured_gears': (2.5,)}, 'gearbox.measured_gears[0]'),
        ({'measured_gears': (2, 2), 'measured_ratios': (9.3, 9.4)}, 'gearbox.measured_gears'),
    ],
)
def test_a_gearbox_that_cannot_be_is_refused(
    values: dict[str, tuple[float, ...]], key: str
) -> None:
    with refused(ParameterError, key):
        Gearbox(**values)  # type: ignore[arg-type]


OTHER = {
    'gearbox': {
        'ratios': [3.7, 2.2, 1.5],
        'final_drives': [4.4, 4.4, 3.2],
        'measured_gears': [],
        'measured_ratios': [],
    }
}


def test_a_scenario_takes_the_gears_of_its_gearbox() -> None:
    third = load_scenario('thesis', {**OTHER, 'gear': 3})
    assert third.driveline.gear == EngagedGear(1.5 * 3.2)
    assert scenario_from_mapping(scenario_content(third)) == third
    gears = {'gear': 3, 'shift.off_going_gear': 2}
    shift = load_scenario('upshift', {**OTHER, **gears})
    assert gears_of(shift).ratio == EngagedGear(2.2 * 4.4).shaft_ratio(EngagedGear(1.5 * 3.2))


@pytest.mark.parametrize(
    ('scenario', 'gears', 'key'),
    [
        ('thesis', {'gear': 4}, 'gear'),
        ('upshift', {'gear': 4, 'shift.off_going_gear': 3}, 'gear'),
        ('upshift', {'gear': 3, 'shift.off_going_gear': 4}, 'shift.off_going_gear'),
    ],
)
def test_a_car_without_a_gear_that_a_scenario_needs_is_refused(
    scenario: str, gears: dict[str, int], key: str
) -> None:
    with refused(ParameterError, key):
        load_scenario(scenario, {**OTHER, **gears})


def test_the_refusal_of_a_gear_says_how_many_the_car_has() -> None:
    with pytest.raises(ParameterError, match='gear is 9, but the car has 6 gears'):
        load_scenario('thesis', {'gear': 9})


@pytest.mark.parametrize('ratio', [0.0, -3.0, float('nan'), float('inf'), 'second'])
def test_a_gear_without_a_positive_ratio_is_refused(ratio: float) -> None:
    with refused(ParameterError, 'total_ratio'):
        EngagedGear(ratio)


def test_the_model_of_another_gear_is_that_of_a_driveline_with_its_ratio() -> None:
    first = DrivelineParameters().in_gear(Gearbox().gear(1))
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
    assert section.engaged(EngagedGear(5.0), 1.0) == driveline


def test_ratio_and_vehicle_inertia_follow_where_they_are_used() -> None:
    heavy = replace(THESIS, vehicle=replace(THESIS.vehicle, mass_kg=3000.0), gear=1)
    assert heavy.driveline.vehicle_inertia == 2.0 * THESIS.driveline.vehicle_inertia
    assert heavy.driveline.gear == Gearbox().gear(1)
    assert heavy.driveline.engine_inertia == THESIS.driveline.engine_inertia


def test_a_given_vehicle_inertia_prevails() -> None:
    given = replace(THESIS, given_driveline=DrivelineSection(vehicle_inertia=154.7), gear=1)
    assert given.driveline.gear == Gearbox().gear(1)
    assert given.driveline.vehicle_inertia == 154.7
    with refused(ParameterError, 'driveline.vehicle_inertia'):
        replace(THESIS, given_driveline=DrivelineSection(vehicle_inertia=180.0))


def test_a_written_scenario_has_every_value_of_the_driveline_but_its_ratio() -> None:
    values = DrivelineParameters().values()
    del values['total_ratio']
    assert scenario_content(THESIS)['driveline'] == values
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
