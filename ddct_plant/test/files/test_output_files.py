# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables on standard output and JSON files, shared by the programs."""

import json
import os
import sys
from pathlib import Path

import pytest
from refusals import refused

from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import write_json
from ddct_plant.files.output_file import require_place
from ddct_plant.program.printed_table import print_table
from ddct_plant.program.table import TextTable


def test_columns_of_a_plain_table_line_up(capsys):
    print_table(TextTable('Title', ('a', 'long header'), [('wide cell', '1'), ('x', '22')]))
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == 'Title'
    cells = ('long header', '1', '22')
    ends = [line.index(cell) + len(cell) for line, cell in zip(lines[1:4], cells, strict=True)]
    assert ends == [24, 24, 24]


def test_table_on_a_terminal_shows_every_cell_with_its_brackets(capsys, monkeypatch):
    monkeypatch.setattr('sys.stdout.isatty', lambda: True)
    print_table(TextTable('Title', ('unit [1]',), [('[bold]',)]))
    output = capsys.readouterr().out
    assert 'unit [1]' in output and '[bold]' in output


def test_failed_write_leaves_the_old_file_alone(tmp_path, monkeypatch):
    target = tmp_path / 'scores.json'
    write_json(str(target), {'a': 1})

    def full_disk(*_):
        raise OSError(28, 'No space left on device')

    monkeypatch.setattr(Path, 'replace', full_disk)
    with refused(DdctError, place='scores.json'):
        write_json(str(target), {'a': 2})
    assert json.loads(target.read_text()) == {'a': 1}
    assert list(tmp_path.iterdir()) == [target]


def test_json_refuses_what_it_cannot_express(tmp_path):
    with pytest.raises(ValueError, match='JSON'):
        write_json(str(tmp_path / 'x.json'), {'a': float('nan')})


def test_full_device_is_an_error_in_one_line():
    with pytest.raises(DdctError, match='/dev/full: cannot be written .No space left'):
        write_json('/dev/full', {'a': 1})


def test_device_is_written_to_and_not_replaced():
    write_json('/dev/null', {'a': 1})
    assert not Path('/dev/null').is_file()


def test_a_standard_output_that_was_closed_is_an_error_in_one_line(monkeypatch):
    monkeypatch.setattr(sys, 'stdout', None)
    with refused(DdctError) as caught:
        write_json('-', {})
    assert 'standard output was closed' in str(caught.value)


def test_a_folder_that_cannot_be_written_is_refused_before_the_work(tmp_path, monkeypatch):
    target = str(tmp_path / 'scores.json')
    require_place('--json', target)
    monkeypatch.setattr(os, 'access', lambda path, mode: (path, mode) != (tmp_path, os.W_OK))
    with refused(DdctError, '--json'):
        require_place('--json', target)
