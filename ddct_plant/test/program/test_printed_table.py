# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A printed table fits its output, and loses nothing: each column is shown or named."""

import io
import re
import sys

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ddct_plant.program.printed_table import print_note, print_table
from ddct_plant.program.table import TextColumn, TextTable, Weight, table_of, with_reasons

WORDS = st.text('abcdefgh', min_size=1, max_size=40)
TEXTS = st.lists(WORDS, min_size=1, max_size=6).map(' '.join)
NUMBERS = st.integers(-(10**9), 10**9).map(str)
EXAMPLES = 40
"""Number of tables of a test, of which each takes milliseconds to print."""


@st.composite
def tables(draw: st.DrawFn) -> TextTable:
    """Return a table whose headings and cells all differ, so that each can be found."""
    count = draw(st.integers(2, 9))
    weights = [Weight.IDENTIFYING, *draw(st.tuples(*[st.sampled_from(Weight)] * (count - 1)))]
    kinds = draw(st.tuples(*[st.booleans()] * count))
    headers = [f'h{place}{draw(WORDS)} {draw(WORDS)}' for place in range(count)]
    rows = [
        [
            f'{line}{place}{draw(NUMBERS).lstrip("-")}'
            if number
            else f'c{line}{place}{draw(TEXTS)}'
            for place, number in enumerate(kinds)
        ]
        for line in range(draw(st.integers(1, 3)))
    ]
    return TextTable('', headers, rows, numbers=kinds, weights=weights)


