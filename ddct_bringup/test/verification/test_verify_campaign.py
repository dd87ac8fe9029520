# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`verify` computes every row of a campaign again."""

from pathlib import Path
from typing import Any

import pytest
from verified import (
    copied,
    edit_json_with_digest,
    edit_rows,
    make_small_campaign,
    of_another_release,
    states,
    verified,
)

from ddct_bringup.campaign.conduct import RESULTS, SHARDS
from ddct_bringup.digests.digest_file import DIGESTS, read_digests
from ddct_bringup.programs import campaign

pytestmark = pytest.mark.slow
ROWS = 'ls8: rows 0 to 1'


@pytest.fixture(scope='module')
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a campaign of two rows."""
    return make_small_campaign(tmp_path_factory.mktemp('whole'))


def test_an_untouched_campaign_is_the_same_to_the_last_bit_wherever_it_is(
    whole: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    code, document, errors = verified(copied(whole, tmp_path / 'there'), capfd, '--workers', '1')
    assert (code, 'ddct verify' in errors) == (0, False)  # progress is no error
    names = ['manifest.json', ROWS, 'shards', 'summary.json']
    assert states(document) == dict.fromkeys(names, 'same_bits')
    assert f'{SHARDS}/00000001.parquet' in [file['path'] for file in document['files']]


def test_showing_a_campaign_keeps_its_digests(
    whole: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder = copied(whole, tmp_path / 'there')
    assert campaign.main(['show', str(folder), '--csv', str(folder / 'rows.csv')]) == 0
    assert 'rows.csv' in read_digests(folder).files
    assert verified(folder, capfd, '--workers', '1')[0] == 0


@pytest.mark.parametrize(
    ('name', 'edit'),
    [
        ('slip_final_rpm', lambda values: [value * (1.0 + 1e-15) for value in values]),
        ('seed', lambda values: [value + 1 for value in values]),
        ('vehicle.mass_kg', lambda values: [value + 1.0 for value in values]),
        ('state', lambda values: ['late' for _ in values]),
        ('valid', lambda values: [False for _ in values]),
    ],
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
    assert f'{ROWS}: row 0, signal {name}: recorded ' in errors


@pytest.mark.parametrize('key', ['root_seed', 'runs', 'shard_size'])
def test_a_manifest_edited_with_its_digest_is_found(
    whole: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str], key: str
) -> None:
    def edit(manifest: Any) -> None:
        manifest[key] += 1

    folder = copied(whole, tmp_path / 'there')
    edit_json_with_digest(folder, 'manifest.json', edit)
    code, document, errors = verified(folder, capfd, '--workers', '1')
    assert code == 1
    assert key in errors or document['error']


@pytest.mark.parametrize(('change', 'state'), [(1e-12, 'same_within'), (1e-5, 'different')])
def test_an_edited_row_of_another_release_is_beyond_the_bound_that_is_measured_for_it(
    whole: Path,
    tmp_path: Path,
    capfd: pytest.CaptureFixture[str],
    change: float,
    state: str,
) -> None:
    """On other kernels it is too: tests/nightly/verification."""
    folder = copied(whole, tmp_path / 'there')
    of_another_release(folder)
    edit_rows(folder, 'slip_final_rpm', lambda values: [(1.0 + change) * x for x in values])
    assert states(verified(folder, capfd, '--workers', '1')[1])[ROWS] == state


def test_a_campaign_of_another_release_may_have_other_shards(
    whole: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    def edit(manifest: Any) -> None:
        manifest |= {'shard_size': 2, 'code_digest': 'f' * 64}

    folder = copied(whole, tmp_path / 'there')
    of_another_release(folder)
    edit_json_with_digest(folder, 'manifest.json', edit)
    code, document, errors = verified(folder, capfd, '--workers', '1')
    assert (code, 'ddct verify' in errors) == (0, False)  # progress is no error
    assert states(document)['manifest.json'] == 'same_bits'


def test_a_seed_of_the_specification_edited_with_its_digest_is_found(
    whole: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    def edit(manifest: Any) -> None:
        manifest['root_seed'] = manifest['spec']['seed'] = 4

    folder = copied(whole, tmp_path / 'there')
    edit_json_with_digest(folder, 'manifest.json', edit)
    code, _, errors = verified(folder, capfd, '--workers', '1')
    assert code == 1
    assert 'has changed since' in errors


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
    (folder / DIGESTS).unlink()
    read_digests(whole).write(folder)
    code, _, errors = verified(folder, capfd)
    assert code == 1
    assert f'{folder}/{RESULTS}: missing' in errors
    spec = str(whole.parent / 'spec.yaml')
    arguments = [spec, '--out', str(folder), '--resume', '--workers', '1']
    assert campaign.main(arguments) == 0
    assert verified(folder, capfd, '--workers', '1')[0] == 0


def test_a_campaign_resumed_on_another_kind_of_processor_has_no_kind(
    whole: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = copied(whole, tmp_path / 'there')
    other = {'machine': 'another'}
    monkeypatch.setattr('ddct_bringup.digests.environment.this_processor', lambda: other)
    spec = str(whole.parent / 'spec.yaml')
    arguments = [spec, '--out', str(folder), '--resume', '--workers', '1']
    assert campaign.main(arguments) == 0
    assert read_digests(folder).environment.processor is None
