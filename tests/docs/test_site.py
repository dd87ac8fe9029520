# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The documentation site builds without a warning, and every link of it arrives."""

import importlib.util
import re
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from samples import sampled
from website.links import faults
from website.results import FILES, result_table
from website.staging import ROOT, staged

from ddct_bringup.reproduction.studies.command import STUDIES
from ddct_bringup.reproduction.studies.study import WrittenStudy
from ddct_bringup.schemas import DOCUMENTS
from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import write_json
from ddct_plant.program.table import TextTable

# The resolver of myst-parser reads an attribute that Sphinx 11 will not have.
pytestmark = pytest.mark.filterwarnings("ignore:'myst_parser.*MystReferenceResolver.app'")
needs_sphinx = pytest.mark.skipif(
    importlib.util.find_spec('myst_parser') is None, reason='Sphinx is not there: make docs'
)


def shown_results() -> Iterator[tuple[str, str, str]]:
    """Yield page, file and name of each table of results that a page shows."""
    for page in sorted((ROOT / 'docs').rglob('*.md')):
        name = str(page.relative_to(ROOT).with_suffix(''))
        text = page.read_text(encoding='utf-8')
        for file, table in re.findall(r'^```\{ddct-results\} (\w+) (\w+)$', text, re.MULTILINE):
            yield name, file, table


@pytest.fixture(scope='module')
def results(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with small files in place of those that programs write."""
    folder = tmp_path_factory.mktemp('results')
    for file in FILES:
        tables = {
            name: TextTable(f'Title of {name}', ('key', 'value'), [('a | b', f'{file} {name}')])
            for _, each, name in shown_results()
            if each == file
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
    """Every link arrives, it opens offline, and notebooks, equations and tables are there."""
    assert list(faults(site)) == []
    assert (site / 'searchindex.js').is_file()
    assert (site / 'COLCON_IGNORE').is_file(), 'colcon would find packages in the site'
    assert 'demand over scenario time' in page(site, 'reference/2_models_of_the_plant')
    notebook = page(site, 'docs/notebooks/thesis_in_one_hour')
    assert '<table' in notebook and 'alt="Slip reference over time' in notebook
    assert len([*(site / '_downloads').rglob('*.schema.json')]) == len(DOCUMENTS)
    assert '<math ' in page(site, 'docs/develop/gear_shift')
    assert 'TwistStamped</p></td>' in page(site, 'docs/develop/graph')
    for name, file, table in shown_results():
        assert f'{file} {table}<' in page(site, name)
    assert 'alt="Title of engagements_launch"' in ''.join(
        page(site, name) for name, _, table in shown_results() if table == 'engagements_launch'
    )


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


def test_every_study_is_shown_once() -> None:
    shown = [name for _, file, name in shown_results() if file == 'studies']
    assert sorted(shown) == sorted(STUDIES)


@pytest.mark.parametrize(('file', 'name'), [('studies', 'none'), ('none', 'wear')])
def test_a_table_that_no_file_has_is_refused(
    file: str, name: str, results: Path, tmp_path: Path
) -> None:
    with pytest.raises(DdctError, match='make docs'):
        result_table(file, name, results, tmp_path)
