# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`limit` prints, writes and draws floors; what cannot be is one line."""

import io
import json
import sys

import pytest
from by_schema import require_schema

from ddct_bringup.programs.limit import main

pytestmark = pytest.mark.slow
LAUNCH = ['--scenario', 'launch', '--metrics', 'peak_jerk']
CUT = ['--set', 'engine_limits.cut_rad_s=440', '--set', 'engine_limits.resume_rad_s=390']


def test_it_prints_writes_and_draws_the_front_with_controllers_beside(tmp_path, capsys):
    file, figure = tmp_path / 'front.json', tmp_path / 'front.svg'
    outputs = ['--json', str(file), '--figure', str(figure), '--cap', 'peak_jerk=7.4']
    outputs += ['--workers', '1']
    more = ['--lock-times', '0.02,0.8,1.1', '--controllers', 'ls8,hinf2']
    assert main([*LAUNCH, *more, *outputs]) == 0
    printed = capsys.readouterr()
    document = json.loads(file.read_text())
    require_schema('limit', document)
    impossible, *possible = document['front']
    assert (impossible['lock_time_s'], impossible['least']) == (0.02, None)
    assert impossible['certificate']['kind'] == 'farkas_ray'
    for point in possible:
        assert point['least'] <= point['attained']
        assert point['gap'] == pytest.approx(100.0 * (point['attained'] / point['least'] - 1.0))
    ls8, hinf2 = document['controllers']
    assert ls8['over_floor'] == pytest.approx(ls8['value'] / ls8['least'])
    assert ls8['over_floor'] > 2.0
    assert (hinf2['least'], hinf2['over_floor']) == (None, None)
    assert hinf2['value'] > 50.0
    assert document['least_lock_times'][0]['lock_time_s'] == 0.8
    assert 'ddct limit: lock time 0.02 s: no torque request' in printed.err
    assert 'ls8' in printed.out
    assert 'a lock at 0.8 s; impossible before 0.8 s' in printed.out
    assert '<svg' in figure.read_text()


def test_standard_output_is_json_alone(capsys):
    assert main([*LAUNCH, '--lock-times', '0.9', '--json', '-']) == 0
    assert json.loads(capsys.readouterr().out)['front'][0]['lock_time_s'] == 0.9


def test_what_can_be_chosen_is_listed_and_nothing_computed(capsys):
    assert main(['--list', '--scenario', 'launch', '--json', '-']) == 0
    listed = capsys.readouterr().out
    assert {'launch,', 'ls8,'} <= {*listed.split()}
    assert '"front"' not in listed


def test_a_narrow_terminal_shows_every_number_and_leaves_out_the_kind_of_proof(monkeypatch):
    stream = io.StringIO()
    monkeypatch.setattr(stream, 'isatty', lambda: True)
    monkeypatch.setenv('COLUMNS', '50')
    monkeypatch.setattr(sys, 'stdout', stream)
    assert main([*LAUNCH, '--lock-times', '0.9']) == 0
    shown = stream.getvalue()
    assert 'not shown: proof; all with --json FILE' in shown
    assert 'weak_duality' not in shown
    assert all(name in shown for name in ('least', 'attained', 'gap', '%'))


@pytest.mark.process
def test_the_bytes_are_the_same_with_any_number_of_workers(tmp_path, monkeypatch):
    texts = []
    for workers in ('1', '3'):
        monkeypatch.setenv('DDCT_CACHE', str(tmp_path / workers))
        file = tmp_path / f'{workers}.json'
        given = ['--lock-times', '0.02,0.9', '--controllers', 'ls8', '--workers', workers]
        assert main([*LAUNCH, *given, '--json', str(file)]) == 0
        texts.append(file.read_text())
    assert texts[0] == texts[1]


@pytest.mark.nightly
@pytest.mark.parametrize(
    ('metrics', 'other'), [('peak_jerk,weighted_acceleration', 'weighted_acceleration')]
)
def test_the_proof_that_no_run_locks_then_is_the_same_for_every_metric(
    metrics, other, tmp_path, monkeypatch
):
    found = []
    for chosen in (metrics, other):
        monkeypatch.setenv('DDCT_CACHE', str(tmp_path / chosen))
        file = tmp_path / f'{chosen}.json'
        given = ['--scenario', 'launch', '--metrics', chosen, '--lock-times', '0.02,0.9']
        assert main([*given, '--workers', '1', '--json', str(file)]) == 0
        front = json.loads(file.read_text())['front']
        found += [each for each in front if each['lock_time_s'] == 0.02]
    assert [each['metric'] for each in found] == [*metrics.split(','), other]
    assert found[0]['certificate'] == found[1]['certificate'] == found[2]['certificate']


@pytest.mark.parametrize(
    ('arguments', 'words'),
    [
        ([*LAUNCH, '--lock-times', '0.02'], 'a Farkas ray'),
        (['--scenario', 'tip_in'], 'do not slip at control start'),
        (['--architecture', 'base'], 'choose the architecture detailed'),
        ([*LAUNCH, '--set', 'load.frontal_area_m2=1e7'], 'the model is unstable: its state grows'),
        ([*LAUNCH, '--set', 'load.frontal_area_m2=1e8'], 'the model is unstable: its state grows'),
        ([*LAUNCH, *CUT], 'reaches its cut, 440 rad/s, at 2.93 s: there is no floor'),
        ([*LAUNCH, '--lock-times', '9'], 'when the run ends'),
        ([*LAUNCH, '--lock-times', 'soon'], 'START:STOP:COUNT'),
        ([*LAUNCH, '--lock-times', '1:0.5:3'], 'rising'),
        (['--metrics', 'beauty'], 'beauty'),
        ([*LAUNCH, '--cap', 'peak_acceleration=1'], '--cap peak_acceleration=1'),
        ([*LAUNCH, '--figure', 'front.pdf'], '.png, .svg or .html'),
        (['--metrics', 'slip_acceleration_at_lock', '--lock-times', '1'], 'not defined'),
    ],
)
def test_what_cannot_be_is_one_line(arguments, words, capsys):
    assert main(arguments) != 0
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 1
    assert lines[0].startswith('ddct limit: ')
    assert words in lines[0]
