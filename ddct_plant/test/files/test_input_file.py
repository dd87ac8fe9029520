# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Files that a user names are read whole, or refused in one line."""

from pathlib import Path

import pytest
from refusals import refused

from ddct_plant.base.errors import DdctError
from ddct_plant.files.input_file import located, named_in, user_bytes, user_text, without_folder
from ddct_plant.scenario.file import load_scenario


def test_a_file_is_read_whole_through_links_too(tmp_path):
    (tmp_path / 'file').write_bytes(b'abc')
    (tmp_path / 'link').symlink_to('file')
    assert user_bytes(tmp_path / 'file') == b'abc'
    assert user_text(tmp_path / 'link') == 'abc'


@pytest.mark.parametrize(
    ('name', 'reason'),
    [
        ('', 'Is a directory'),
        ('nowhere', 'No such file or directory'),
        ('binary', 'it is not UTF-8 text'),
    ],
)
def test_what_cannot_be_read_gives_the_reason_in_one_line(tmp_path, name, reason):
    (tmp_path / 'binary').write_bytes(b'\xff\xfe')
    with refused(DdctError, place='x.yaml') as caught, located('x.yaml'):
        user_text(tmp_path / name)
    assert str(caught.value) == f'x.yaml: cannot be read ({reason})'


def test_a_file_that_may_not_be_read_gives_the_reason(tmp_path, monkeypatch):
    def locked(_):
        raise PermissionError(13, 'Permission denied')

    monkeypatch.setattr(Path, 'read_bytes', locked)
    with pytest.raises(DdctError, match=r'^cannot be read \(Permission denied\)$'):
        user_text(tmp_path / 'locked')


def test_a_folder_in_place_of_a_scenario_gives_one_line(tmp_path):
    with pytest.raises(DdctError, match=r'cannot be read \(Is a directory\)$'):
        load_scenario(str(tmp_path))


@pytest.mark.parametrize('folder', ['', '/home/me/', 'C:\\Users\\me\\', 'd:/me/'])
def test_a_place_loses_the_folder_of_any_system(folder: str) -> None:
    assert without_folder(f'{folder}mine.py line 3') == 'mine.py line 3'


def test_an_absolute_name_in_the_inputs_of_a_result_is_that_of_the_copy(tmp_path: Path) -> None:
    file = tmp_path / 'result' / 'inputs' / 'mine.yaml'
    copy = file.parent / 'lib' / 'c.so'
    copy.parent.mkdir(parents=True)
    copy.touch()
    assert named_in(file.parent, '/gone/lib/c.so') == Path('/gone/lib/c.so'), 'it is no result'
    (tmp_path / 'result' / 'manifest.json').touch()
    assert named_in(file.parent, '/gone/lib/c.so') == copy
    assert named_in(file.parent, '/gone/lib/other.so') == Path('/gone/lib/other.so')
    assert named_in(file.parent, 'lib/c.so') == copy
