# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A run of our plant, recorded by a bus logger with the DBC of a car, gives back its driveline."""

import json
from pathlib import Path

import pytest
from support.can_logs import write_bus_log

from ddct_bringup.api import Run, run
from ddct_bringup.identification.identify import main
from ddct_bringup.programs import score

pytest.importorskip('asammdf', reason='asammdf, which users install, is absent: make test has it')
WITHIN = {
    'engine_inertia': 0.02,
    'shaft_inertia': 0.12,
    'halfshaft_damping': 0.06,
    'halfshaft_stiffness': 0.02,
    'total_ratio': 0.002,
    'vehicle_inertia': 0.01,
}
"""Largest deviations of the parameters, about twice those found; damping is nearly zero."""


@pytest.fixture(scope='module')
def launch() -> Run:
    return run('pi', scenario='launch')


@pytest.fixture
def folder(launch: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the present folder with `drive.mf4`, `car.dbc` and the map guessed from them."""
    write_bus_log(tmp_path, launch.trajectory, launch.settings.scenario.vehicle.wheel_radius_m)
    monkeypatch.chdir(tmp_path)
    guess = ['--from', 'drive.mf4', '--dbc', 'car.dbc', '--guess', 'map.yaml']
    assert main(guess) == 0
    return tmp_path


def test_its_driveline_comes_out_of_frames_by_a_guessed_map(folder: Path, launch: Run) -> None:
    options = ['--from', 'drive.mf4', '--columns', 'map.yaml', '--scenario', 'launch']
    assert main([*options, '--json', 'fit.json', '--out', 'mine']) == 0
    content = json.loads((folder / 'fit.json').read_text())
    rows = {each['name']: each for each in content['parameters']}
    true = launch.settings.scenario.driveline.values()
    for name, share in WITHIN.items():
        assert rows[name]['value'] == pytest.approx(true[name], rel=share), name
        assert rows[name]['lowest'] <= true[name] <= rows[name]['highest'], name
    assert content['mass_kg'] == pytest.approx(launch.settings.scenario.vehicle.mass_kg, rel=0.01)
    delays = {each['signal']: each['delay_s'] for each in content['delays']}
    assert all(abs(each) < 0.006 for each in delays.values())
    again = run('pi', car=folder / 'mine' / 'drive_car.yaml', drive='launch')
    assert again.state == launch.state == 'engaged'
    assert again.metrics['time_to_final_lock_s'] == pytest.approx(
        launch.metrics['time_to_final_lock_s'], rel=0.02
    )


def test_the_same_log_is_scored_by_its_map(folder: Path, launch: Run) -> None:
    text = (folder / 'map.yaml').read_text()
    (folder / 'map.yaml').write_text(f'{text}run: {{control_start_s: 0.6}}\n')
    assert score.main(['drive.mf4', '--columns', 'map.yaml', '--json', 'scores.json']) == 0
    (entry,) = json.loads((folder / 'scores.json').read_text())['runs']
    jerk = entry['figures']['peak_jerk_m_s3']
    assert jerk == pytest.approx(launch.metrics['peak_jerk_m_s3'], rel=0.15)


def test_a_channel_that_is_missing_and_a_damaged_file_are_refused_in_one_line(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = (folder / 'map.yaml').read_text()
    (folder / 'other.yaml').write_text(text.replace('"EngineSpeed"', '"EngineSpead"'))
    assert main(['--from', 'drive.mf4', '--columns', 'other.yaml']) == 1
    assert 'did you mean EngineSpeed?' in capsys.readouterr().err
    (folder / 'drive.mf4').write_bytes((folder / 'drive.mf4').read_bytes()[:3000])
    assert main(['--from', 'drive.mf4', '--columns', 'map.yaml']) == 1
    assert capsys.readouterr().err.count('\n') == 1
