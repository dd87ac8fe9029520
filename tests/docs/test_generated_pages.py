# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What is generated in the pages is what the code gives; long tables have tests of their own."""

import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
from generator import results as results_module
from generator.block_diagrams import drawings
from generator.launch_table import launch_table
from generator.option_tables import TABLES as OPTION_TABLES
from generator.pages import DOCS, as_markdown, fill_pages, marked_pages, shown_tables
from generator.results import PAGES as RESULT_PAGES
from generator.results import fill_results, marked_results, results
from generator.score_tables import score_tables
from generator.sensor_table import sensor_table
from generator.tables import TABLES as COMPUTED

from ddct_plant.base.errors import DdctError
from ddct_plant.program.table import Table

TABLES = {
    'first': Table('', ('a', 'b'), [('1', 'x|y')]),
    'second': Table('', ('c',), [('2',)]),
}
MARKED = 'Text.\n<!-- trial: {} -->\nold\n<!-- end -->\nMore.\n'


@pytest.fixture
def docs(tmp_path: Path) -> Path:
    """Return a folder with two pages, each with one table, and one page without."""
    for place, text in (
        ('one/first.md', MARKED.format('first')),
        ('two/second.md', MARKED.format('second')),
        ('none.md', 'Text.\n'),
    ):
        (tmp_path / place).parent.mkdir(exist_ok=True)
        (tmp_path / place).write_text(text, encoding='utf-8')
    return tmp_path


def test_each_table_is_filled_in_where_it_stands_and_the_text_around_it_stays(docs: Path) -> None:
    first, second = docs / 'one' / 'first.md', docs / 'two' / 'second.md'
    assert fill_pages('trial', TABLES, docs) == [first, second]
    table = '| a | b |\n| --- | --- |\n| 1 | x\\|y |\n'
    filled = f'Text.\n<!-- trial: first -->\n{table}<!-- end -->\nMore.\n'
    assert first.read_text(encoding='utf-8') == filled
    assert shown_tables('trial', docs) == as_markdown(TABLES)
    assert fill_pages('trial', TABLES, docs) == []


def test_a_table_that_no_page_marks_or_none_computes_is_refused_before_anything_is_written(
    docs: Path,
) -> None:
    for tables in ({'first': TABLES['first']}, TABLES | {'third': TABLES['second']}):
        with pytest.raises(DdctError, match='must have these tables of trial, each once'):
            fill_pages('trial', tables, docs)
    assert 'old' in (docs / 'one' / 'first.md').read_text(encoding='utf-8')


def test_a_table_that_stands_on_two_pages_is_refused(docs: Path) -> None:
    (docs / 'none.md').write_text(MARKED.format('first'), encoding='utf-8')
    with pytest.raises(DdctError, match='first of trial stands twice'):
        fill_pages('trial', TABLES, docs)


def test_every_mark_is_of_a_kind_that_one_command_writes() -> None:
    texts = [page.read_text(encoding='utf-8') for page in marked_pages()]
    marks = [mark for text in texts for mark in re.findall(r'<!-- (.*?) -->', text)]
    kinds = {mark.partition(':')[0] for mark in marks} - {'end'}
    assert kinds == {*COMPUTED, 'result'}
    assert marks.count('end') == len(marks) / 2


def test_the_tables_of_options_are_what_the_code_declares() -> None:
    assert shown_tables('options') == as_markdown(OPTION_TABLES), 'run: make docs KINDS=options'


def test_metrics_criteria_and_limits_are_as_the_programs_say_them() -> None:
    assert shown_tables('scores') == as_markdown(score_tables()), 'run: make docs KINDS=scores'


def test_the_table_of_launches_is_what_the_scenarios_give() -> None:
    computed = as_markdown({'new_clutch': launch_table()})
    assert shown_tables('launches') == computed, 'run: make docs KINDS=launches'


def test_the_table_of_sensors_is_what_its_runs_give() -> None:
    computed = as_markdown({'in_thesis': sensor_table()})
    assert shown_tables('sensors') == computed, 'run: make docs KINDS=sensors'


def test_every_result_in_a_sentence_is_what_its_tables_and_runs_give() -> None:
    shown = [(page.name, *each) for page in RESULT_PAGES for each in marked_results(page)]
    assert len(shown) > 20
    computed = results()
    expected = [(page, name, computed.get(name)) for page, name, _ in shown]
    assert shown == expected, 'run: make docs KINDS=results'


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


def test_the_diagrams_are_what_the_program_draws() -> None:
    diagrams = drawings()
    assert len(diagrams) == 5
    for file, drawing in diagrams.items():
        ElementTree.fromstring(drawing)
        kept = (DOCS / 'images' / file).read_text(encoding='utf-8')
        assert kept == drawing, 'run: make docs KINDS=diagrams'
