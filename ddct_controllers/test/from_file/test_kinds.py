# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""One table defines the kinds of controller files."""

import hashlib
import re

import pytest

from ddct_controllers.from_file.kinds import KINDS
from ddct_controllers.registry import controller_spec, make_controller
from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')))
CHOICES = ', '.join(KINDS)


@pytest.mark.parametrize(
    ('text', 'complaint'),
    [
        ('name: mine\n', f'there is no kind of controller: give one of {CHOICES}'),
        (
            'name: mine\ntransfer_funktion: {}\n',
            "line 2: 'transfer_funktion' is no kind of controller: did you mean "
            'transfer_function?',
        ),
        (
            'name: mine\nunits: {input: rpm, output: N m}\nnotes: none\npolynom: {}\n',
            "line 4: 'polynom' is no kind of controller: did you mean polynomial?",
        ),
        (
            'name: mine\nunits: {input: rpm, output: N m}\nbox: {}\n',
            f"line 3: 'box' is no kind of controller: known: {CHOICES}",
        ),
        (
            'name: mine\nunits: {input: rpm, output: N m}\ndiscretisation: hold\n',
            f'there is no kind of controller: give one of {CHOICES}',
        ),
        (
            'name: mine\npolynomial: {}\nstate_space: {}\n',
            f'line 3: state_space beside polynomial: keep one of {CHOICES}',
        ),
    ],
)
def test_the_error_for_a_file_of_no_or_two_kinds_has_line_and_choices(tmp_path, text, complaint):
    path = tmp_path / 'mine.yaml'
    path.write_text(text)
    with pytest.raises(ParameterError, match=re.escape(f'controller file {path}: {complaint}')):
        make_controller(str(path), SETTINGS.known)


def sha256(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def test_a_linear_controller_is_identified_by_the_digest_of_its_file(tmp_path):
    path = tmp_path / 'mine.yaml'
    path.write_bytes(
        b'name: mine\r\nunits: {input: rpm, output: N m}\r\n'
        b'polynomial: {num: [-0.1, -1.0], den: [1.0, 0.0]}  # \xc3\xa9\n'
    )
    info = make_controller(str(path), SETTINGS.known).info('mine')
    assert info['controller_file_sha256'] == sha256(path)
    path.write_text(path.read_text().replace('-0.1', '-0.2'))
    again = make_controller(str(path), SETTINGS.known).info('mine')
    assert again['controller_file_sha256'] == sha256(path) != info['controller_file_sha256']


def test_a_library_is_identified_by_its_digest_beside_that_of_its_file(tmp_path):
    path, library = tmp_path / 'mine.yaml', tmp_path / 'mine.so'
    path.write_text('name: mine\nc_library: {file: mine.so}\n')
    library.write_bytes(b'\x7fELF\x00\xff')
    assert controller_spec(str(path)).digests == {
        'controller_file_sha256': sha256(path),
        'c_library_sha256': sha256(library),
    }
