# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Text from outside reaches a terminal as one line that it does not obey."""

import pickle

import pytest

from ddct_plant.base.errors import DdctError, ParameterError, printable
from ddct_plant.program.printed_table import print_table
from ddct_plant.program.table import TextTable

RED = '\x1b[31mred\x1b[0m'


@pytest.mark.parametrize(
    ('text', 'shown'),
    [
        ('w_d in rpm, µ and 车', 'w_d in rpm, µ and 车'),
        (RED, r'\x1b[31mred\x1b[0m'),
        ('a\r\nb\tc\x07\x7f', r'a\r\nb\tc\x07\x7f'),
        ('\x9b2J', r'\x9b2J'),
        ('\u202eevil\u2028', r'\u202eevil\u2028'),
        ('\ud800', r'\ud800'),
        (Exception('why'), 'why'),
    ],
)
def test_characters_that_control_a_terminal_are_escaped(text, shown):
    assert printable(text) == shown
    assert printable(shown) == shown


def test_long_text_keeps_its_beginning_and_its_end():
    shown = printable('begins ' + 'x' * 10**6 + ' ends')
    assert shown.startswith('begins x')
    assert shown.endswith('x ends')
    assert ' [...] ' in shown
    assert len(shown) < 4010


@pytest.mark.parametrize('kind', [DdctError, ParameterError])
def test_every_error_for_a_user_is_printable_wherever_it_goes(kind):
    error = kind(f'controller {RED}\nis unknown')
    assert str(error) == r'controller \x1b[31mred\x1b[0m\nis unknown'
    assert str(pickle.loads(pickle.dumps(error))) == str(error)


def test_the_cells_of_a_table_are_printable(capsys):
    print_table(TextTable(f'title {RED}', ('name',), [(RED,)]))
    printed = capsys.readouterr().out
    assert '\x1b' not in printed
    assert r'title \x1b[31mred' in printed
