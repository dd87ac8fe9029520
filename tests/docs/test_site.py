# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The documentation site: every link arrives, it opens offline, and equations are drawn."""

import importlib.util
import shutil
from pathlib import Path

import pytest
from samples import sampled
from website.links import faults
from website.results import FILES, MARK, with_results
from website.staging import ROOT, staged

from ddct_bringup.reproduction.studies.command import STUDIES
from ddct_bringup.reproduction.studies.study import WrittenStudy
from ddct_bringup.schemas import DOCUMENTS
from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import write_json
from ddct_plant.program.table import TextTable

PAGES_OF_RESULTS = sorted(
    str(each.relative_to(ROOT).with_suffix(''))
    for each in (ROOT / 'docs').rglob('*.md')
    if MARK.search(each.read_text(encoding='utf-8'))
)
# The resolver of myst-parser reads an attribute that Sphinx 11 will not have.
pytestmark = pytest.mark.filterwarnings("ignore:'myst_parser.*MystReferenceResolver.app'")
needs_sphinx = pytest.mark.skipif(
    importlib.util.find_spec('myst_parser') is None, reason='Sphinx is not there: make site'
)


def _marks() -> set[tuple[str, str]]:
    """Return file and name of each table of results that a page marks."""
    pages = (ROOT / 'docs').rglob('*.md')
    return {mark for each in pages for mark in MARK.findall(each.read_text(encoding='utf-8'))}


@pytest.fixture(scope='module')
def results(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with small files in place of those that programs write."""
    folder = tmp_path_factory.mktemp('results')
    for file in FILES:
        names = sorted(name for each, name in _marks() if each == file)
        tables = {
            name: TextTable(f'Title of {name}', ('key', 'value'), [('a | b', f'{file} {name}')])
            for name in names
        }
        written: object = {name: table.written for name, table in tables.items()}
        if file == 'studies':
            written = {name: WrittenStudy(table.written, ()) for name, table in tables.items()}
        document = {'numbers': [], 'tables': written} if file == 'numbers' else written
        write_json(str(folder / f'{file}.json'), document)
    picture = ROOT / 'docs' / 'images' / 'limit_launch.png'
    shutil.copy(picture, folder / 'engagements_launch.png')
    return folder


@pytest.fixture(scope='module', params=sampled(['basic', 'furo'], every=2))
def site(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory, results: Path
) -> Path:
    """
    Return the built site; a warning of Sphinx is an error.

    The theme of the site takes a quarter of the time for the list of all pages beside each page.
    """
    from website.__main__ import build

    out = tmp_path_factory.mktemp('made') / 'site'
    assert build(out, results, request.param) == 0
    return out


@needs_sphinx
@pytest.mark.slow
def test_the_site_is_whole(site: Path) -> None:
    """Every link arrives, it opens offline, and notebooks, equations and results are drawn."""
    assert list(faults(site)) == []
    assert (site / 'index.html').is_file()
    assert (site / 'searchindex.js').is_file()
    assert (site / 'COLCON_IGNORE').is_file(), 'colcon would find packages in the site'
    assert 'demand over scenario time' in page(site, 'reference/2_models_of_the_plant')
    notebook = page(site, 'docs/notebooks/thesis_in_one_hour')
    assert '<table' in notebook and 'alt="Slip reference over time' in notebook
    assert 'href="../notebooks/thesis_in_one_hour.html"' in page(site, 'docs/use/python')
    assert '>scores.schema.json<' in page(site, 'docs/use/python')
    assert len([*(site / '_downloads').rglob('*.schema.json')]) == len(DOCUMENTS)
    for name in ('docs/develop/gear_shift', 'docs/thesis/model', 'docs/thesis/plant'):
        assert '<math ' in page(site, name)
    text = ' '.join(page(site, name) for name in PAGES_OF_RESULTS)
    assert [f'{file} {name}' for file, name in _marks() if f'{file} {name}<' not in text] == []
    assert 'alt="Title of engagements_launch"' in page(site, 'docs/use/campaigns')


def page(site: Path, name: str) -> str:
    return (site / f'{name}.html').read_text(encoding='utf-8')


@pytest.mark.parametrize(
    ('body', 'count'),
    [
        ('<a href="b.html">', 1),
        ('<a href="#there">', 1),
        ('<a href="#here">', 0),
        ('<img src="a.html">', 1),
        ('<img src="a.html" alt="a picture">', 0),
        ('<script src="https://example.org/a.js">', 1),
        ('<a href="https://example.org/">', 0),
    ],
)
def test_links_without_a_target_and_pictures_without_text_are_found(
    body: str, count: int, tmp_path: Path
) -> None:
    (tmp_path / 'a.html').write_text(f'<p id="here">{body}</p>', encoding='utf-8')
    assert len(list(faults(tmp_path))) == count


def test_links_are_staged_with_their_files_and_those_to_folders_become_text(
    tmp_path: Path,
) -> None:
    text = '[top](../README.md) [code](../conftest.py) [all](../tests)\n```\n[a](b)\n```\n'
    found = staged(ROOT / 'docs' / 'README.md', text, tmp_path)
    assert found == '[top](../index.md) [code](../conftest.py) all\n```\n[a](b)\n```\n'
    assert (tmp_path / 'conftest.py').is_file()


def test_every_study_is_on_one_page() -> None:
    pages = [each.read_text(encoding='utf-8') for each in (ROOT / 'docs').rglob('*.md')]
    marks = [mark for text in pages for mark in MARK.findall(text)]
    assert sorted(name for file, name in marks if file == 'studies') == sorted(STUDIES)
    assert {file for file, _ in marks} == {*FILES}


@pytest.mark.parametrize('mark', ['<!-- table: studies none -->', '<!-- table: none wear -->'])
def test_a_table_that_no_file_has_is_refused(mark: str, results: Path, tmp_path: Path) -> None:
    with pytest.raises(DdctError, match='make site'):
        with_results(f'{mark}\n', results, tmp_path)
    assert with_results(f'`{mark}` in a line', results, tmp_path) == f'`{mark}` in a line'
