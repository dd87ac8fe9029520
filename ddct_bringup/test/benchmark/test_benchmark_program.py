# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A benchmark shows a controller that remembers, gives the same bytes, and can be verified."""

import html
import re
import shlex
import shutil
import struct
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pyarrow.parquet as parquet
import pytest
from altered_bytes import kinds_of_files, not_found
from by_schema import require_schemas
from printed_commands import printed_commands, run_printed
from refusals import refused
from small_benchmark import (
    benchmark_of_a_controller_that_remembers,
    content_of,
    judge,
    result_in,
    use_release,
)
from small_tuning import leave_out_pictures
from verified import copied, edit_json_with_digest, edit_manifest, states, verified

from ddct_bringup.benchmark.cases import Cases
from ddct_bringup.benchmark.conduct import AGAIN, Options, carry_out_benchmark
from ddct_bringup.benchmark.file_names import PAGE, RESULT
from ddct_bringup.benchmark.judged import Judged
from ddct_bringup.benchmark.release import ROWS, write_release_rows
from ddct_bringup.benchmark.report.document import benchmark_document
from ddct_bringup.benchmark.report.rules import NO_GAIN, left_open_here, states_that_count
from ddct_bringup.benchmark.result_types import Result
from ddct_bringup.benchmark.update_times import UpdateTimesFile
from ddct_bringup.documents.document import Section, Table, Terms
from ddct_bringup.evaluation.quantities import MAIN, QUANTITIES
from ddct_bringup.manifest.manifest import MANIFEST
from ddct_bringup.manifest.origin import CodeOrigin
from ddct_bringup.run.timing_and_failure import TIMING_FILE
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verdict.state import STATES
from ddct_bringup.verification import repetition
from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import json_text, read_json, to_json

pytestmark = pytest.mark.slow
place = pytest.fixture(scope='module')(benchmark_of_a_controller_that_remembers)
NAME = 'Remembers'
LIBRARY = 'name: foreign\nc_library: {file: foreign.so}\n'
FAILS = """\
from ddct_bringup.api import Controller


class Fails(Controller):
    def reset(self):
        pass

    def update(self, measurement):
        raise ValueError('it has no law')
"""


@pytest.fixture
def no_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    leave_out_pictures(monkeypatch)


@pytest.mark.nightly
def test_a_controller_that_remembers_the_development_cases_is_worse_on_held_out_ones(
    place: Path,
) -> None:
    result = result_in(place / 'first')
    (judged,) = result['controllers']
    ours, theirs = result['development']['groups'], judged['held_out']['groups']
    assert (ours[0]['controller'], ours[0]['engaged']['count']) == (NAME, 6)
    assert theirs[0]['engaged']['count'] == 0
    assert theirs[0]['engaged']['high'] < ours[0]['engaged']['low']
    assert [(gap['name'], gap['differs'], gap['worse']) for gap in judged['gaps']] == [
        (name, True, 1.0) for name in MAIN
    ]
    assert 'worse on held-out cases, beyond chance' in (place / 'first' / PAGE).read_text()
    # The others are as good in both, so the held-out cases are not the harder ones.
    assert [each['engaged']['count'] for each in (*ours[1:3], *theirs[1:])] == [6] * 4
    assert [pair['second_only'] for pair in judged['held_out']['pairs']] == [6, 6]


def test_the_board_has_every_controller_with_its_figures_and_who_dominates_it(
    place: Path,
) -> None:
    result = result_in(place / 'first')
    board, pairs = result['development']['groups'], result['development']['pairs']
    assert [row['controller'] for row in board] == [NAME, 'pi', 'ls8', 'hinf1']
    assert [row['dominated_by'] for row in board] == [[]] * 4  # six cases say nothing
    assert {*MAIN} <= board[2]['quantities'].keys()
    assert result['comparison']['dominance_level'] == pytest.approx(0.05 / (5 * 4 * 3))
    assert [(pair['second'], pair['comparison']['cases']) for pair in pairs] == [
        (name, 6) for name in ('pi', 'ls8', 'hinf1')
    ]
    of_ls8 = pairs[1]['comparison']['figures'].values()  # the same runs, as it plays them back
    assert [(each['better'], each['worse'], each['left_out']) for each in of_ls8] == [
        (0, 0, 0)
    ] * 5


