# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The speed of a car gives those of shaft and engine; speeds that contradict are refused."""

import pytest
from refusals import refused

from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.file import load_scenario


def speeds(scenario: str, *overrides: str) -> tuple[float, float]:
    initial = load_scenario(scenario, overrides).initial
    return initial.engine_speed_rad_s, initial.shaft_speed_rad_s


def test_the_packaged_shifts_have_the_speeds_that_they_were_given_before() -> None:
    assert speeds('upshift')[1] == 161.608
    assert speeds('upshift_2_3')[1] == 204.461


@pytest.mark.parametrize(
    ('scenario', 'overrides', 'engine', 'shaft'),
    [
        ('thesis', ('initial={speed_km_h: 30}',), 242.411, 242.411),
        ('tip_in', ('initial={speed_km_h: 30, clutch_phase: locked}',), 242.411, 242.411),
        ('thesis', ('initial={speed_km_h: 30, engine_speed_rad_s: 300}',), 300.0, 242.411),
        ('thesis', ('initial={speed_km_h: 30}', 'gear=3'), 153.345, 153.345),
        ('thesis', ('initial={}',), 160.0, 160.0),
        ('thesis', ('initial={shaft_speed_rad_s: 100.1234567}',), 100.1234567, 100.1234567),
        ('upshift', ('initial.speed_km_h=30',), 416.757, 242.411),
        ('upshift', ('vehicle.wheel_radius_m=0.3',), 297.411, 172.993),
    ],
)
def test_shaft_and_engine_follow_the_speed_of_the_car(
    scenario: str, overrides: tuple[str, ...], engine: float, shaft: float
) -> None:
    assert speeds(scenario, *overrides) == (engine, shaft)


@pytest.mark.parametrize(
    ('scenario', 'overrides', 'key'),
    [
        ('upshift', ['initial.shaft_speed_rad_s=150'], 'initial.speed_km_h'),
        ('tip_in', ['initial.engine_speed_rad_s=170'], 'initial.clutch_phase'),
        ('thesis', ['initial={clutch_phase: open}'], 'initial.clutch_phase'),
        ('thesis', ['initial={speed_km_h: -1}'], 'initial.speed_km_h'),
    ],
)
def test_speeds_that_contradict_are_refused(scenario: str, overrides: list[str], key: str) -> None:
    with refused(ParameterError, key):
        load_scenario(scenario, overrides)


def test_both_speeds_of_a_car_are_named() -> None:
    words = r'speed_km_h is 20 and .*shaft_speed_rad_s is 150: .* initial\.speed_km_h=null$'
    with pytest.raises(ParameterError, match=words):
        load_scenario('upshift', ['initial.shaft_speed_rad_s=150'])
    taken_out = ('initial.speed_km_h=null', 'initial.shaft_speed_rad_s=150')
    assert speeds('upshift', *taken_out)[1] == 150.0
