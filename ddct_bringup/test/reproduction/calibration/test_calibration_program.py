# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `reproduce calibration`: its output and files, and its errors."""

import dataclasses
import json
from pathlib import Path

import pytest

from ddct_bringup.programs import reproduce
from ddct_bringup.reproduction.calibration import command
from ddct_bringup.reproduction.calibration.parameters import FROZEN_GAINS
from ddct_bringup.reproduction.calibration.record import MOVES
from ddct_bringup.reproduction.calibration.record_types import (
    CalibrationRecord,
    CheckRecord,
    FitEntry,
)
from ddct_plant.files.json_records import read_json, to_json
from ddct_plant.scenario.file import load_scenario

pytestmark = pytest.mark.slow

DOCS = Path(__file__).resolve().parents[4] / 'docs'
SCENARIO = load_scenario('thesis')
RECORD = read_json(CalibrationRecord, DOCS / 'thesis' / 'calibration.json')


@pytest.fixture
def calibrated(monkeypatch):
    """Replace the calibration, which takes a minute and a half, for tests of the outputs."""
    monkeypatch.setattr(command, 'calibrate', lambda progress: RECORD)


def test_help_has_examples(capsys):
    with pytest.raises(SystemExit) as end:
        reproduce.main(['calibration', '--help'])
    assert end.value.code == 0
    assert 'examples:' in capsys.readouterr().out


@pytest.fixture
def moved(monkeypatch):
    """Let the refit of a check move each parameter by 0.1 % of its range, or as tests set it."""
    shares = dict.fromkeys(MOVES, 0.001)
    refit = FitEntry(objective=1.0, worst_residual=0.5, values={})
    whole = CheckRecord([0.6, 1.7], RECORD.residuals, 1.0, refit, shares)
    monkeypatch.setattr(command, 'check_frozen', lambda scenario, progress: whole)
    return shares


def test_quick_check_of_the_frozen_scenario_passes_and_shows_fit_residuals(
    moved, capsys, tmp_path
):
    """The refit itself is tested in tests/nightly/reproduction."""
    assert reproduce.main(['calibration', '--quick', '--json', str(tmp_path / 'check.json')]) == 0
    assert 'not reproductions' in capsys.readouterr().out
    written = json.loads((tmp_path / 'check.json').read_text())
    assert written['residuals'] == to_json(RECORD.residuals)


@pytest.mark.parametrize('sign', [1.0, -1.0])
def test_quick_check_fails_for_a_scenario_that_is_not_the_optimum(moved, capsys, sign):
    moved[MOVES[2]] = 0.02 * sign
    assert reproduce.main(['calibration', '--quick']) == 1
    errors = capsys.readouterr().err.splitlines()
    words = f'a refit moves {MOVES[2]} by {2.0 * sign:+.1f} % of its range'
    assert errors[-1].startswith(f'ddct reproduce: scenario thesis is not the optimum: {words}')


def test_json_on_standard_output_has_no_other_text(calibrated, capsys):
    assert reproduce.main(['calibration', '--json', '-']) == 0
    assert json.loads(capsys.readouterr().out) == to_json(RECORD)


def test_the_drive_that_it_writes_is_the_kept_one(calibrated, capsys, tmp_path):
    drive = tmp_path / 'thesis.yaml'
    assert reproduce.main(['calibration', '--write', str(drive)]) == 0
    assert load_scenario('thesis', drive=str(drive), overrides=['name=thesis']) == SCENARIO
    assert 'One row left out' in capsys.readouterr().out


def test_ensemble_is_written_with_what_it_predicts_and_with_progress(
    monkeypatch, capsys, tmp_path
):
    def search(frozen, progress):
        progress('centre: score window to 1.7 s')
        gains = {'controllers': {'pi': FROZEN_GAINS}}
        what = 'Centre of the region'
        return [dataclasses.replace(frozen, name='member', description=what, **gains)]

    monkeypatch.setattr(command, 'find_members', search)
    assert reproduce.main(['calibration', '--ensemble', str(tmp_path)]) == 0
    assert load_scenario(str(tmp_path / 'member.yaml')).engine == SCENARIO.engine
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
    residuals = list(RECORD.residuals)
    residuals[4] = dataclasses.replace(residuals[4], deviation=0.2)
    record = dataclasses.replace(RECORD, residuals=residuals)
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
