# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The commands on the page of a tuning run as they stand there, with the options of its cases."""

from pathlib import Path
from typing import Any

import pytest
from printed_commands import printed_commands, run_printed
from small_tuning import made_tuning

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.tuning.report.folder import PAGE
from ddct_plant.scenario.file import load_scenario, scenario_to_yaml
from ddct_plant.scenario.settings import RunSettings

pytestmark = pytest.mark.slow
pytest.importorskip('optuna', reason='Optuna, an optional extra, is absent: make tune-extra')
FILE = 'name: mine\nwith_options: {controller: pi, options: {%s}}\n'
VARIED = {
    'samples': 1,
    'vary': {
        'wear_gain': {'distribution': 'uniform', 'low': 0.9, 'high': 1.1},
        'vehicle.mass_kg': {'distribution': 'uniform', 'low': 1400, 'high': 1600},
    },
}
ENGAGED = {'engaged': {'at_least': 0.5}}
SENSORS = {'engine_speed': {'noise_rad_s': 1e-7, 'delay_s': 0.01}}


def commands_of(folder: Path) -> tuple[str, str]:
    """Return the commands of the page in a folder: to compare, and to verify."""
    compare, verify = printed_commands((folder / PAGE).read_text(encoding='utf-8'))
    return compare, verify


def compared_settings(folder: Path) -> dict[str, RunSettings]:
    """Return the settings of the runs in a folder by the name of the controller."""
    bags = {path.name: read_bag(path) for path in folder.iterdir() if path.is_dir()}
    return {name: bag.settings for name, bag in bags.items() if bag.settings}


def test_the_commands_run_for_a_controller_and_a_scenario_from_files_with_all_options(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    place = tmp_path / "the driver's own"
    place.mkdir()
    monkeypatch.chdir(place)
    scenario = load_scenario('thesis', ['duration_s=2.9'])
    Path('my car.yaml').write_text(scenario_to_yaml(scenario), encoding='utf-8')
    Path('my pi.yaml').write_text(
        FILE % 'proportional_gain: 0.2, integral_gain: 0.3', encoding='utf-8'
    )
    grid = {'gear': [2], 'sensors': [SENSORS], 'clutch': ['linear']}
    campaign = {'scenario': 'my car.yaml', 'architecture': 'feedforward', 'random': VARIED}
    campaign['grid'] = grid
    goals = {'torsion_speed_std_rpm': {'statistic': 'worst'}}
    options = {'objectives': goals, 'constraints': ENGAGED, 'trials': 2, 'campaign': campaign}
    made_tuning(Path('my tuning'), controller='my pi.yaml', **options)
    compare, verify = commands_of(Path('my tuning'))
    assert run_printed(compare) == 0
    found = compared_settings(Path('runs', 'tuned'))
    assert found.keys() == {'mine', 'mine_tuned'}
    for settings in found.values():
        assert (settings.architecture, settings.clutch) == ('feedforward', 'linear')
        assert settings.wear_gain == 1.0  # it was drawn: the nominal value
        assert settings.scenario.duration_s == 2.9
        sensors: Any = settings.scenario.sensors
        assert sensors.engine_speed.noise_rad_s == 1e-7
        assert settings.scenario.vehicle.mass_kg == scenario.vehicle.mass_kg
    assert run_printed(verify) == 0


def test_of_several_scenarios_the_command_has_the_first_and_the_page_names_the_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    grid = {'scenario': ['launch', 'launch_hot', 'launch_gentle'], 'duration_s': [2.0]}
    campaign = {'clutch': 'stick_slip', 'grid': grid, 'random': VARIED}
    Path('pi.yaml').write_text(FILE % 'proportional_gain: 0.2', encoding='utf-8')
    options = {'trials': 1, 'campaign': campaign, 'constraints': ENGAGED}
    made_tuning(Path('tuned'), controller='pi.yaml', **options)
    compare, _ = commands_of(Path('tuned'))
    assert run_printed(compare) == 0
    found = compared_settings(Path('runs', 'tuned'))
    assert found.keys() == {'mine_tuned'}  # the other one has no integral gain of its own
    assert {each.scenario.name for each in found.values()} == {'launch'}
    assert {each.clutch for each in found.values()} == {'stick_slip'}
    page = Path('tuned', PAGE).read_text(encoding='utf-8')
    assert 'The cases also have launch_hot, launch_gentle' in page
