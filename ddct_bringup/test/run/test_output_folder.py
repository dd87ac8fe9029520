# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Commit checks the folders again: new files of others stay, an old result is never lost."""

from pathlib import Path

import pytest
from refusals import refused

from ddct_bringup.run.output_folder import MARKER, StagedFolder, is_ours, mark_folder
from ddct_plant.base.errors import DdctError


def staged(final: Path, content: str, *, overwrite: bool) -> StagedFolder:
    folder = StagedFolder(final, overwrite=overwrite)
    (folder.path / 'bag').write_text(content)
    return folder


def files(folder: Path) -> dict[str, str]:
    return {
        path.relative_to(folder).as_posix(): path.read_text()
        for path in sorted(folder.rglob('*'))
        if path.is_file() and path.name != MARKER
    }


def test_a_new_result_takes_the_place_of_an_old_one(tmp_path: Path) -> None:
    staged(tmp_path / 'runs', 'old', overwrite=False).commit()
    staged(tmp_path / 'runs', 'new', overwrite=True).commit()
    assert files(tmp_path) == {'runs/bag': 'new'}
    assert [path.name for path in tmp_path.iterdir()] == ['runs']


@pytest.mark.parametrize('overwrite', [False, True])
def test_what_a_user_put_there_meanwhile_is_kept(tmp_path: Path, overwrite: bool) -> None:
    folder = staged(tmp_path / 'runs', 'new', overwrite=overwrite)
    folder.final.mkdir()
    (folder.final / 'thesis.txt').write_text('three years of work')
    with refused(DdctError, '--out'):
        folder.commit()
    assert files(tmp_path) == {
        'runs.partial/bag': 'new',
        'runs/thesis.txt': 'three years of work',
    }


def test_a_result_that_came_meanwhile_is_kept(tmp_path: Path) -> None:
    first = staged(tmp_path / 'runs', 'first', overwrite=False)
    first.path.rename(tmp_path / 'elsewhere')
    staged(tmp_path / 'runs', 'second', overwrite=False).commit()
    (tmp_path / 'elsewhere').rename(first.path)
    with pytest.raises(DdctError, match='it came while this run took place'):
        first.commit()
    assert files(tmp_path) == {'runs.partial/bag': 'first', 'runs/bag': 'second'}


def test_an_old_result_is_put_back_when_the_new_one_cannot_take_its_place(tmp_path: Path) -> None:
    staged(tmp_path / 'runs', 'old', overwrite=False).commit()
    folder = staged(tmp_path / 'runs', 'new', overwrite=True)
    folder.path.rename(tmp_path / 'gone')
    with pytest.raises(DdctError, match='cannot be replaced'):
        folder.commit()
    assert files(tmp_path / 'runs') == {'bag': 'old'}
    assert sorted(path.name for path in tmp_path.iterdir()) == ['gone', 'runs']


def test_a_marker_that_is_a_link_is_neither_followed_nor_taken_for_ours(tmp_path: Path) -> None:
    target = tmp_path / 'precious'
    target.write_text('mine', encoding='utf-8')
    folder = tmp_path / 'out'
    folder.mkdir()
    (folder / MARKER).symlink_to(target)
    assert not is_ours(folder)
    with refused(DdctError, '--out'):
        mark_folder(folder)
    assert target.read_text(encoding='utf-8') == 'mine'