def test_nothing_is_printed_where_standard_output_was_closed_before_the_start(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(sys, 'stdout', None)
    print_table(TextTable('title', ['a', 'b'], [['1', '2']]))
    print_note('a note')


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def table_lines(table: TextTable, width: int) -> list[tuple[str, bool]]:
    """Return the lines on a terminal of that width, and whether each is a bold heading."""
    stream = Terminal()
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv('COLUMNS', str(width))
        patch.setenv('TERM', 'xterm-256color')
        print_table(table, stream)
    *lines, last, behind = stream.getvalue().split('\n')
    assert (last, behind) == ('', ''), 'an empty line is behind a table'
    return [(re.sub(r'\x1b\[[0-9;]*m', '', line).rstrip(), '\x1b[1m' in line) for line in lines]


@settings(max_examples=EXAMPLES)
@given(tables(), st.integers(40, 200))
def test_no_line_is_wider_and_each_column_is_shown_or_named(table: TextTable, width: int) -> None:
    lines = table_lines(table, width)
    assert max(len(line) for line, _ in lines) <= width
    text = ' '.join(line for line, _ in lines)
    note = text.partition('not shown: ')[2]
    letters = sorted(re.sub(r'\s', '', text.partition('not shown: ')[0]))
    for place, (header, weight) in enumerate(zip(table.headers, table.weights, strict=True)):
        named = header.replace(' ', '') in re.sub(r'\s', '', note)
        assert not (named and weight >= Weight.NEEDED)
        cells = [header, *(row[place] for row in table.rows)]
        for letter in sorted(re.sub(r'\s', '', ''.join(cells))) if not named else ():
            letters.remove(letter)
    repeated = {
        letter
        for header, *cells in zip(table.headers, *table.rows, strict=True)
        if table.weights[list(table.headers).index(header)] == Weight.IDENTIFYING
        for letter in ''.join((header, *cells))
    }
    assert set(letters) <= repeated


@settings(max_examples=EXAMPLES)
@given(tables())
def test_a_wide_output_shows_every_column_without_a_wrapped_line(table: TextTable) -> None:
    headings = [line for line, is_heading in table_lines(table, 10**4) if is_heading]
    assert len(headings) == 1
    assert headings[0].split() == ' '.join(table.headers).split()
    assert len(table_lines(table, 10**4)) == 1 + len(table.rows)


WIDE = TextTable(
    'Title',
    ('name', 'first', 'second', 'third'),
    [('pi', '1' * 20, '2' * 20, '3' * 20), ('ls8', '4' * 20, '5' * 20, '6' * 20)],
    weights=(Weight.IDENTIFYING, Weight.NEEDED, Weight.DETAIL, Weight.USEFUL),
)


def texts(table: TextTable, width: int) -> list[str]:
    """Return the lines of a table."""
    return [line for line, _ in table_lines(table, width)]


def test_the_lightest_column_is_left_out_first_and_named_with_the_width_that_shows_it() -> None:
    assert texts(WIDE, 74)[-1] == f'  ls8   {"4" * 20}  {"5" * 20}  {"6" * 20}'
    assert texts(WIDE, 60)[-1] == '  not shown: second; all on a terminal of 72 columns'
    assert ' '.join(texts(WIDE, 40)[-2:]).startswith('  not shown: second, third; all on a')
    assert max(map(len, texts(WIDE, 72))) <= 72 and 'not shown' not in texts(WIDE, 72)[-1]


def test_texts_are_wrapped_only_where_the_output_is_narrower_than_they_are() -> None:
    table = TextTable('', ('name', 'why'), [('pi', 'it slips again and again after the lock')])
    widest = len(texts(table, 200)[1])
    assert len(texts(table, widest)) == 2
    assert len(texts(table, widest - 1)) == 3


def test_the_note_names_the_file_where_there_is_one() -> None:
    table = TextTable(
        WIDE.title, WIDE.headers, WIDE.rows, weights=WIDE.weights, complete='--json FILE'
    )
    assert texts(table, 60)[-1] == '  not shown: second; all with --json FILE'


def test_needed_columns_that_do_not_fit_are_blocks_with_the_name_in_each() -> None:
    lines = texts(TextTable('Title', WIDE.headers, WIDE.rows), 60)
    assert lines[1].split() == ['name', 'first', 'second']
    assert lines[4] == ''
    assert lines[5].split() == ['name', 'third']
    assert [line.split()[0] for line in lines[6:]] == ['pi', 'ls8']


COLUMNS = (
    TextColumn[tuple[str, float | None, str]]('run', '', lambda row: row[0], number=False),
    TextColumn[tuple[str, float | None, str]](
        'jerk',
        '.1f',
        lambda row: row[1],
        undefined=lambda row: row[2],
        remark=lambda row: row[2],
    ),
)


def test_each_star_and_dash_has_the_reason_of_its_cell_once() -> None:
    rows = [
        *(('a', None, 'no lock'), ('b', None, 'no floor'), ('c', None, 'no lock')),
        *(('d', 1.0, ''), ('e', 22.0, 'commands the engine')),
    ]
    assert texts(table_of('', COLUMNS, rows), 80) == [
        '  run   jerk',
        '  a       -',
        '  b      --',
        '  c       -',
        '  d     1.0',
        '  e    22.0*',
        '  *  commands the engine',
        '  -  no lock',
        '  --  no floor',
    ]


def test_a_footer_has_at_most_six_lines_and_counts_the_rest() -> None:
    rows = [(str(number), None, f'reason {number}') for number in range(9)]
    table = table_of('', COLUMNS, rows, complete='--json FILE')
    footer = texts(table, 80)[1 + len(rows) :]
    assert len(footer) == 6
    assert footer[-1] == '  4 more notes, with --json FILE'


def test_a_column_that_is_left_out_has_no_reason_below() -> None:
    table = with_reasons(
        TextTable('', ('a', 'b'), [('x' * 30, '-')], weights=(Weight.IDENTIFYING, Weight.DETAIL)),
        lambda header, row: 'none',
    )
    assert texts(table, 80)[-1] == '  -  none'
    narrow = TextTable(
        '', ('a', 'b' * 30), table.rows, weights=table.weights, reasons=table.reasons
    )
    assert not any('none' in line for line in texts(narrow, 40))


@pytest.mark.parametrize('width', [80, 100, 120])
def test_a_terminal_gives_the_width_and_a_file_is_at_most_120_wide(
    width: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv('COLUMNS', str(width))
    for stream, most in ((Terminal(), width), (io.StringIO(), 120)):
        print_table(TextTable('title ' * 40, ('text',), [('word ' * 60,)]), stream)
        print_note('note ' * 60, stream)
        lines = re.sub(r'\x1b\[[0-9;]*m', '', stream.getvalue()).splitlines()
        assert most - 8 <= max(map(len, lines)) <= most


def test_a_file_has_neither_codes_of_a_terminal_nor_spaces_at_ends_of_lines(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv('FORCE_COLOR', '1')
    stream = io.StringIO()
    print_table(WIDE, stream)
    assert '\x1b' not in stream.getvalue()
    assert [line for line in stream.getvalue().split('\n') if line != line.rstrip()] == []
