# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Files that a user names are read up to a limit, and a pipe is not waited for."""

import os
from pathlib import Path

import pytest

from ddct_plant.base.errors import DdctError
from ddct_plant.files.input_file import named_in, read_file, read_text_file
from ddct_plant.scenario.file import load_scenario


def test_a_file_is_read_whole_through_links_too(tmp_path):
    (tmp_path / 'file').write_bytes(b'abc')
    (tmp_path / 'link').symlink_to('file')
    assert read_file(tmp_path / 'file', 3) == b'abc'
    assert read_text_file(tmp_path / 'link') == 'abc'


@pytest.fixture
def pipe(tmp_path):
    """Return a pipe that nobody writes to: whoever opens it for reading waits."""
    path = tmp_path / 'pipe.yaml'
    os.mkfifo(path)
    return path


def test_a_pipe_is_not_waited_for(pipe):
    with pytest.raises(OSError, match='it is a pipe: give a file'):
        read_file(pipe, 10)


@pytest.mark.parametrize(
    ('path', 'what'),
    [
        ('/dev/zero', 'larger than 10 bytes'),
        ('/', 'Is a directory'),
        ('/nowhere', 'No such file'),
    ],
)
def test_what_cannot_be_read_gives_the_reason(path, what):
    with pytest.raises(OSError, match=what):
        read_file(Path(path), 10)


def test_a_file_that_is_too_large_is_not_read(tmp_path):
    path = tmp_path / 'large'
    with path.open('wb') as file:
        file.truncate(10**12)  # takes no room on the disk
    with pytest.raises(OSError, match='larger than 1000000 bytes'):
        read_text_file(path)


def test_bytes_that_are_no_text_are_an_error_of_the_file(tmp_path):
    (tmp_path / 'binary').write_bytes(b'\xff\xfe')
    with pytest.raises(OSError, match='not UTF-8 text'):
        read_text_file(tmp_path / 'binary')


def test_a_folder_in_place_of_a_scenario_gives_one_line(tmp_path):
    with pytest.raises(DdctError, match=r'cannot be read \(Is a directory\)$'):
        load_scenario(str(tmp_path))


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
