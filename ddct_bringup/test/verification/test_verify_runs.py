# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`verify` repeats the runs of a folder; an edit with its digest is found by the repetition."""

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from support.made_bags import edited
from verified import (
    CONTROLLER,
    RIPPLED,
    copied,
    edit_json_with_digest,
    edit_with_digest,
    make_bag,
    make_runs,
    of_another_release,
    states,
    verified,
)

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.bag.recording import Recording
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.bag.trajectory_bag import write_trajectory
from ddct_bringup.digests.digest_file import DIGESTS, read_digests
from ddct_bringup.digests.files import digests_of_files
from ddct_bringup.programs import compare, report, score, verify
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verification.request import VerificationRequest
from ddct_bringup.verification.runs import verified_runs
from ddct_controllers.from_file.with_options import with_options_text
from ddct_plant.signals.gain_changes import GainChange

pytestmark = pytest.mark.slow


@pytest.fixture(scope='module')
def runs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder of two runs of `compare`."""
    return make_runs(tmp_path_factory.mktemp('verified') / 'runs')


def test_an_untouched_folder_is_the_same_to_the_last_bit_wherever_it_is(
    runs: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    code, document, errors = verified(copied(runs, tmp_path / 'elsewhere'), capfd)
    assert (code, errors) == (0, '')
    expected = dict.fromkeys(['mpc3', 'pi', 'scores.json', 'frequency.json'], 'same_bits')
    assert states(document) == expected
    assert {file['state'] for file in document['files']} == {'same'}
    assert (document['same'], document['bound']) == (True, 0.0)
    assert document['by_digest'] == ['report.html', 'timing.json']


def test_a_bag_without_digests_is_different_and_the_reason_is_named(runs: Path) -> None:
    digests = replace(read_digests(runs), runs={})
    (found,) = verified_runs(VerificationRequest(runs / 'pi', digests, packaged_limits()))
    assert (found.run, found.state) == ('pi', 'different')
    assert found.first_difference == {'reason': 'no digests of this run'}


def test_a_bag_in_its_own_folder_has_digests_too(
    runs: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    code, document, _ = verified(copied(runs / 'pi', tmp_path / 'pi'), capfd)
    assert (code, states(document)) == (0, {'pi': 'same_bits'})


def test_the_folder_around_the_runs_of_bringup_is_verified_run_by_run(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    out = make_bag(tmp_path / 'out', '--controller', 'pi')
    make_bag(out, '--controller', 'ls8')
    code, document, _ = verified(out, capfd)
    expected = {f'{out}/ls8: ls8': 'same_bits', f'{out}/pi: pi': 'same_bits'}
    assert (code, states(document)) == (0, expected)
    (out / 'pi' / 'timing.json').write_text('{}', encoding='utf-8')
    code, document, errors = verified(out, capfd)
    assert code == 1
    assert f'{out}/pi/timing.json: altered' in errors
    assert states(document) == {f'{out}/ls8: ls8': 'same_bits'}


def test_altered_missing_and_unlisted_files_are_named(
    runs: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder = copied(runs, tmp_path / 'runs')
    (folder / 'mine.txt').touch()
    code, document, errors = verified(folder, capfd)
    assert code == 1
    assert errors == f'ddct verify: {folder}/mine.txt: unlisted\n'
    assert set(states(document).values()) == {'same_bits'}
    (folder / 'scores.json').write_text('{}', encoding='utf-8')
    (folder / 'pi' / 'pi_0.mcap').unlink()
    code, document, errors = verified(folder, capfd)
    assert (code, document['runs']) == (1, [])
    assert errors.splitlines() == [
        f'ddct verify: {folder}/mine.txt: unlisted',
        f'ddct verify: {folder}/pi/pi_0.mcap: missing',
        f'ddct verify: {folder}/scores.json: altered',
        f'ddct verify: {folder}: nothing was repeated: put the original files back',
    ]


def _raise_slip(scores: Any) -> None:
    scores['runs'][0]['metrics']['slip_final_rpm'] += 1e-6


def _other_seed(scores: Any) -> None:
    scores['runs'][1]['seed'] = 4


def _other_state(scores: Any) -> None:
    scores['runs'][1]['state'] = 'flared'


def _one_run_less(scores: Any) -> None:
    del scores['runs'][0]


@pytest.mark.parametrize(
    ('edit', 'key'),
    [
        (_raise_slip, 'runs.pi.metrics.slip_final_rpm'),
        (_other_seed, 'runs.mpc3.seed'),
        (_other_state, 'runs.mpc3.state'),
        (_one_run_less, 'runs.pi'),
    ],
)
def test_a_metric_seed_or_row_of_the_scores_edited_with_its_digest_is_found(
    runs: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str], edit: Any, key: str
) -> None:
    folder = copied(runs, tmp_path / 'runs')
    edit_json_with_digest(folder, 'scores.json', edit)
    code, document, errors = verified(folder, capfd)
    assert code == 1
    (wrong,) = [run for run in document['runs'] if run['state'] != 'same_bits']
    assert wrong['run'] == 'scores.json'
    assert wrong['first_difference']['key'].startswith(key)
    assert f'{folder}: scores.json: key {key}' in errors


def test_a_margin_edited_with_its_digest_is_found(
    runs: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    def edit(frequency: Any) -> None:
        frequency['conditions']['delay_s'] += 1e-3

    folder = copied(runs, tmp_path / 'runs')
    edit_json_with_digest(folder, 'frequency.json', edit)
    code, document, _ = verified(folder, capfd)
    assert (code, states(document)['frequency.json']) == (1, 'different')


def _rewrite_bag(folder: Path, timeout_s: str = '', **settings: object) -> None:
    """
    Write a bag anew with its digest, and with other settings, or another slip at step 60.

    With `timeout_s` it has another parameter of the actuator instead.
    """
    recording = read_bag(folder)
    nodes = dict(recording.run_info)
    if timeout_s:
        nodes['/actuator'] = {**nodes['/actuator'], 'request_timeout_s': timeout_s}
    elif not settings:
        recording.trajectory.slip_speed[60] += 1e-6
    data = edited(recording.custom_data, **settings)
    _write_anew(folder, replace(recording, custom_data=data, run_info=nodes))


def _write_anew(folder: Path, recording: Recording) -> None:
    """Write a recording with its digest in place of the bag in a folder."""
    recording.path.unlink()
    (folder / 'metadata.yaml').unlink()
    data, nodes = recording.custom_data, recording.run_info
    write_trajectory(recording.trajectory, folder, folder.name, data, nodes)
    read_digests(folder).with_files(digests_of_files(folder)).write(folder)


def test_a_signal_of_a_bag_edited_with_its_digest_is_found(
    runs: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder = copied(runs / 'pi', tmp_path / 'pi')
    _rewrite_bag(folder)
    code, document, _ = verified(folder, capfd)
    (run,) = document['runs']
    assert (code, run['state']) == (1, 'different')
    first = run['first_difference']
    assert (first['signal'], first['step']) == ('slip_speed', 60)
    assert first['recorded'] != first['repeated']


@pytest.mark.parametrize(
    ('gain', 'found'),
    [('proportional_gain', 'signal '), ('nix', 'its repetition fails: unknown gain nix: known: ')],
)
def test_a_changed_gain_is_named_where_the_repetition_with_it_differs(
    runs: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str], gain: str, found: str
) -> None:
    folder = copied(runs / 'pi', tmp_path / 'pi')
    change, recording = GainChange(gain, 0.103, 0.25, 65), read_bag(folder)
    status = tuple(
        (*pairs, change.pair) if step >= change.step else pairs
        for step, pairs in enumerate(recording.trajectory.status)
    )
    signals = {**recording.trajectory.signals, 'status': status}
    _write_anew(folder, replace(recording, trajectory=Trajectory(signals)))
    code, document, errors = verified(folder, capfd)
    assert (code, states(document)) == (1, {'pi': 'different'})
    note = f'gains changed in the run: {gain} 0.103 to 0.25 at 0.65 s'
    assert document['runs'][0]['note'] == note
    (line,) = errors.splitlines()
    assert found in line and line.endswith(f'; {note}')


def test_a_parameter_of_a_node_edited_with_its_digest_is_found(
    runs: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder = copied(runs / 'pi', tmp_path / 'pi')
    _rewrite_bag(folder, timeout_s='9.0')
    code, document, _ = verified(folder, capfd)
    (run,) = document['runs']
    assert (code, run['state']) == (1, 'different')
    assert run['first_difference']['key'] == 'run_info./actuator.request_timeout_s'


def test_a_setting_of_a_bag_edited_with_its_digest_is_found(
    runs: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder = copied(runs / 'pi', tmp_path / 'pi')
    _rewrite_bag(folder, wear_gain=1.1)
    code, document, _ = verified(folder, capfd)
    (run,) = document['runs']
    assert (code, run['state']) == (1, 'different')


def test_metadata_edited_with_its_digest_is_found(
    runs: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder = copied(runs / 'pi', tmp_path / 'pi')
    text = (folder / 'metadata.yaml').read_text(encoding='utf-8')
    edited = re.sub(r'message_count: 81', 'message_count: 82', text, count=1)
    assert edited != text
    edit_with_digest(folder, 'metadata.yaml', edited.encode())
    code, document, _ = verified(folder, capfd)
    assert code == 1
    assert document['runs'][0]['first_difference']['file'] == 'metadata.yaml'


def test_a_run_of_another_release_that_amplifies_rounding_has_a_bound_of_its_own(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """Its bound on other kernels is that of tests/nightly/verification."""
    file = tmp_path / 'rippled.py'
    file.write_text(RIPPLED.format(ripple_n_m=1e-6), encoding='utf-8')
    folder = make_bag(tmp_path / 'runs', '--controller', str(file)) / 'Rippled'
    _rewrite_bag(folder)
    of_another_release(folder)
    code, document, _ = verified(folder, capfd)
    (run,) = document['runs']
    assert (code, run['state'], document['bound']) == (0, 'same_within', 1e-9)
    assert 1e-9 < run['largest_difference'] < run['bound'] < 1e-3


def test_a_controller_file_is_found_beside_the_folder_or_by_its_option(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / 'work' / 'mine.py'
    file.parent.mkdir()
    file.write_text(CONTROLLER, encoding='utf-8')
    runs = make_bag(tmp_path / 'work' / 'runs', '--controller', str(file)) / 'Mine'
    assert verified(runs, capfd)[0] == 0
    (tmp_path / 'work').rename(tmp_path / 'moved')
    moved = tmp_path / 'moved' / 'runs' / 'Mine'
    assert verified(moved, capfd)[0] == 0
    elsewhere = copied(moved, tmp_path / 'elsewhere' / 'deep' / 'Mine')
    code, document, errors = verified(elsewhere, capfd)
    assert (code, states(document)['Mine']) == (1, 'different')
    assert 'mine.py is gone: put it back, or name its folder with --files' in errors
    assert verified(elsewhere, capfd, '--files', str(tmp_path / 'moved'))[0] == 0
    changed = tmp_path / 'moved' / 'mine.py'
    ran = tmp_path / 'ran'
    other = f'{CONTROLLER}\nopen({str(ran)!r}, "w").close()\n'
    changed.write_text(other, encoding='utf-8')
    code, _, errors = verified(moved, capfd)
    assert code == 1
    assert 'has changed since: put the old one back' in errors
    assert not ran.exists(), 'code of another file has run'


def test_a_changed_file_behind_another_one_is_refused_before_it_runs(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / 'mine.py').write_text(CONTROLLER, encoding='utf-8')
    outer = tmp_path / 'outer.yaml'
    outer.write_text(with_options_text('outer', 'mine.py', {}), encoding='utf-8')
    runs = make_bag(tmp_path / 'runs', '--controller', str(outer)) / 'outer'
    assert verified(runs, capfd)[0] == 0
    ran = tmp_path / 'ran'
    other = f'{CONTROLLER}\nopen({str(ran)!r}, "w").close()\n'
    (tmp_path / 'mine.py').write_text(other, encoding='utf-8')
    code, _, errors = verified(runs, capfd)
    assert code == 1
    assert 'base_controller_file has changed since' in errors
    assert not ran.exists(), 'code of another file has run'


def test_a_changed_module_beside_a_controller_file_is_named_as_the_cause(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    file, helper = tmp_path / 'mine.py', tmp_path / 'parts' / 'gains.py'
    file.write_text(f'from parts.gains import GAIN\n{CONTROLLER}', encoding='utf-8')
    helper.parent.mkdir()
    helper.write_text('GAIN = 0.1\n', encoding='utf-8')
    runs = make_bag(tmp_path / 'runs', '--controller', str(file)) / 'Mine'
    assert verified(runs, capfd)[0] == 0
    ran = tmp_path / 'ran'
    helper.write_text(f'GAIN = open({str(ran)!r}, "w")\n', encoding='utf-8')
    code, _, errors = verified(runs, capfd)
    assert code == 1
    assert f'controller {file}: parts/gains.py has changed since' in errors
    helper.unlink()
    assert f'controller {file}: parts/gains.py is gone' in verified(runs, capfd)[2]
    assert not ran.exists(), 'code of another file has run'


def test_a_run_that_failed_fails_again_with_the_same_reason(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / 'mine.py'
    broken = CONTROLLER.replace(
        'return Command', 'assert measurement.step < 65\n        return Command'
    )
    file.write_text(broken, encoding='utf-8')
    options = ['--controllers', f'{file},pi', '--duration', '0.8', '--headless']
    assert compare.main([*options, '--out', str(tmp_path / 'runs')]) == 1
    code, document, _ = verified(tmp_path / 'runs', capfd)
    assert (code, states(document)['Mine']) == (0, 'same_bits')

    def edit(note: Any) -> None:
        note['reason'] = 'the disk was full'

    edit_json_with_digest(tmp_path / 'runs', 'Mine/failed_run.json', edit)
    code, document, _ = verified(tmp_path / 'runs', capfd)
    assert (code, states(document)['Mine']) == (1, 'different')


@pytest.mark.parametrize('content', [b'{', b'\xff', b'[]', b'{"reason": "it stalled"}'])
def test_a_run_with_a_damaged_note_of_its_failure_is_different(
    runs: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str], content: bytes
) -> None:
    folder = copied(runs / 'pi', tmp_path / 'pi')
    edit_with_digest(folder, 'failed_run.json', content)
    code, document, _ = verified(folder, capfd)
    assert (code, states(document)) == (1, {'pi': 'different'})


def test_score_and_report_keep_the_digests_of_what_they_write(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    runs = make_runs(tmp_path / 'runs', 'pi')
    scores, page = runs / 'scores.json', runs / 'report.html'
    scores.unlink()
    assert verified(runs, capfd)[0] == 1
    assert score.main([str(runs), '--json', str(scores), '--csv', str(runs / 'pi' / 's.csv')]) == 0
    assert report.main([str(runs), '--out', str(page)]) == 0
    code, document, errors = verified(runs, capfd)
    assert (code, errors) == (0, '')
    assert states(document)['scores.json'] == 'same_bits'
    assert 'pi/s.csv' in [file['path'] for file in document['files']]


def test_scores_by_other_limits_need_these_limits(
    runs: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    def edit(scores: Any) -> None:
        scores['limits']['digest'] = '0' * 16

    folder = copied(runs, tmp_path / 'runs')
    edit_json_with_digest(folder, 'scores.json', edit)
    code, _, errors = verified(folder, capfd)
    assert code == 1
    assert 'give --limits with that file' in errors


@pytest.mark.parametrize(
    ('key', 'value'),
    [
        ('controller', 3),
        ('controller_files', 'mine.py'),
        ('handover', ['mine.py']),
        ('handover_files', 'mine.py'),
    ],
)
def test_digests_of_a_run_with_another_type_are_one_line(
    runs: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str], key: str, value: Any
) -> None:
    folder = copied(runs / 'pi', tmp_path / 'pi')
    text = (folder / DIGESTS).read_text(encoding='utf-8')
    content = json.loads(text)
    content['runs']['.'][key] = value
    (folder / DIGESTS).write_text(json.dumps(content), encoding='utf-8')
    code, _, errors = verified(folder, capfd)
    assert (code, errors.count('\n')) == (1, 1)
    assert 'it is damaged (' in errors and 'is no ' in errors


@pytest.mark.parametrize(
    ('content', 'words'),
    [
        ('', 'it is damaged (not valid JSON'),
        ('{}', 'it is damaged (KeyError'),
        ('[]', 'it is damaged'),
        ('{"schema_version": 2}', 'schema_version'),
    ],
)
def test_damaged_and_newer_digests_are_one_line(
    runs: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str], content: str, words: str
) -> None:
    folder = copied(runs / 'pi', tmp_path / 'pi')
    (folder / DIGESTS).write_text(content, encoding='utf-8')
    code, _, errors = verified(folder, capfd)
    assert (code, errors.count('\n')) == (1, 1)
    assert f'{folder}/{DIGESTS}: ' in errors
    assert words in errors


def test_folders_without_digests_are_one_line(
    runs: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    partial = copied(runs / 'pi', tmp_path / 'pi.partial')
    (partial / DIGESTS).unlink()
    earlier = copied(partial, tmp_path / 'earlier')
    for path, words in (
        (partial, 'an interrupted run left this folder'),
        (earlier, 'it was recorded before results had digests'),
        (tmp_path / 'absent', 'no such file or folder'),
        (earlier / 'metadata.yaml', 'is a file: give the folder'),
    ):
        code, _, errors = verified(path, capfd)
        assert (code, errors.count('\n')) == (1, 1)
        assert f'{path}' in errors
        assert words in errors
    assert (partial / 'pi_0.mcap').is_file()


def test_a_folder_of_another_release_is_compared_with_the_bound(
    runs: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder = copied(runs / 'pi', tmp_path / 'pi')
    text = (folder / DIGESTS).read_text(encoding='utf-8')
    content = json.loads(text)
    del content['own_digest']
    content['environment'] |= {'version': '0.0.1', 'code': 'f' * 64}
    _write_digests(folder, content)
    code, document, _ = verified(folder, capfd)
    assert (code, document['bound']) == (0, 1e-9)
    assert document['environment_differences'][0].startswith('version 0.0.1, here ')
    content['kind'] = 'a_later_one'
    _write_digests(folder, content)
    code, _, errors = verified(folder, capfd)
    assert code == 1
    assert "this version cannot verify a folder of the kind 'a_later_one'" in errors


def _write_digests(folder: Path, content: dict[str, Any]) -> None:
    """Write digests with this content, and their own digest."""
    from ddct_bringup.digests.digest_file import _digests_of

    _digests_of(content).write(folder)


def test_the_table_names_what_was_compared(runs: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert verify.main([str(runs)]) == 0
    printed = capfd.readouterr().out
    assert re.search(r'mpc3 +same bits', printed)
    assert 'every bit was compared' in printed
    assert 'By their digests alone: report.html, timing.json.' in printed
