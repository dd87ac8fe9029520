# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The digests of a controller's files are known without running any of them."""

from pathlib import Path

import pytest
from python_controllers import IMPORTS, PROPORTIONAL
from refusals import refused

from ddct_controllers.from_file.digests import controller_digests
from ddct_controllers.from_file.with_options import with_options_text
from ddct_controllers.registry import controller_spec
from ddct_plant.base.errors import DdctError, ParameterError

LINEAR = 'units: {input: rpm, output: N m}\npolynomial: {num: [-0.1, -1.0], den: [1, 0]}\n'


@pytest.fixture
def files(tmp_path: Path) -> Path:
    """Return a folder with controller files; those called outer are made of others."""
    for name, text in {
        'mine.py': IMPORTS + PROPORTIONAL,
        'linear.yaml': f'name: linear\n{LINEAR}',
        'code.yaml': 'name: code\nc_library: {file: mine.so}\n',
        'outer_py.yaml': with_options_text('outer', 'mine.py', {}),
        'outer_code.yaml': with_options_text('outer', 'code.yaml', {}),
        'outer_twice.yaml': with_options_text('outer', 'outer_py.yaml', {}),
    }.items():
        (tmp_path / name).write_text(text, encoding='utf-8')
    (tmp_path / 'mine.so').write_bytes(b'\x7fELF\x00\xff')
    return tmp_path


@pytest.mark.parametrize(
    ('file', 'number'),
    [
        ('mine.py', 1),
        ('linear.yaml', 1),
        ('code.yaml', 2),
        ('outer_py.yaml', 2),
        ('outer_code.yaml', 3),
        ('outer_twice.yaml', 3),
    ],
)
def test_they_are_those_of_the_loaded_controller(files: Path, file: str, number: int) -> None:
    digests = controller_digests(str(files / file))
    assert len(digests) == number
    assert digests == controller_spec(str(files / file)).digests


@pytest.mark.parametrize('file', ['mine.py', 'outer_py.yaml', 'outer_twice.yaml'])
def test_no_code_runs(files: Path, file: str) -> None:
    before = controller_digests(str(files / file))
    (files / 'mine.py').write_text('raise SystemExit("it has run")\n', encoding='utf-8')
    assert controller_digests(str(files / file)) != before


def test_a_name_has_no_files() -> None:
    assert controller_digests('pi') == {}


def test_a_missing_file_is_named(files: Path) -> None:
    (files / 'mine.py').unlink()
    (files / 'mine.so').unlink()
    with refused(DdctError, place='mine.py'):
        controller_digests(str(files / 'outer_twice.yaml'))
    with refused(ParameterError, key='c_library.file', place='code.yaml: line 2'):
        controller_digests(str(files / 'code.yaml'))
