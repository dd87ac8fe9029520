# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The documentation site: every link arrives, it opens offline, and equations are drawn."""

import importlib.util
from pathlib import Path

import pytest
from website.links import faults
from website.staging import ROOT, staged

needs_sphinx = pytest.mark.skipif(
    importlib.util.find_spec('myst_parser') is None, reason='Sphinx is not there: make site'
)


@pytest.fixture(scope='module')
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the built site; a warning of Sphinx is an error."""
    from website.__main__ import build

    out = tmp_path_factory.mktemp('made') / 'site'
    assert build(out) == 0
    return out


@needs_sphinx
@pytest.mark.slow
def test_every_link_of_the_site_arrives_and_it_opens_offline(site: Path) -> None:
    assert list(faults(site)) == []
    assert (site / 'index.html').is_file()
    assert (site / 'searchindex.js').is_file()
    assert 'Engine torque over scenario time' in page(site, 'reference/2_models_of_the_plant')


@needs_sphinx
@pytest.mark.slow
def test_colcon_looks_for_no_package_in_the_site(site: Path) -> None:
    assert (site / 'COLCON_IGNORE').is_file()


@needs_sphinx
@pytest.mark.slow
def test_a_notebook_is_a_page_with_its_tables_and_pictures(site: Path) -> None:
    text = page(site, 'docs/notebooks/thesis_in_one_hour')
    assert '<table' in text
    assert 'alt="Slip reference over time' in text
    assert 'href="../notebooks/thesis_in_one_hour.html"' in page(site, 'docs/use/python')


@needs_sphinx
@pytest.mark.slow
def test_equations_are_drawn(site: Path) -> None:
    for name in ('docs/develop/gear_shift', 'docs/thesis/model', 'docs/thesis/plant'):
        assert '<math ' in page(site, name)


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
