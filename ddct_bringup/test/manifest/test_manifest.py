# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A manifest is written whole or not at all, and the copies of inputs stay as they were named."""

import errno
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from ddct_bringup.manifest.inputs import InputFiles, own_place
from ddct_bringup.manifest.manifest import (
    MANIFEST,
    RUNS,
    Manifest,
    begin_manifest,
    file_digest,
    finish_manifest,
    keep_digests,
    read_manifest,
    require_same_inputs,
    resume_manifest,
)
from ddct_bringup.run.output_folder import mark_folder
from ddct_plant.base.errors import DdctError
from ddct_plant.files import output_file


def begun(result: Path, inputs: InputFiles | None = None) -> Manifest:
    """Begin a result in a folder, and return its manifest."""
    mark_folder(result)
    return begin_manifest(result, RUNS, {'seed': 3}, inputs or InputFiles())


def test_a_manifest_is_running_until_its_result_is_done(tmp_path: Path) -> None:
    result = tmp_path / 'result'
    assert begun(result).state == read_manifest(result).state == 'running'
    (result / 'a.txt').write_text('a')
    finish_manifest(result)
    done = read_manifest(result)
    assert (done.state, done.plan) == ('done', {'seed': 3})
    assert done.files['a.txt'] == file_digest(result / 'a.txt')
    assert MANIFEST not in done.files


def test_a_full_disk_at_the_end_is_one_line_and_leaves_the_manifest_as_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    result = tmp_path / 'result'
    begun(result)
    before = read_manifest(result)
    (result / 'a.txt').write_text('a')

    def full(path: Path, content: bytes) -> Any:
        raise OSError(errno.ENOSPC, 'No space left on device')

    with monkeypatch.context() as patch:
        patch.setattr(output_file.Path, 'write_bytes', full)
        with pytest.raises(DdctError, match=f'{MANIFEST}: .*No space left on device'):
            finish_manifest(result)
    assert read_manifest(result) == before
    assert [each.name for each in result.glob('.manifest*')] == []
    finish_manifest(result)
    assert read_manifest(result).state == 'done'


def test_any_edit_without_the_own_digest_is_refused(tmp_path: Path) -> None:
    result = tmp_path / 'result'
    begun(result)
    text = (result / MANIFEST).read_text(encoding='utf-8')
    (result / MANIFEST).write_text(text.replace('"seed": 3', '"seed": 4'), encoding='utf-8')
    with pytest.raises(DdctError, match=r'its own digest does not match .*put the original back'):
        read_manifest(result)


def test_a_result_that_goes_on_with_other_libraries_has_no_arithmetic(tmp_path: Path) -> None:
    result = tmp_path / 'result'
    known = begun(result)
    assert known.arithmetic is not None
    assert resume_manifest(result, known).arithmetic == known.arithmetic
    assert resume_manifest(result, known, one_machine=False).arithmetic is None
    other = replace(known, arithmetic=replace(known.arithmetic, kernel='another'))
    assert resume_manifest(result, other).arithmetic is None
    assert read_manifest(result).arithmetic is None


def test_files_that_are_written_later_have_their_digests_renewed(tmp_path: Path) -> None:
    result = tmp_path / 'result'
    begun(result)
    (result / 'part').mkdir()
    (result / 'part' / 'a.txt').write_text('a')
    (tmp_path / 'elsewhere.txt').write_text('b')
    keep_digests([result / 'part' / 'a.txt', tmp_path / 'elsewhere.txt'])
    assert list(read_manifest(result).files) == ['part/a.txt']


def test_copies_stay_as_the_files_are_to_each_other(tmp_path: Path) -> None:
    for name in ('spec/mine.yaml', 'spec/sub/own.csv', 'lib/c.so', 'other/outer.yaml', 'x.py'):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(name)
    inputs = InputFiles(tmp_path / 'spec')
    assert inputs.add([tmp_path / 'spec' / 'mine.yaml']) == 'mine.yaml'
    assert inputs.add([tmp_path / 'spec' / 'sub' / '..' / 'sub' / 'own.csv']) == 'sub/own.csv'
    outside = inputs.add([tmp_path / 'other' / 'outer.yaml', tmp_path / 'lib' / 'c.so'])
    assert outside == 'outside_1/other/outer.yaml'
    assert own_place(outside) == 'other/outer.yaml'
    assert inputs.add([tmp_path / 'x.py']) == 'outside_1/x.py'
    result = tmp_path / 'result'
    known = begun(result, inputs)
    copies = result / 'inputs' / 'outside_1'
    assert (copies / 'other' / '..' / 'lib' / 'c.so').read_text() == 'lib/c.so'
    assert set(known.files) == {
        *('inputs/mine.yaml', 'inputs/sub/own.csv', 'inputs/outside_1/other/outer.yaml'),
        *('inputs/outside_1/lib/c.so', 'inputs/outside_1/x.py'),
    }
    again = InputFiles(result / 'inputs')
    assert again.add([copies / 'other' / 'outer.yaml', copies / 'lib' / 'c.so']) == outside


def test_a_result_does_not_go_on_with_other_inputs(tmp_path: Path) -> None:
    file = tmp_path / 'mine.yaml'
    file.write_text('a')
    inputs = InputFiles()
    inputs.add([file])
    result = tmp_path / 'result'
    known = begun(result, inputs)
    require_same_inputs(result, known, inputs)
    file.write_text('b')
    other = InputFiles()
    other.add([file])
    for changed in (other, InputFiles()):
        with pytest.raises(DdctError, match='inputs/mine.yaml has changed since it was begun'):
            require_same_inputs(result, known, changed)
