# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The case of a run: its keys as options and files give them, and what follows from them."""

from pathlib import Path
from typing import Any

import pytest
from refusals import refused

from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.scenario.case import case_values, with_case
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings

LAUNCH = KnownSettings(load_scenario('launch'))


def test_a_file_has_nested_and_dotted_keys_and_the_last_value_of_a_key_counts(
    tmp_path: Path,
) -> None:
    file = tmp_path / 'case.yaml'
    file.write_text('vehicle: {mass_kg: 1700}\nactuator.delay_s: 0.013\nwear_gain: 0.8\n')
    given = ['vehicle.mass_kg=1600', str(file), 'wear_gain=0.9', 'seed=4']
    assert case_values(given) == {
        'vehicle.mass_kg': 1700,
        'actuator.delay_s': 0.013,
        'wear_gain': 0.9,
        'seed': 4,
    }


def test_a_case_changes_the_true_scenario_and_what_follows_and_leaves_the_known_one() -> None:
    values = {'vehicle.mass_kg': 1700.0, 'wear_gain': 0.8, 'seed': 4}
    run = with_case(LAUNCH, values)
    assert run.known is LAUNCH
    assert (run.case.wear_gain, run.case.seed) == (0.8, 4)
    vehicle, before = run.scenario.vehicle, LAUNCH.scenario.vehicle
    assert (vehicle.mass_kg, vehicle.wheel_radius_m) == (1700.0, before.wheel_radius_m)
    inertia = 1700.0 * vehicle.wheel_radius_m * vehicle.wheel_radius_m
    assert run.scenario.driveline.vehicle_inertia == pytest.approx(inertia, rel=1e-15)
    assert with_case(LAUNCH, {}).case == CaseSettings()


def test_a_mass_of_the_case_moves_the_inertia_also_where_the_inertia_was_set() -> None:
    known = KnownSettings(load_scenario('launch', ['driveline.vehicle_inertia=170']))
    radius = known.scenario.vehicle.wheel_radius_m
    true = with_case(known, {'vehicle.mass_kg': 1700.0}).scenario
    assert known.scenario.driveline.vehicle_inertia == pytest.approx(170.0)
    assert true.vehicle.wheel_radius_m == radius
    assert true.driveline.vehicle_inertia == pytest.approx(1700.0 * radius**2)


@pytest.mark.parametrize(
    ('key', 'value', 'reason'),
    [
        ('vehicle.mas_kg', 1700.0, 'did you mean vehicle.mass_kg?'),
        ('reference.shape', 'tanh', 'the plant does not use it'),
        ('duration_s', 1.0, 'the plant does not use it'),
        ('controllers.pi.proportional_gain', 1.0, 'the plant does not use it'),
        ('clutch', 'linear', 'controllers must know it to fit the run: give it by --set'),
        ('gear', 2, 'controllers must know it to fit the run: give it by --set'),
        ('shift.off_going_gear', 2, 'controllers must know it'),
        ('architecture', 'base', 'give it by --architecture'),
    ],
)
def test_an_unknown_key_and_one_that_no_case_has_are_refused_with_the_reason(
    key: str, value: Any, reason: str
) -> None:
    with refused(ParameterError, key) as caught:
        with_case(LAUNCH, {key: value})
    assert reason in str(caught.value)
    assert '\n' not in str(caught.value)


def test_sensors_of_a_case_need_sensors_of_the_scenario() -> None:
    noise = {'sensors.engine_speed.noise_rad_s': 0.2}
    with refused(ParameterError, 'sensors'):
        with_case(LAUNCH, noise)
    known = KnownSettings(load_scenario('launch', {'sensors': {}}))
    assert with_case(known, noise).scenario.sensors != known.scenario.sensors


@pytest.mark.parametrize('text', ['- 1\n', '3\n', 'a: [\n'])
def test_a_file_without_keys_is_named(tmp_path: Path, text: str) -> None:
    file = tmp_path / 'case.yaml'
    file.write_text(text)
    with pytest.raises(DdctError, match='case.yaml'):
        case_values([str(file)])
    with pytest.raises(DdctError, match='none.yaml: cannot be read'):
        case_values([str(tmp_path / 'none.yaml')])
