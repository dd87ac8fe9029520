# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `reproduce calibration`: its output and files, and its errors."""

import dataclasses
import json
from pathlib import Path

import pytest

from ddct_bringup.programs import reproduce
from ddct_bringup.reproduction.calibration import command
from ddct_plant.scenario.control import ReferenceParameters
from ddct_plant.scenario.file import load_scenario

pytestmark = pytest.mark.slow

DOCS = Path(__file__).resolve().parents[4] / 'docs'
RECORD = json.loads((DOCS / 'thesis' / 'calibration.json').read_text(encoding='utf-8'))


@pytest.fixture
def calibrated(monkeypatch):
    """Replace the calibration, which takes a minute and a half, for tests of the outputs."""
    monkeypatch.setattr(command, 'calibrate', lambda progress: RECORD)


def test_help_has_examples(capsys):
    with pytest.raises(SystemExit) as end:
        reproduce.main(['calibration', '--help'])
    assert end.value.code == 0
    assert 'examples:' in capsys.readouterr().out


def test_quick_check_of_the_frozen_scenario_passes_and_shows_fit_residuals(capsys, tmp_path):
    assert reproduce.main(['calibration', '--quick', '--json', str(tmp_path / 'check.json')]) == 0
    output = capsys.readouterr()
    assert 'not reproductions' in output.out
    assert 'local refit' in output.err
    residuals = json.loads((tmp_path / 'check.json').read_text())['residuals']
    assert [row['computed'] for row in residuals] == pytest.approx(
        [row['computed'] for row in RECORD['residuals']], rel=1e-6
    )


def test_quick_check_fails_for_a_scenario_that_is_not_the_optimum(monkeypatch, capsys):
    scenario = load_scenario('thesis')
    other = dataclasses.replace(
        scenario, reference=ReferenceParameters(scenario.reference.slope_rad_s2 + 5.0)
    )
    monkeypatch.setattr(command, 'load_scenario', lambda name: other)
    assert reproduce.main(['calibration', '--quick']) == 1
    errors = capsys.readouterr().err.splitlines()
    assert errors[-1].startswith('ddct reproduce: scenario thesis is not the optimum')


def test_json_on_standard_output_has_no_other_text(calibrated, capsys):
    assert reproduce.main(['calibration', '--json', '-']) == 0
    assert json.loads(capsys.readouterr().out) == RECORD


def test_the_scenario_that_it_writes_is_the_kept_one(calibrated, capsys, tmp_path):
    scenario = tmp_path / 'thesis.yaml'
    assert reproduce.main(['calibration', '--write', str(scenario)]) == 0
    assert load_scenario(str(scenario)) == load_scenario('thesis')
    assert 'One row left out' in capsys.readouterr().out


def test_ensemble_is_written_with_what_it_predicts_and_with_progress(
    monkeypatch, capsys, tmp_path
):
    def search(frozen, progress):
        progress('centre: score window to 1.7 s')
        return [dataclasses.replace(frozen, name='member', description='Centre of the region')]

    monkeypatch.setattr(command, 'find_members', search)
    assert reproduce.main(['calibration', '--ensemble', str(tmp_path)]) == 0
    assert load_scenario(str(tmp_path / 'member.yaml')).engine == load_scenario('thesis').engine
    record = json.loads((tmp_path / 'predictions.json').read_text())
    for name, one in record['predictions'].items():
        assert one['members'] == {'member': one['frozen']}, name
    assert capsys.readouterr().err.splitlines() == [
        'ddct reproduce calibration: centre: score window to 1.7 s',
        'ddct reproduce calibration: predictions of thesis',
        'ddct reproduce calibration: predictions of member',
        'ddct reproduce calibration: 1 admissible scenarios and predictions.json are in '
        f'{tmp_path}',
    ]


@pytest.mark.parametrize('option', ['--ensemble', '--predict'])
def test_ensemble_without_its_folder_is_refused_before_the_work(monkeypatch, capsys, option):
    monkeypatch.setattr(command, 'find_members', None)
    assert reproduce.main(['calibration', option, '/nowhere/folder']) == 1
    error = capsys.readouterr().err
    assert error.startswith('ddct reproduce: /nowhere/folder is no folder')
    assert len(error.splitlines()) == 1


def test_no_scenario_is_written_when_a_residual_is_outside_its_tolerance(
    monkeypatch, capsys, tmp_path
):
    record = json.loads(json.dumps(RECORD))
    record['residuals'][4]['deviation'] = 0.2
    monkeypatch.setattr(command, 'calibrate', lambda progress: record)
    scenario = tmp_path / 'thesis.yaml'
    assert reproduce.main(['calibration', '--write', str(scenario)]) == 1
    assert not scenario.exists()
    error = capsys.readouterr().err
    assert 'hinf1 torsion_speed_std_rpm +20.0 % is outside the tolerance' in error


@pytest.mark.parametrize('option', ['--json', '--write'])
def test_file_that_cannot_be_written_is_refused_before_the_work(monkeypatch, capsys, option):
    def no_work(progress):
        raise AssertionError('the calibration ran')

    monkeypatch.setattr(command, 'calibrate', no_work)
    assert reproduce.main(['calibration', option, '/nowhere/file']) == 1
    error = capsys.readouterr().err
    assert error.startswith('ddct reproduce: ') and '/nowhere/file' in error
    assert len(error.splitlines()) == 1


@pytest.mark.parametrize(
    'arguments',
    [
        ['--quick', '--write', 'a.yaml'],
        ['--json', '-', '--write', '-'],
        ['--ensemble', '.', '--json', '-'],
    ],
)
def test_options_that_contradict_each_other_are_refused(capsys, arguments):
    with pytest.raises(SystemExit) as end:
        reproduce.main(['calibration', *arguments])
    assert end.value.code == 2
