# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A fit that cannot be right is refused: first in the output, with an exit code, no scenario."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from samples import sampled
from support.logs import drag, identify, judged, log_of, written
from support.other_car import COLUMNS, TRUE, drive, late_log

from ddct_bringup.identification.from_log.stretches import stretches_of
from ddct_bringup.identification.from_log.verdict import doubts, reasons_against
from ddct_bringup.identification.identify import main
from ddct_bringup.logs.log import SPEEDS
from ddct_plant.program import progress

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures('each_fit_once')]


def identify_into_file(folder: Path, *options: str) -> int:
    return identify(folder, '--out', str(folder / 'mine'), *options)


SWAPPED = COLUMNS.replace('MdMot', 'X').replace('MdKup', 'MdMot').replace('X', 'MdKup')


@pytest.mark.parametrize(
    ('columns', 'reason'),
    [
        pytest.param(
            COLUMNS.replace('nMot, unit: rpm', 'nMot, unit: deg/s'),
            'rpm) in the middle, of cars it is 40 to 800 rad/s',
            id='engine rpm as deg/s',
        ),
        pytest.param(
            SWAPPED,
            'the engine slows down where engine_torque exceeds clutch_torque',
            marks=pytest.mark.nightly,
            id='swapped torques',
        ),
        pytest.param(
            COLUMNS.replace('MdKup, unit: Nm', 'MdMot, unit: Nm'),
            'the held-out',
            marks=pytest.mark.nightly,
            id='one torque twice',
        ),
    ],
)
def test_a_fit_that_cannot_be_right_is_refused_first_and_writes_nothing(
    folder: Path, capsys: pytest.CaptureFixture[str], columns: str, reason: str
) -> None:
    (folder / 'map.yaml').write_text(columns)
    report = folder / 'report.json'
    assert identify_into_file(folder, '--json', str(report)) == 1
    printed, complaint = capsys.readouterr()
    lines = printed.splitlines()
    assert lines[0].startswith('REFUSED')
    assert any(reason in line for line in lines[1:4])
    assert 'the fit is refused: ' in complaint
    assert 'nothing is written' in complaint
    assert len(complaint.splitlines()) == 1
    assert not (folder / 'mine').exists()
    content = json.loads(report.read_text())
    assert list(content)[:2] == ['verdict', 'reasons']
    assert content['verdict'] == 'refused'
    assert any(reason in each for each in content['reasons'])


def test_a_refused_fit_is_accepted_by_force_and_its_reason_still_comes_first(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = COLUMNS.replace('nMot, unit: rpm', 'nMot, unit: deg/s')
    (folder / 'map.yaml').write_text(text)
    assert identify_into_file(folder, '--force') == 0
    printed, complaint = capsys.readouterr()
    assert printed.startswith('REFUSED')
    assert complaint == ''
    assert written(folder / 'mine').name == 'drive_drive_drive_car'


def test_a_good_fit_prints_its_progress_and_is_accepted_with_new_values(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(progress, '_QUIET_S', 0.0)
    report = folder / 'report.json'
    assert identify_into_file(folder, '--json', str(report)) == 0
    printed = capsys.readouterr()
    assert printed.err.startswith('fitting the driveline, evaluations: 1')
    assert 'REFUSED' not in printed.out
    assert 'new car' in printed.out
    assert 'in scenario' not in printed.out
    content = json.loads(report.read_text())
    assert (content['verdict'], content['reasons']) == ('accepted', [])
    assert {row['state'] for row in content['delays']} == {'reference', 'fitted'}
    assert all(each['nrmse'] < 0.02 for each in content['held_out']['signals'])


def test_force_needs_a_log(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(['--force']) == 1
    assert '--force, --out and --overwrite need a log' in capsys.readouterr().err


@pytest.mark.parametrize(
    'factor', sampled([6.0, 1.0 / 6.0], every=2), ids=['deg/s as rpm', 'rpm as deg/s']
)
def test_speeds_that_are_all_wrong_by_one_factor_fit_and_are_refused_by_the_car_they_need(
    factor: float,
) -> None:
    signals = drive().noisy(0)
    signals |= {name: factor * signals[name] for name in SPEEDS}
    _, predictions, reasons = judged(signals, drive().time_s)
    assert max(each.error for each in predictions) < 0.02
    for name in ('engine_speed is ', 'engine_inertia is ', 'vehicle_inertia is '):
        assert any(each.startswith(name) and 'check' in each for each in reasons), name


def test_an_engine_damping_significantly_below_zero_is_refused_and_not_written_as_zero() -> None:
    """Every rad/s of the engine adds 0.05 N m to the torque in the log."""
    signals = drive().noisy(0)
    signals['engine_torque'] = signals['engine_torque'] - 0.05 * drive().signals['engine_speed']
    fit, _, reasons = judged(signals, drive().time_s)
    assert fit.values['engine_damping'] == pytest.approx(TRUE['engine_damping'] - 0.05, abs=2e-3)
    assert any('engine_damping is -0.0' in each and 'negative' in each for each in reasons)


def test_a_clutch_torque_above_the_torque_that_speeds_up_a_locked_engine_is_no_torque() -> None:
    signals = drive().noisy(0)
    signals['shaft_speed'] = signals['engine_speed']
    signals['clutch_torque'] = np.full_like(signals['clutch_torque'], 350.0)
    fit, predictions, reasons = judged(signals, drive().time_s)
    (reason,) = (each for each in reasons if 'exceeds' in each)
    assert 'clutch_torque exceeds engine_torque by' in reason
    assert 'is it the capacity or the request of the clutch' in reason
    assert not any('does not determine' in each for each in reasons)
    partly = replace(fit, undetermined=('engine_inertia', 'wheel_speed'))
    missed = reasons_against(partly, predictions, stretches_of(log_of(signals), drag))[1]
    assert missed.endswith('the log does not determine engine_inertia: give a log that does')


@pytest.mark.nightly
def test_a_damping_below_zero_by_chance_is_zero_in_the_scenario_with_a_note() -> None:
    signals = drive().noisy(0)
    signals['engine_torque'] = signals['engine_torque'] - 0.02 * drive().signals['engine_speed']
    fit, predictions, reasons = judged(signals, drive().time_s)
    assert reasons == []
    said = any('engine_damping is -' in each for each in doubts(fit, predictions))
    assert said == (fit.values['engine_damping'] < -1e-6)
    assert fit.parameters.engine_damping == max(fit.values['engine_damping'], 0.0)


def test_noise_with_a_memory_is_not_taken_for_a_wrong_model() -> None:
    random = np.random.default_rng(2)
    signals = drive().noisy(2)
    for name in SPEEDS:
        slow = np.convolve(random.standard_normal(len(drive().time_s)), 0.9 ** np.arange(40))
        signals[name] = signals[name] + 0.02 * slow[: len(drive().time_s)]
    assert judged(signals, drive().time_s)[2] == []


def test_a_clutch_torque_that_leads_is_named_as_a_request() -> None:
    late = {'clutch_torque': -0.035}
    times, signals = late_log(1, late, corners_on_rows=True)
    fit, predictions, _ = judged(signals, times)
    assert any('if it is a request' in each for each in doubts(fit, predictions))
