# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Results in sentences are generated, and sentences repeat no number of a table by hand."""

import re
from collections import Counter
from functools import cache
from pathlib import Path

import pytest
from generator import results as results_module
from generator.cells import cell, fill_cells, marked_cells
from generator.pages import shown_tables
from generator.results import PAGES, fill_results, marked_results, results
from refusals import refused

from ddct_plant.base.errors import DdctError

AGAIN = 'run: make docs KINDS=results'
_TABLE = re.compile(r'<!-- ([\w-]+): \w+ -->\n(.*?)<!-- end -->', re.DOTALL)
_GENERATED = re.compile(r'<!-- (?:cell|result): .+? -->.*?<!-- end -->|```.*?```|`.*?`', re.DOTALL)
_NUMBER = re.compile(r'(?<![\w.])\d+\.\d+(?![\w.])')
NO_RESULTS = {'options', 'parameters', 'plant', 'scores', 'missing', 'soak', 'speed'}
"""Kinds of tables without results of runs or designs."""
OF_THE_PLANT = {'0.145', '2.93', '5.344', '9.34', '82.23', '339.4'}
"""Numbers of the printed plant and its modes that sentences have too."""
OF_THE_PRINT = {'0.012266'}
"""Numbers of the thesis that sentences quote, beside which tables have ours."""


def repeated_by_hand(text: str) -> list[str]:
    """
    Return the numbers of a page's sentences that stand in just one cell of its tables of results.

    Only numbers of three digits and more count: shorter ones are equal by chance. A number that
    several cells have is one that was chosen, such as a wear gain.
    """
    cells: Counter[str] = Counter()
    for kind, table in _TABLE.findall(text):
        headers, _, *rows = (line.split(' | ') for line in table.splitlines())
        if kind not in NO_RESULTS:
            cells.update(
                number
                for row in rows
                if 'thesis prints' not in ''.join(row)
                for header, each in zip(headers, row, strict=True)
                if 'printed' not in header
                for number in _NUMBER.findall(each)
            )
    sentences = _GENERATED.sub('', _TABLE.sub('', text))
    return [
        number
        for number in _NUMBER.findall(sentences)
        if cells[number] == 1 and len(number.replace('.', '').lstrip('0')) > 2
    ]


def test_no_line_begins_with_a_mark_as_that_would_end_the_paragraph() -> None:
    begun = [
        (page.name, line)
        for page in PAGES
        for line in page.read_text(encoding='utf-8').splitlines()
        if re.match(r' *<!-- (result|cell): ', line)
    ]
    assert begun == []


def test_every_result_in_a_sentence_is_what_its_tables_and_runs_give() -> None:
    shown = [(page.name, *each) for page in PAGES for each in marked_results(page)]
    assert len(shown) > 20
    computed = results()
    expected = [(page, name, computed.get(name)) for page, name, _ in shown]
    assert shown == expected, AGAIN


def test_every_repeated_cell_is_that_of_its_table() -> None:
    tables = cache(shown_tables)
    shown = [(page.name, *each) for page in PAGES for each in marked_cells(page)]
    assert len(shown) > 80
    assert shown == [(page, name, cell(name, tables)) for page, name, _ in shown], AGAIN


def test_no_sentence_repeats_a_number_of_a_table_by_hand() -> None:
    found = {
        (page.name, number)
        for page in PAGES
        for number in repeated_by_hand(page.read_text(encoding='utf-8'))
        if number not in OF_THE_PLANT | OF_THE_PRINT
    }
    assert found == set(), 'mark it as a cell of its table: docs/generator/cells.py'


def test_a_number_that_is_repeated_by_hand_is_found() -> None:
    table = (
        '<!-- studies: x -->\n| a | printed |\n| --- | --- |\n| 1.234 | 5.678 |\n<!-- end -->\n'
    )
    assert repeated_by_hand(f'It is 1.234 s, not 5.678 or 1.23.\n{table}') == ['1.234']
    assert repeated_by_hand(f'It is <!-- cell: studies x; a -->1.234<!-- end -->.\n{table}') == []


def test_results_are_filled_in_and_an_unknown_one_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    page = tmp_path / 'page.md'
    page.write_text('A <!-- result: a -->1<!-- end --> b <!-- result: a -->1<!-- end -->.\n')
    monkeypatch.setattr(results_module, 'PAGES', (page,))
    assert fill_results({'a': '2', 'b': '3'}) == [page]
    assert marked_results(page) == [('a', '2'), ('a', '2')]
    assert fill_results({'a': '2'}) == []
    with pytest.raises(DdctError):
        fill_results({'b': '3'})


def test_cells_are_filled_in_and_those_of_no_table_or_of_two_rows_are_refused(
    tmp_path: Path,
) -> None:
    page = tmp_path / 'page.md'
    reference = 'studies wear; hinf2; 1; std w_sr rpm; .1f'
    page.write_text(f'A <!-- cell: {reference} -->1<!-- end --> b.\n')
    assert fill_cells(page)
    assert marked_cells(page) == [(reference, '4.6')]
    assert not fill_cells(page)
    for wrong in ('studies no; a; b', 'studies wear; hinf2; t_a s', 'studies wear; hinf2; 1; no'):
        with refused(DdctError, wrong if 'wear' in wrong else 'studies no'):
            cell(wrong)
