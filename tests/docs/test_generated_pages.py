# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What is generated in the pages is what the code gives; long tables have tests of their own."""

import json
import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
from generator.actuator_tables import other_actuators
from generator.drawings.block_diagrams import drawings
from generator.option_tables import TABLES as OPTION_TABLES
from generator.pages import DOCS, as_markdown, fill_pages, marked_pages, shown_tables
from generator.score_tables import score_tables
from generator.tables import TABLES as COMPUTED
from generator.tuning_tables import FOLDER, tuning_tables

from ddct_bringup.tuning.specification.spec import read_tuning_spec
from ddct_controllers.registry import controller_spec
from ddct_plant.base.errors import DdctError
from ddct_plant.program.table import TextTable

TABLES = {
    'first': TextTable('', ('a', 'b'), [('1', 'x|y')]),
    'second': TextTable('', ('c',), [('2',)]),
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


def test_each_table_is_filled_in_at_its_mark_and_the_text_around_it_stays(docs: Path) -> None:
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


def test_a_table_on_two_pages_is_refused(docs: Path) -> None:
    (docs / 'none.md').write_text(MARKED.format('first'), encoding='utf-8')
    with pytest.raises(DdctError, match='first of trial stands twice'):
        fill_pages('trial', TABLES, docs)


def test_every_mark_is_of_a_kind_that_one_command_writes() -> None:
    texts = [page.read_text(encoding='utf-8') for page in marked_pages()]
    every = [mark for text in texts for mark in re.findall(r'<!-- (.*?) -->', text)]
    marks = [mark for mark in every if not mark.startswith(('table: ', 'schemas'))]
    kinds = {mark.partition(':')[0] for mark in marks} - {'end'}
    assert kinds == {*COMPUTED}
    assert marks.count('end') == len(marks) / 2


def test_the_tables_of_options_are_what_the_code_declares() -> None:
    assert shown_tables('options') == as_markdown(OPTION_TABLES), 'run: make docs KINDS=options'


def test_figures_metrics_and_limits_are_those_of_the_programs() -> None:
    assert shown_tables('scores') == as_markdown(score_tables()), 'run: make docs KINDS=scores'


@pytest.mark.slow
def test_the_margins_with_other_actuators_are_those_of_the_designs() -> None:
    shown = {name: rows for name, rows in shown_tables('margins').items() if 'actuators' in name}
    expected = as_markdown({'other_actuators': other_actuators()})
    assert shown == expected, 'run: make docs KINDS=margins'


def test_the_tables_of_tunings_are_those_of_the_kept_results() -> None:
    assert shown_tables('tuning') == as_markdown(tuning_tables()), 'run: make docs KINDS=tuning'


@pytest.mark.parametrize(('name', 'controller'), [('pi_launches', 'pi'), ('mpc_thesis', 'mpc3')])
def test_the_kept_results_are_of_the_packaged_specifications(name: str, controller: str) -> None:
    result = json.loads((FOLDER / f'{name}.json').read_text(encoding='utf-8'))
    spec = read_tuning_spec(name, controller_spec(controller))
    ranges = {each.name: (each.low, each.high) for each in spec.parameters}
    kept = {key: (each['low'], each['high']) for key, each in result['parameters'].items()}
    assert (result['controller'], result['trials'], kept) == (controller, spec.trials, ranges)
    titles = [each['title'] for each in (*result['objectives'], *result['constraints'])]
    limits = [each.title for each in spec.constraints]
    assert titles == [*(each.title for each in spec.objectives), *limits]


def test_the_diagrams_are_what_the_program_draws() -> None:
    diagrams = drawings()
    assert len(diagrams) == 5
    for file, drawing in diagrams.items():
        ElementTree.fromstring(drawing)
        kept = (DOCS / 'images' / file).read_text(encoding='utf-8')
        assert kept == drawing, 'run: make docs KINDS=diagrams'
