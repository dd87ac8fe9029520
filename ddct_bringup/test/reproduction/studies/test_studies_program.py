"""Program `reproduce studies`: which studies it makes, and what it prints and writes of them."""

import json
from pathlib import Path

import pytest

from ddct_bringup.programs import reproduce
from ddct_bringup.reproduction.studies import command
from ddct_bringup.reproduction.studies.command import STUDIES
from ddct_bringup.reproduction.studies.study import Study
from ddct_plant.program.page_tables import marked_tables

DOCS = Path(__file__).resolve().parents[4] / 'docs'
FIRST = Study('The first', ('name', 'value'), [('a', '1'), ('b', '2')], ('Lower is better.',))
SECOND = Study('The second', ('name',), [('c',)])


@pytest.fixture(autouse=True)
def two_studies(monkeypatch):
    """Spare these tests the closed loops."""
    monkeypatch.setattr(command, 'STUDIES', {'first': lambda: FIRST, 'second': lambda: SECOND})


def test_without_options_every_study_is_printed_with_its_remarks(capsys):
    assert reproduce.main(['studies']) == 0
    output = capsys.readouterr()
    assert output.out.index('The first') < output.out.index('Lower is better.')
    assert output.out.index('Lower is better.') < output.out.index('The second')
    progress = ['ddct reproduce studies: first', 'ddct reproduce studies: second']
    assert output.err.splitlines() == progress


def test_json_on_standard_output_stands_alone_and_has_a_mapping_per_row(capsys):
    assert reproduce.main(['studies', '--study', 'first', '--json', '-']) == 0
    assert json.loads(capsys.readouterr().out) == {
        'first': {
            'title': 'The first',
            'rows': [{'name': 'a', 'value': '1'}, {'name': 'b', 'value': '2'}],
            'remarks': ['Lower is better.'],
        }
    }


def test_page_decides_which_studies_are_made(capsys, tmp_path):
    page = tmp_path / 'page.md'
    page.write_text('Text.\n<!-- studies: second -->\n<!-- end -->\n', encoding='utf-8')
    assert reproduce.main(['studies', '--write-doc', str(page)]) == 0
    filled = 'Text.\n<!-- studies: second -->\n| name |\n| --- |\n| c |\n<!-- end -->\n'
    assert page.read_text(encoding='utf-8') == filled
    assert 'The first' not in capsys.readouterr().out


def test_unknown_study_is_refused_before_the_work(capsys):
    assert reproduce.main(['studies', '--study', 'first', '--study', 'third']) == 1
    (error,) = capsys.readouterr().err.splitlines()
    assert error.startswith('ddct reproduce: ')
    assert all(name in error for name in ('third', 'first', 'second'))


def test_every_study_stands_on_one_page_and_no_page_marks_another():
    pages = [path.read_text(encoding='utf-8') for path in DOCS.glob('*/*.md')]
    marked = [name for page in pages for name in marked_tables(page, command.PAGE_MARK)]
    assert sorted(marked) == sorted(STUDIES)
