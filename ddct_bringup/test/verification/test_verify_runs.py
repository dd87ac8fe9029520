# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`verify` makes the runs of a result again; an edit with its digest is found by that."""

import json
import re
import shutil
from dataclasses import replace
from importlib.resources import files
from pathlib import Path
from typing import Any

import pytest
from by_schema import require_schema, require_schemas
from edited_settings import edited
from samples import sampled
from verified import (
    CONTROLLER,
    copied,
    edit_json_with_digest,
    edit_manifest,
    edit_with_digest,
    make_bag,
    make_runs,
    of_another_release,
    states,
    verified,
)

from ddct_bringup import api
from ddct_bringup.bag.reader import read_bag
from ddct_bringup.bag.recording import Recording
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.bag.trajectory_bag import write_trajectory
from ddct_bringup.manifest.manifest import MANIFEST, finish_manifest, read_manifest
from ddct_bringup.programs import compare, report, score, verify
from ddct_controllers.from_file.with_options import with_options_text
from ddct_plant.signals.gain_changes import GainChange

pytestmark = pytest.mark.slow
ALL = ['frequency.json', 'mpc3', 'pi', 'report.html', 'scores.json']
"""What is made again of two compared runs."""


@pytest.fixture(scope='module')
def runs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder of two runs of `compare`."""
    return make_runs(tmp_path_factory.mktemp('verified') / 'runs')


@pytest.fixture(scope='module')
def bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of one run of `bringup`."""
    return make_bag(tmp_path_factory.mktemp('bag') / 'out') / 'pi'


