# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The commands on the page of a tuning run as they stand there, with the options of its cases."""

from pathlib import Path
from typing import Any

import pytest
from extras import needs
from printed_commands import run_printed
from small_tuning import leave_out_pictures, made_tuning
from tuning_pages import ENGAGED, FILE, VARIED, commands_of, compared_settings

from ddct_plant.scenario.file import load_scenario, scenario_to_yaml

pytestmark = [pytest.mark.slow, needs('optuna')]
SENSORS = {'engine_speed': {'noise_rad_s': 1e-7, 'delay_s': 0.01}}


@pytest.mark.nightly
def test_the_commands_run_for_a_controller_and_a_scenario_from_files_with_all_options(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    place = tmp_path / "the driver's own"
    place.mkdir()
    monkeypatch.chdir(place)
    leave_out_pictures(monkeypatch)
    scenario = load_scenario('thesis', ['duration_s=2.9'])
    Path('my car.yaml').write_text(scenario_to_yaml(scenario), encoding='utf-8')
    Path('my pi.yaml').write_text(
        FILE % 'proportional_gain: 0.2, integral_gain: 0.3', encoding='utf-8'
    )
    grid = {'gear': [2], 'sensors': [SENSORS], 'clutch': ['linear']}
    Path('cars').mkdir()
    Path('cars', 'mine.yaml').write_text('base: ../base.yaml\n', encoding='utf-8')
    Path('base.yaml').write_text('base: c635_thesis\nload: {frontal_area_m2: 2.0}\n')
    campaign = {'scenario': 'my car.yaml', 'car': 'cars/mine.yaml', 'grid': grid}
    campaign |= {'architecture': 'feedforward', 'random': VARIED}
    goals = {'torsion_speed_std_rpm': {'statistic': 'worst'}}
    options = {'objectives': goals, 'constraints': ENGAGED, 'trials': 2, 'campaign': campaign}
    made_tuning(Path('my tuning'), controller='my pi.yaml', **options)
    compare, verify = commands_of(Path('my tuning'))
    monkeypatch.chdir('my tuning')
    assert run_printed(compare) == 0
    found = compared_settings(Path('..', 'tuned'))
    assert found.keys() == {'mine', 'mine_tuned'}
    for settings in found.values():
        assert (settings.known.architecture, settings.known.clutch) == ('feedforward', 'linear')
        assert settings.case.wear_gain == 1.0  # it was drawn: the nominal value
        assert settings.scenario.duration_s == 2.9
        assert settings.scenario.load.frontal_area_m2 == 2.0
        sensors: Any = settings.scenario.sensors
        assert sensors.engine_speed.noise_rad_s == 1e-7
        assert settings.scenario.vehicle.mass_kg == scenario.vehicle.mass_kg
    assert run_printed(verify) == 0