def test_the_files_of_a_benchmark_are_as_their_schemas(place: Path) -> None:
    names = {MANIFEST: 'manifest_benchmark', RESULT: 'benchmark', TIMING_FILE: 'update_times'}
    require_schemas(place / 'first', names)


def test_the_bytes_are_the_same_after_an_interruption(place: Path, tmp_path: Path) -> None:
    expected = content_of(place / 'first')
    file = str(place / 'remembers.py')
    out = tmp_path / 'stopped'
    options = Options(1, lambda: len([*out.rglob('*.parquet')]) > 1)
    with pytest.raises(KeyboardInterrupt, match=AGAIN):
        carry_out_benchmark([Judged.of(file)], Cases.packaged(), out, None, options)
    left = len([*out.rglob('*.parquet')])
    assert not (out / RESULT).exists()
    assert judge(out, file, '--workers', '2') == 0
    assert content_of(out) == expected
    assert 1 < left < len([*out.rglob('*.parquet')])
    pages = [(each / PAGE).read_text().splitlines() for each in (place / 'first', out)]
    other = [a for a, b in zip(*pages, strict=True) if a != b]
    assert [line for line in other if 'class="num wall"' not in line] == []


@pytest.mark.nightly
def test_verify_computes_all_of_it_again(
    place: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder = copied(place / 'first', tmp_path / 'there')
    code, document, errors = verified(folder, capfd, '--workers', '1')
    assert (code, 'ddct verify' in errors) == (0, False)
    found = states(document)
    tables = {f'{NAME}/{part}/results.parquet' for part in ('development', 'held_out')}
    assert {MANIFEST, 'development.parquet', RESULT, PAGE, *tables} <= found.keys()
    assert set(found.values()) == {'same_bits'}
    assert [path.parent for path in folder.rglob(MANIFEST)] == [folder]


def test_the_page_has_what_counts_what_nobody_gains_by_and_what_stays_open(place: Path) -> None:
    page = html.unescape((place / 'first' / PAGE).read_text(encoding='utf-8'))
    states = states_that_count(packaged_limits().rules)
    words = {name for key in states for name in key.split(', ')}
    assert words == {state.replace('_', ' ') for state in STATES}
    for text in (*states, *NO_GAIN, left_open_here(), f'no controller dominates {NAME}: 6 cases'):
        assert text in page


def test_names_in_the_first_column_of_a_table_stand_left(place: Path) -> None:
    """The class `num` is that of cells that stand right, below the heading of their number."""
    page = (place / 'first' / PAGE).read_text(encoding='utf-8')
    heads = re.findall(r'<th scope="row"( class="[^"]*")?[^>]*>([^<]*)', page)
    assert {text for _, text in heads} >= {NAME, 'pi', 'ls8', 'hinf1'}
    right = {text for classes, text in heads if 'num' in classes}
    assert [text for text in right if not text.isdecimal()] == []


def test_the_result_is_read_as_its_record_and_written_as_it_was(place: Path) -> None:
    file = place / 'first' / RESULT
    assert json_text(read_json(Result, file)) == file.read_text(encoding='utf-8')


def test_no_main_quantity_is_among_the_further_ones_of_the_page(place: Path) -> None:
    result = read_json(Result, place / 'first' / RESULT)
    document = benchmark_document(result, UpdateTimesFile('pi', {}))
    (well,) = [each for each in document.content if getattr(each, 'key', '').endswith('-well')]
    (further,) = [
        table
        for section in well.content  # type: ignore[union-attr]
        if isinstance(section, Section) and section.title == 'Further metrics'
        for table in section.content
        if isinstance(table, Table)
    ]
    symbols = {row[0].value for row in further.rows}
    assert symbols
    assert not symbols & {QUANTITIES[key].symbol for key in MAIN}


def test_a_section_on_keys_without_a_table_defines_nothing_and_every_table_has_a_name(
    place: Path,
) -> None:
    result = read_json(Result, place / 'first' / RESULT)
    document = benchmark_document(result, UpdateTimesFile('pi', {}))
    found = [each for each in document.content if isinstance(each, Section)]
    (keys,) = [each for each in found if each.key.endswith('-keys')]
    kinds = {type(block) for block in keys.content}
    assert (Terms in kinds) == (Table in kinds)
    titles = ['Further metrics', 'Differences in further metrics', 'By scenario']
    tables = [document.table(title) for title in (*titles, 'Figures by scenario')]
    assert len({id(table) for table in tables}) == 4


def test_the_commands_on_the_page_run_in_its_folder(
    place: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = copied(place / 'first', tmp_path / 'there')
    monkeypatch.chdir(folder)
    replay, verify = printed_commands((folder / PAGE).read_text(encoding='utf-8'))
    assert run_printed(replay, CASE='1') == 0
    assert [*tmp_path.glob('again/*/*.mcap')]
    # To run it takes as long as the test before, which does with a copy of the folder.
    assert shlex.split(verify) == ['ddct', 'verify', '.']


def test_a_changed_controller_is_refused_before_it_runs(
    place: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    ran, folder = tmp_path / 'ran', copied(place / 'first', tmp_path / 'there')
    carried = folder / 'inputs' / NAME / 'remembers.py'
    carried.write_text(f'open({str(ran)!r}, "w").close()\n', encoding='utf-8')
    code, _, errors = verified(folder, capfd, '--workers', '1')
    assert code == 1
    assert f'{carried}: altered' in errors
    assert not ran.exists(), 'code of another file has run'


def _seed(content: Any) -> None:
    content['plan']['controllers'][0]['held_out_seed'] += 1


def _root(content: Any) -> None:
    content['campaigns'][f'{NAME}/held_out']['root_seed'] += 1


def _share(content: Any) -> None:
    content['controllers'][0]['held_out']['groups'][0]['engaged']['count'] = 6


@pytest.mark.parametrize(
    ('name', 'edit'), [(MANIFEST, _seed), (MANIFEST, _root), (RESULT, _share)]
)
def test_a_seed_or_a_figure_edited_with_its_digest_is_found(
    place: Path,
    tmp_path: Path,
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    name: str,
    edit: Callable[[Any], None],
) -> None:
    def finished(judged: Any, cases: Any, out: Path, *options: Any) -> dict[str, str]:
        shutil.copytree(place / 'first', out, dirs_exist_ok=True)
        return {}

    # The test before computes all again.
    monkeypatch.setattr(repetition, 'carry_out_benchmark', finished)
    folder = copied(place / 'first', tmp_path / 'there')
    if name == MANIFEST:
        edit_manifest(folder, edit)
    else:
        edit_json_with_digest(folder, name, edit)
    code, document, _ = verified(folder, capfd, '--workers', '1')
    assert code == 1
    assert {each for each, state in states(document).items() if state == 'different'} == {name}


def test_any_altered_byte_of_a_benchmark_is_found(place: Path) -> None:
    files = kinds_of_files(place / 'first')
    assert {'.parquet', '.html', RESULT, MANIFEST} <= files.keys()
    lost = {name: not_found(place / 'first', file, 20) for name, file in files.items()}
    assert lost == dict.fromkeys(files, [])


@pytest.mark.usefixtures('no_pictures')
def test_a_quick_benchmark_by_the_seed_of_a_judge_is_marked_and_has_no_dominance(
    place: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert judge(tmp_path / 'judged', 'ls8', '--seed', '7', '--quick') == 0
    result = result_in(tmp_path / 'judged')
    assert (result['judge_seed'], result['controllers'][0]['held_out_seed']) == (7, 7)
    page = (tmp_path / 'judged' / PAGE).read_text(encoding='utf-8')
    assert 'those of a judge: --seed 7' in page
    assert 'a quick benchmark' in page
    assert result['comparison']['dominance_level'] is None
    assert {row['dominated_by'] for row in result['development']['groups']} == {None}
    assert {pair['comparison'] for pair in result['development']['pairs']} == {None}
    assert 'Who dominates whom' not in page
    printed = capfd.readouterr().out
    assert 'cases, left out' not in printed and 'held out other states' not in printed
    assert left_open_here() in ' '.join(printed.split())
    assert not (tmp_path / 'judged' / 'ls8' / 'development').exists()


@pytest.mark.usefixtures('no_pictures')
def test_a_controller_that_fails_in_every_case_is_one_line_and_its_rows_stay(
    place: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / 'fails.py').write_text(FAILS, encoding='utf-8')
    out = tmp_path / 'out'
    assert judge(out, str(tmp_path / 'fails.py'), '--quick') == 1
    errors = capfd.readouterr().err.splitlines()
    (line,) = [each for each in errors if each.startswith('ddct benchmark')]
    assert 'Fails: every held-out run is invalid, such as: ' in line
    assert result_in(out)['controllers'][0]['held_out']['groups'][0]['invalid'] == 2


@pytest.mark.usefixtures('no_pictures')
def test_rows_of_the_release_that_other_code_computed_are_named_wherever_the_result_is_read(
    place: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    release = shutil.copytree(place / 'packaged', tmp_path / 'packaged')
    table = parquet.read_table(release / ROWS)
    other = {b'version': b'0.9.0', b'commit': b'c0ffee' * 4, b'code_digest': b'7' * 64}
    kept = table.replace_schema_metadata({**table.schema.metadata, **other})
    parquet.write_table(kept, release / ROWS)
    out = tmp_path / 'out'
    with pytest.MonkeyPatch.context() as patch:
        use_release(release, patch)
        assert judge(out, 'ls8', '--quick') == 0
        printed = ' '.join(capfd.readouterr().out.split())
        code, document, _ = verified(out, capfd, '--workers', '1')
    here = CodeOrigin.here()
    before = f'version 0.9.0, commit c0ffeec0ff ({"7" * 10})'
    cases = result_in(out)['cases']
    assert cases['release_rows'] == {'version': '0.9.0', 'commit': 'c0ffee' * 4, 'code': '7' * 64}
    for text in (printed, (out / PAGE).read_text(encoding='utf-8'), cases['other_code']):
        assert f'by other code ({before}) than all other rows ({here.text})' in text
        assert 'tools/run benchmark_rows, in a clone, computes these rows again' in text
    notes = {run['run']: run['note'] for run in document['runs']}
    assert code == 0
    assert notes[ROWS] == f'computed by other code: {before}'
    # Rows of the same code need no word.
    same = result_in(place / 'first')
    assert same['release'] == same['cases']['release_rows'] == to_json(here)
    assert same['cases']['other_code'] == ''
    assert 'other code' not in (place / 'first' / PAGE).read_text(encoding='utf-8')


def test_rows_of_other_code_are_not_taken_when_the_release_is_computed_again(
    place: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    work = shutil.copytree(place / 'rows', tmp_path / 'rows')
    before = content_of(work)
    monkeypatch.setattr('ddct_bringup.manifest.origin.code_digest', lambda: '0' * 64)
    with refused(DdctError, place='rows') as caught:
        write_release_rows(work, tmp_path, workers=1)
    assert 'remove it, and run tools/run benchmark_rows again' in str(caught.value)
    assert content_of(work) == before


def foreign_library(folder: Path) -> str:
    """Write a controller file that names a library for another processor."""
    header = bytearray(Path(sys.executable).resolve().read_bytes()[:4096])
    struct.pack_into('<HH', header, 16, 3, 183)  # a shared library for AArch64
    (folder / 'foreign.so').write_bytes(header)
    (folder / 'foreign.yaml').write_text(LIBRARY, encoding='utf-8')
    return str(folder / 'foreign.yaml')


def test_what_cannot_be_judged_is_a_line_each_before_anything_is_written(
    place: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / 'out'
    names = ('absent.yaml', 'no_such', foreign_library(tmp_path))
    assert judge(out, *names, 'ls8') == 1
    lines = capfd.readouterr().err.splitlines()
    assert len(lines) == len(names)
    for line, name in zip(lines, names, strict=True):
        assert line.startswith('ddct benchmark: ')
        assert Path(name).stem in line
    assert judge(out, 'ls8', 'ls8') == 1
    assert judge(out, 'ls8', '--seed', '-1') == 1
    assert judge(out, 'hinf2') == 1  # not in this release
    assert [len(capfd.readouterr().err.splitlines()), out.exists()] == [3, False]


def test_a_folder_of_another_benchmark_or_release_is_refused_and_stays(
    place: Path,
    tmp_path: Path,
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    folder = copied(place / 'first', tmp_path / 'there')
    before = content_of(folder)
    file = str(place / 'remembers.py')
    assert judge(folder, file, '--quick') == 1
    assert judge(folder, 'ls8') == 1
    monkeypatch.setattr('ddct_bringup.manifest.origin.code_digest', lambda: '0' * 64)
    assert judge(folder, file) == 1
    quick, others, release = capfd.readouterr().err.splitlines()
    assert 'with another number of cases' in quick
    assert 'of other controllers' in others
    assert 'of another release' in release
    assert content_of(folder) == before
    shutil.rmtree(folder / NAME)
    code, _, errors = verified(folder, capfd)
    assert (code, errors.count('missing') > 1) == (1, True)