def test_an_untouched_folder_is_the_same_to_the_last_bit_wherever_it_is(
    runs: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    found = tmp_path / 'found.json'
    code = verify.main([str(copied(runs, tmp_path / 'elsewhere')), '--json', str(found)])
    printed = capfd.readouterr()
    assert (code, printed.err) == (0, '')
    document = json.loads(found.read_text(encoding='utf-8'))
    require_schema('verify', document)
    assert states(document) == dict.fromkeys(ALL, 'same_bits')
    assert {file['state'] for file in document['files']} == {'same'}
    assert (document['same'], document['state'], document['bound']) == (True, 'same_bits', 0.0)
    assert document['by_digest'] == ['timing.json']
    assert re.search(r'mpc3 +same bits', printed.out)
    times = 'times on the wall clock (timing.json) by digest alone'
    last = f'as their digests; {times}; everything else was made again, with equal bits.'
    assert printed.out.splitlines()[-1].endswith(last)


def test_the_files_of_compared_runs_are_as_their_schemas(runs: Path) -> None:
    names = {
        'scores.json': 'scores',
        'frequency.json': 'frequency',
        'manifest.json': 'manifest_runs',
        'pi/timing.json': 'timing',
    }
    require_schemas(runs, names)


def test_a_result_has_one_manifest_and_no_path_of_this_machine(runs: Path) -> None:
    assert [path.parent for path in runs.rglob(MANIFEST)] == [runs]
    for path in runs.rglob('*'):
        if path.is_file():
            assert str(runs.parent).encode() not in path.read_bytes(), path


def test_a_part_of_a_result_names_the_result(
    runs: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    code, _, errors = verified(runs / 'pi', capfd)
    assert code == 1
    assert errors == f'ddct verify: {runs}/pi is a part of the result {runs}: give that\n'


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
    assert states(document) == dict.fromkeys(ALL, 'same_bits')
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
    sampled(
        [
            (_raise_slip, 'runs[0].metrics.slip_final_rpm'),
            (_other_seed, 'runs[1].seed'),
            (_other_state, 'runs[1].state'),
            (_one_run_less, 'runs, number of entries'),
        ],
        every=3,
    ),
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


def test_a_margin_and_a_page_edited_with_their_digests_are_found(
    runs: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    def edit(frequency: Any) -> None:
        frequency['conditions']['delay_s'] += 1e-3

    folder = copied(runs, tmp_path / 'runs')
    edit_json_with_digest(folder, 'frequency.json', edit)
    page = (folder / 'report.html').read_bytes()
    edit_with_digest(folder, 'report.html', page.replace(b'mpc3', b'mpc9', 1))
    code, document, errors = verified(folder, capfd)
    edited = ('frequency.json', 'report.html')
    found = {name for name, state in states(document).items() if state != 'same_bits'}
    assert (code, found) == (1, {*edited})
    assert {states(document)[name] for name in edited} == {'different'}
    assert f'{folder}: report.html: file report.html, line ' in errors


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


def _write_anew(folder: Path, recording: Recording, result: Path | None = None) -> None:
    """Write a recording with its digest in place of the bag in a folder, of a `result` if any."""
    recording.path.unlink()
    (folder / 'metadata.yaml').unlink()
    data, nodes = recording.custom_data, recording.run_info
    write_trajectory(recording.trajectory, folder, folder.name, data, nodes)
    finish_manifest(result or folder)


def test_a_signal_of_a_bag_edited_with_its_digest_is_found(
    bag: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder = copied(bag, tmp_path / 'pi')
    _rewrite_bag(folder)
    code, document, _ = verified(folder, capfd)
    (run,) = document['runs']
    assert (code, run['state']) == (1, 'different')
    first = run['first_difference']
    assert (first['signal'], first['step']) == ('slip_speed', 60)
    assert first['recorded'] != first['repeated']


def _of_graph(content: Any) -> None:
    """Give a run the layout of a graph, in which alone gains can be changed."""
    content['plan']['runs']['.']['layout'] = 'single-process'


@pytest.mark.parametrize(
    ('gain', 'found'),
    [('proportional_gain', 'signal '), ('nix', 'its repetition fails: unknown gain nix: known: ')],
)
def test_a_changed_gain_is_named_where_the_repetition_with_it_differs(
    bag: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str], gain: str, found: str
) -> None:
    folder = copied(bag, tmp_path / 'pi')
    change, recording = GainChange(gain, 0.103, 0.25, 65), read_bag(folder)
    status = tuple(
        (*pairs, change.pair) if step >= change.step else pairs
        for step, pairs in enumerate(recording.trajectory.status)
    )
    signals = {**recording.trajectory.signals, 'status': status}
    _write_anew(folder, replace(recording, trajectory=Trajectory(signals)))
    edit_manifest(folder, _of_graph)
    code, document, errors = verified(folder, capfd)
    assert (code, states(document)) == (1, {'pi': 'different'})
    note = f'gains changed in the run: {gain} 0.103 to 0.25 at 0.65 s'
    assert document['runs'][0]['note'] == note
    (line,) = errors.splitlines()
    assert found in line and line.endswith(f'; {note}')


def test_a_parameter_of_a_node_edited_with_its_digest_is_found(
    bag: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder = copied(bag, tmp_path / 'pi')
    _rewrite_bag(folder, timeout_s='9.0')
    code, document, _ = verified(folder, capfd)
    (run,) = document['runs']
    assert (code, run['state']) == (1, 'different')
    assert run['first_difference']['key'] == 'run_info./actuator.request_timeout_s'


def test_a_setting_of_a_bag_edited_with_its_digest_is_found(
    bag: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder = copied(bag, tmp_path / 'pi')
    _rewrite_bag(folder, wear_gain=1.1)
    code, document, errors = verified(folder, capfd)
    (run,) = document['runs']
    assert (code, run['state']) == (1, 'different')
    assert 'key settings.case.wear_gain: recorded 1.1, repeated 1.0' in errors


def test_metadata_edited_with_its_digest_is_found(
    bag: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder = copied(bag, tmp_path / 'pi')
    text = (folder / 'metadata.yaml').read_text(encoding='utf-8')
    edited = re.sub(r'message_count: 81', 'message_count: 82', text, count=1)
    assert edited != text
    edit_with_digest(folder, 'metadata.yaml', edited.encode())
    code, document, _ = verified(folder, capfd)
    assert code == 1
    assert document['runs'][0]['first_difference']['file'] == 'metadata.yaml'


@pytest.mark.parametrize('kind', sampled(['with_options', 'python', 'module'], every=3))
def test_a_result_carries_the_files_of_its_controller(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], kind: str
) -> None:
    work = tmp_path / 'work'
    (work / 'parts').mkdir(parents=True)
    file = work / 'mine.py'
    file.write_text(CONTROLLER, encoding='utf-8')
    if kind == 'with_options':
        file = work / 'parts' / 'outer.yaml'
        file.write_text(with_options_text('mine', '../mine.py', {}), encoding='utf-8')
    if kind == 'module':
        file.write_text(f'from parts.gains import GAIN\n{CONTROLLER}', encoding='utf-8')
        (work / 'parts' / 'gains.py').write_text('GAIN = 0.1\n', encoding='utf-8')
    out = make_bag(tmp_path / 'runs', '--controller', str(file))
    (folder,) = (each for each in out.iterdir() if each.is_dir())
    shutil.rmtree(work)
    moved = tmp_path / 'elsewhere' / 'deep' / 'result'
    shutil.copytree(folder, moved)
    shutil.rmtree(out)
    code, document, errors = verified(moved, capfd)
    assert (code, states(document), errors) == (0, {'result': 'same_bits'}, '')


def test_an_edited_input_is_refused_before_it_runs(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / 'mine.py'
    file.write_text(CONTROLLER, encoding='utf-8')
    folder = make_bag(tmp_path / 'runs', '--controller', str(file)) / 'Mine'
    ran = tmp_path / 'ran'
    text = f'{CONTROLLER}\nopen({str(ran)!r}, "w").close()\n'
    (folder / 'inputs' / 'mine.py').write_text(text, encoding='utf-8')
    code, _, errors = verified(folder, capfd)
    assert code == 1
    assert f'{folder}/inputs/mine.py: altered' in errors
    assert not ran.exists(), 'code of another file has run'


def test_a_controller_that_was_an_object_is_not_repeated(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    class Mine(api.Controller):
        def reset(self) -> None:
            pass

        def update(self, measurement: Any) -> api.Command:
            return api.Command(0.0)

    api.run(Mine, duration=0.8, out=tmp_path)
    code, document, errors = verified(tmp_path / 'Mine', capfd)
    assert (code, errors, document['state']) == (3, '', 'not_repeated')
    assert verify.main([str(tmp_path / 'Mine')]) == 3
    last = capfd.readouterr().out.splitlines()[-1]
    assert last.endswith(
        'not repeated: Mine (a controller that was an object of a Python program).'
    )


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


@pytest.mark.parametrize('name', ['work', 'inputs'])
def test_a_bag_with_the_name_of_a_folder_of_results_is_compared(
    bag: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str], name: str
) -> None:
    def in_folder(content: Any) -> None:
        content['plan']['runs'] = {name: content['plan']['runs']['.']}

    folder = tmp_path / 'runs'
    copied(bag, folder / name)
    (folder / name / MANIFEST).rename(folder / MANIFEST)
    edit_manifest(folder, in_folder)
    recording = read_bag(folder / name)
    recording.trajectory.slip_speed[60] += 1e-6
    _write_anew(folder / name, recording, result=folder)
    code, _, errors = verified(folder, capfd)
    assert code == 1
    assert f'{folder}: {name}: ' in errors


@pytest.mark.parametrize('content', [b'{', b'\xff', b'[]', b'{"reason": "it stalled"}'])
def test_a_run_with_a_damaged_note_of_its_failure_is_different(
    bag: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str], content: bytes
) -> None:
    folder = copied(bag, tmp_path / 'pi')
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
    assert score.main([str(runs), '--json', str(scores), '--csv', str(runs / 's.csv')]) == 0
    assert report.main([str(runs), '--out', str(page)]) == 0
    code, document, errors = verified(runs, capfd)
    assert (code, errors) == (3, '')
    left = {name: state for name, state in states(document).items() if state != 'same_bits'}
    assert left == {'s.csv': 'not_repeated'}


def test_a_result_carries_its_limits(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / 'mine.yaml'
    file.write_bytes((files('ddct_bringup.verdict') / 'limits.yaml').read_bytes() + b'\n')
    folder = make_runs(tmp_path / 'runs', 'pi', '--limits', str(file))
    file.unlink()
    assert verified(folder, capfd)[0] == 0

    def edit(scores: Any) -> None:
        scores['limits']['digest'] = '0' * 16

    edit_json_with_digest(folder, 'scores.json', edit)
    code, document, _ = verified(folder, capfd)
    assert (code, states(document)['scores.json']) == (1, 'different')


@pytest.mark.parametrize(
    ('key', 'value', 'words'),
    [
        ('controller', 3, 'runs...controller is 3'),
        ('settings', 'fast', 'runs...settings is '),
        ('scenario', {}, 'key name is missing'),
        ('layout', 'fast', "unknown layout 'fast': choose from processes, single-process"),
    ],
)
def test_a_plan_with_another_type_is_one_line(
    bag: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str], key: str, value: Any, words: str
) -> None:
    def edit(content: Any) -> None:
        content['plan']['runs']['.'][key] = value

    folder = copied(bag, tmp_path / 'pi')
    edit_manifest(folder, edit)
    code, _, errors = verified(folder, capfd)
    assert (code, errors.count('\n')) == (1, 1)
    assert words in errors


@pytest.mark.parametrize(
    ('content', 'words'),
    [
        ('', 'not valid JSON'),
        ('{}', 'schema_version'),
        ('[]', 'a list'),
        ('{"schema_version": 2}', 'schema_version'),
        ('{"schema_version": 1}', 'is missing'),
    ],
)
def test_a_damaged_or_newer_manifest_is_one_line(
    bag: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str], content: str, words: str
) -> None:
    folder = copied(bag, tmp_path / 'pi')
    (folder / MANIFEST).write_text(content, encoding='utf-8')
    code, _, errors = verified(folder, capfd)
    assert (code, errors.count('\n')) == (1, 1)
    assert f'{folder}/{MANIFEST}: ' in errors
    assert words in errors


def test_a_folder_without_a_complete_result_is_one_line(
    bag: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    partial = copied(bag, tmp_path / 'pi.partial')
    (partial / MANIFEST).unlink()
    earlier = copied(partial, tmp_path / 'earlier')
    running = copied(bag, tmp_path / 'running')
    replace(read_manifest(running), state='running').write(running)
    for path, words in (
        (partial, 'an interrupted run left it'),
        (earlier, 'it is no result, or that was lost'),
        (running, 'it is not complete'),
        (tmp_path / 'absent', 'no such file or folder'),
        (earlier / 'metadata.yaml', 'is a file: give the folder'),
    ):
        code, _, errors = verified(path, capfd)
        assert (code, errors.count('\n')) == (1, 1)
        assert f'{path}' in errors
        assert words in errors
    assert (partial / 'pi_0.mcap').is_file()


def test_a_folder_of_another_release_is_compared_within_the_bound_and_its_page_is_not(
    runs: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder = copied(runs, tmp_path / 'runs')
    of_another_release(folder)
    edit_with_digest(folder, 'report.html', b'<!DOCTYPE html>')
    code, document, _ = verified(folder, capfd)
    assert (code, document['bound'], document['state']) == (3, 1e-9, 'not_repeated')
    assert document['environment_differences'][0].startswith('code ffffffffff, here ')
    assert states(document)['report.html'] == 'not_repeated'


@pytest.mark.parametrize(('change', 'code'), [(1e-12, 3), (1e-5, 1)])
def test_a_signal_of_another_release_may_differ_within_the_bound(
    bag: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str], change: float, code: int
) -> None:
    folder = copied(bag, tmp_path / 'pi')
    recording = read_bag(folder)
    recording.trajectory.slip_speed[60] *= 1.0 + change
    _write_anew(folder, recording)
    of_another_release(folder)
    assert verify.main([str(folder)]) == code
    printed = capfd.readouterr()
    if code == 3:
        last = printed.out.splitlines()[-1]
        assert 'pi within 1e-09 of each peak; made with code ffffffffff, here ' in last
    else:
        assert 'signal slip_speed, step 60' in printed.err


def test_a_bag_of_another_commit_and_code_is_compared_by_its_content(
    bag: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder = copied(bag, tmp_path / 'pi')
    recording = read_bag(folder)
    data = {**recording.custom_data, 'commit': 'f' * 40, 'version': '0.9.0'}
    _write_anew(folder, replace(recording, custom_data=data))
    of_another_release(folder)
    code, document, errors = verified(folder, capfd)
    assert (code, states(document), errors) == (0, {'pi': 'same_bits'}, '')
    text = (folder / 'metadata.yaml').read_text(encoding='utf-8')
    changed = text.replace('message_count: 81', 'message_count: 82', 1)
    edit_with_digest(folder, 'metadata.yaml', changed.encode())
    code, document, _ = verified(folder, capfd)
    assert (code, states(document)) == (1, {'pi': 'different'})


def test_a_headless_bag_relabelled_as_real_time_is_different(
    bag: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder = copied(bag, tmp_path / 'pi')
    recording = read_bag(folder)
    halved = {**recording.trajectory.signals}
    halved['vehicle_accel'] = halved['vehicle_accel'] / 2.0
    data = edited(recording.custom_data, mode='realtime')
    nodes = {
        node: {**pairs, 'mode': 'realtime'} if 'mode' in pairs else pairs
        for node, pairs in recording.run_info.items()
    }
    _write_anew(
        folder,
        replace(recording, trajectory=Trajectory(halved), custom_data=data, run_info=nodes),
    )
    code, document, _ = verified(folder, capfd)
    assert (code, states(document)) == (1, {'pi': 'different'})

    def relabel(content: Any) -> None:
        content['plan']['runs']['.']['settings']['mode'] = 'realtime'

    edit_manifest(folder, relabel)
    assert verify.main([str(folder)]) == 1, 'no headless run is in real time'


def test_a_run_that_is_not_repeated_needs_the_settings_of_its_plan(
    bag: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder = copied(bag, tmp_path / 'pi')

    def of_object(content: Any) -> None:
        content['plan']['runs']['.']['controller'] = None

    def other_mass(content: Any) -> None:
        content['plan']['runs']['.']['scenario']['vehicle']['mass_kg'] += 1.0

    edit_manifest(folder, of_object)
    assert verified(folder, capfd)[0] == 3
    edit_manifest(folder, other_mass)
    code, document, errors = verified(folder, capfd)
    assert (code, states(document)) == (1, {'pi': 'different'})
    assert 'settings.known.scenario.vehicle.mass_kg: its bag has 1500.0, its plan 1501.0' in errors


def test_real_time_in_the_plan_alone_is_different(
    bag: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    def relabel(content: Any) -> None:
        _of_graph(content)
        content['plan']['runs']['.']['settings']['mode'] = 'realtime'

    folder = copied(bag, tmp_path / 'pi')
    edit_manifest(folder, relabel)
    code, _, errors = verified(folder, capfd)
    assert code == 1
    assert "settings.known.mode: its bag has 'lockstep', its plan 'realtime'" in errors


@pytest.mark.parametrize(
    ('key', 'value', 'found'),
    [
        ('name', 'strict', "its limits are {'name': 'strict', "),
        ('digest', '0' * 16, "'digest': '0000000000000000'"),
    ],
)
def test_other_limits_in_the_plan_of_a_comparison_are_found(
    runs: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str], key: str, value: str, found: str
) -> None:
    def edit(content: Any) -> None:
        content['plan']['comparison']['limits']['origin'][key] = value

    folder = copied(runs, tmp_path / 'runs')
    edit_manifest(folder, edit)
    code, _, errors = verified(folder, capfd)
    assert (code, errors.count('\n')) == (1, 1)
    assert found in errors


def test_nothing_is_called_compared_before_it_was_repeated(
    runs: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder = copied(runs, tmp_path / 'runs')
    (folder / 'pi' / 'pi_0.mcap').unlink()
    assert verify.main([str(folder)]) == 1
    assert capfd.readouterr().out == ''
