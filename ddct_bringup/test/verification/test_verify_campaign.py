# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`verify` computes every row of a campaign again."""

import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from by_schema import require_schemas
from samples import sampled
from verified import (
    CONTROLLER,
    DRAWN,
    copied,
    edit_json_with_digest,
    edit_manifest,
    edit_rows,
    edit_with_digest,
    make_small_campaign,
    of_another_release,
    states,
    verified,
)

from ddct_bringup.campaign.conduct import RESULTS, SHARDS
from ddct_bringup.campaign_report import document as campaign_document
from ddct_bringup.manifest.manifest import MANIFEST, read_manifest
from ddct_bringup.programs import campaign
from ddct_plant.files.yaml_text import dump_yaml

pytestmark = pytest.mark.slow
ROWS = RESULTS
PROFILE = {'csv': 'a.csv', 'time': 't', 'value': 'c', 'unit': 'N m'}
NAMES_FILES = """\
controllers: [pi, '{mine}']
scenario: own.yaml
grid: {{car: [c635_thesis, other.yaml], duration_s: [0.7]}}
"""


@pytest.fixture(scope='module')
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a campaign of two rows."""
    return make_small_campaign(tmp_path_factory.mktemp('whole'))


def test_the_files_of_a_campaign_are_as_their_schemas(whole: Path) -> None:
    require_schemas(whole, {'manifest.json': 'manifest_campaign', 'summary.json': 'campaign'})


def test_an_untouched_campaign_is_the_same_to_the_last_bit_wherever_it_is(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(campaign_document, '_charts', DRAWN)
    whole = make_small_campaign(tmp_path / 'whole', 'mpc4')  # in no batch: a shard for each row
    code, document, errors = verified(copied(whole, tmp_path / 'there'), capfd, '--workers', '1')
    assert (code, 'ddct verify' in errors) == (0, False)  # progress is no error
    names = [MANIFEST, ROWS, SHARDS, 'summary.json', 'report.html']
    assert states(document) == dict.fromkeys(names, 'same_bits')
    assert f'{SHARDS}/00000001.parquet' in [file['path'] for file in document['files']]


def test_showing_a_campaign_keeps_its_digests(
    whole: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder = copied(whole, tmp_path / 'there')
    assert campaign.main(['show', str(folder), '--csv', str(folder / 'rows.csv')]) == 0
    assert 'rows.csv' in read_manifest(folder).files
    code, document, _ = verified(folder, capfd, '--workers', '1')
    left = {name for name, state in states(document).items() if state != 'same_bits'}
    assert (code, left) == (3, {'rows.csv'})


@pytest.mark.parametrize(
    ('name', 'edit'),
    sampled(
        [
            ('slip_final_rpm', lambda values: [value * (1.0 + 1e-15) for value in values]),
            ('seed', lambda values: [value + 1 for value in values]),
            ('vehicle.mass_kg', lambda values: [value + 1.0 for value in values]),
            ('state', lambda values: ['late' for _ in values]),
            ('valid', lambda values: [False for _ in values]),
        ],
        every=3,
    ),
)
def test_a_row_edited_with_its_digest_is_found(
    whole: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str], name: str, edit: Any
) -> None:
    folder = copied(whole, tmp_path / 'there')
    edit_rows(folder, name, edit)
    code, document, errors = verified(folder, capfd, '--workers', '1')
    assert (code, states(document)[ROWS]) == (1, 'different')
    (first,) = [run['first_difference'] for run in document['runs'] if run['run'] == ROWS]
    assert (first['row'], first['signal']) == (0, name)
    assert f'{ROWS}: file {ROWS}, row 0, signal {name}: recorded ' in errors


@pytest.mark.parametrize('key', ['root_seed', 'runs', 'shard_size'])
def test_a_manifest_edited_with_its_digest_is_found(
    whole: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str], key: str
) -> None:
    def edit(manifest: Any) -> None:
        manifest['campaigns']['.'][key] += 1

    folder = copied(whole, tmp_path / 'there')
    edit_manifest(folder, edit)
    code, document, errors = verified(folder, capfd, '--workers', '1')
    assert code == 1
    assert key in errors or document['error']


@pytest.mark.parametrize(('change', 'state'), [(1e-12, 'same_within'), (1e-5, 'different')])
def test_an_edited_row_of_another_release_is_the_same_within_the_bound_alone(
    whole: Path,
    tmp_path: Path,
    capfd: pytest.CaptureFixture[str],
    change: float,
    state: str,
) -> None:
    folder = copied(whole, tmp_path / 'there')
    of_another_release(folder)
    edit_rows(folder, 'slip_final_rpm', lambda values: [(1.0 + change) * x for x in values])
    code, document, _ = verified(folder, capfd, '--workers', '1')
    assert (code, states(document)[ROWS]) == (3 if state == 'same_within' else 1, state)


@pytest.mark.parametrize('both', [False, True])
def test_a_seed_of_the_specification_edited_with_its_digest_is_found(
    whole: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str], both: bool
) -> None:
    def edit(manifest: Any) -> None:
        plan = manifest['campaigns']['.']
        plan['spec']['seed'] = 4
        if both:
            plan['root_seed'] = 4

    folder = copied(whole, tmp_path / 'there')
    edit_manifest(folder, edit)
    code, _, errors = verified(folder, capfd, '--workers', '1')
    assert code == 1
    assert 'has changed since' in errors


def test_an_edited_page_is_found(
    whole: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder = copied(whole, tmp_path / 'there')
    page = (folder / 'report.html').read_bytes()
    edit_with_digest(folder, 'report.html', page.replace(b'ls8', b'ls9', 1))
    code, document, _ = verified(folder, capfd, '--workers', '1')
    assert (code, states(document)['report.html']) == (1, 'different')


@pytest.mark.parametrize('absolute', sampled([False, True], every=2))
def test_a_campaign_carries_the_files_that_it_names(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], absolute: bool
) -> None:
    work = tmp_path / 'work'
    (work / 'specs').mkdir(parents=True)
    (work / 'mine.py').write_text(CONTROLLER, encoding='utf-8')
    folder = work / 'specs'
    profile = {**PROFILE, 'csv': str(folder / 'a.csv')} if absolute else PROFILE
    files = {
        'own.yaml': {'car': 'car.yaml', 'drive': 'drives/mine.yaml'},
        'car.yaml': {'base': '../base_car.yaml'},
        'other.yaml': {'base': '../base_car.yaml', 'friction': {}},
        '../base_car.yaml': {'base': 'c635_thesis', 'vehicle': {'mass_kg': 1500.0}},
        'drives/mine.yaml': {'base': 'base.yaml'},
        'drives/base.yaml': {
            'base': 'thesis',
            'engine': profile if absolute else {**profile, 'csv': '../a.csv'},
        },
    }
    (folder / 'drives').mkdir()
    for name, content in files.items():
        (folder / name).write_text(dump_yaml(content), encoding='utf-8')
    (folder / 'a.csv').write_text('t,c\n0,97\n', encoding='utf-8')
    spec = work / 'specs' / 'spec.yaml'
    spec.write_text(NAMES_FILES.format(mine=work / 'mine.py'), encoding='utf-8')
    out = tmp_path / 'out'
    assert campaign.main([str(spec), '--out', str(out), '--workers', '1']) == 0
    shutil.rmtree(work)
    moved = out.rename(tmp_path / 'moved')
    assert {path.name for path in (moved / 'inputs').rglob('*') if path.is_file()} == {
        *('mine.py', 'own.yaml', 'a.csv', 'mine.yaml', 'base.yaml'),
        *('car.yaml', 'other.yaml', 'base_car.yaml'),
    }
    code, document, errors = verified(moved, capfd, '--workers', '1')
    assert (code, document['state'], 'ddct verify' in errors) == (0, 'same_bits', False)
    for file in moved.rglob('*'):
        own = absolute and file.name == 'base.yaml'
        assert not file.is_file() or own or str(tmp_path).encode() not in file.read_bytes(), file


def test_a_figure_of_the_summary_edited_with_its_digest_is_found(
    whole: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    def edit(summary: Any) -> None:
        summary['runs'] = 5

    folder = copied(whole, tmp_path / 'there')
    edit_json_with_digest(folder, 'summary.json', edit)
    code, document, _ = verified(folder, capfd, '--workers', '1')
    assert (code, states(document)['summary.json']) == (1, 'different')


def test_an_unfinished_campaign_is_one_line_and_keeps_its_shards(
    whole: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder = copied(whole, tmp_path / 'there')
    for name in (RESULTS, 'summary.json', 'report.html'):
        (folder / name).unlink()
    shard = sorted(path.relative_to(folder).as_posix() for path in (folder / SHARDS).iterdir())[0]
    whole_manifest = read_manifest(whole)
    files = {shard: whole_manifest.files[shard]}
    replace(whole_manifest, state='running', files=files).write(folder)
    code, _, errors = verified(folder, capfd)
    assert (code, errors.count('\n')) == (1, 1)
    assert f'{folder}: it is not complete' in errors
    spec = str(whole.parent / 'spec.yaml')
    arguments = [spec, '--out', str(folder), '--resume', '--workers', '1']
    assert campaign.main(arguments) == 0
    assert verified(folder, capfd, '--workers', '1')[0] == 0


def test_a_campaign_resumed_with_other_libraries_has_no_arithmetic(
    whole: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder = copied(whole, tmp_path / 'there')
    known = read_manifest(folder)
    replace(known, arithmetic=replace(known.arithmetic, kernel='another')).write(folder)
    spec = str(whole.parent / 'spec.yaml')
    arguments = [spec, '--out', str(folder), '--resume', '--workers', '1']
    assert campaign.main(arguments) == 0
    assert read_manifest(folder).arithmetic is None
    code, document, _ = verified(folder, capfd, '--workers', '1')
    assert (code, document['state'], document['bound']) == (0, 'same_bits', 1e-9)
