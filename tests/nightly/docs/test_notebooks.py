# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The notebooks run from the first cell to the last, and give the texts that they keep."""

from pathlib import Path
from typing import Any

import pytest
from support.documented import ROOT
from website.notebook_pages import notebook_page

from notebook_outputs.outputs import executed, notebooks, pictures_of, read_notebook, texts_of

pytest.importorskip('nbclient', reason='an extra of the tests')
EACH = pytest.mark.parametrize('path', notebooks(), ids=lambda path: path.stem)
HELPERS = ROOT / 'ddct_bringup' / 'test' / 'helpers'
SMALL_BENCHMARK = """
import sys
from pathlib import Path
from pytest import MonkeyPatch
sys.path.insert(0, {helpers!r})
from small_benchmark import use_small_release
use_small_release(Path({place!r}), MonkeyPatch())
"""
"""Code that puts a benchmark of few cases in the place of the packaged one of minutes."""
MAKE = 'run: tools/run notebook_outputs'


@EACH
@pytest.mark.slow
def test_a_notebook_gives_the_texts_and_tables_that_it_keeps(path: Path, tmp_path: Path) -> None:
    first = SMALL_BENCHMARK.format(helpers=str(HELPERS), place=str(tmp_path))
    kept = read_notebook(path)
    found = executed(path, first if 'benchmark(' in path.read_text(encoding='utf-8') else '')
    assert texts_of(found) == texts_of(kept), MAKE
    assert pictures_of(found) == pictures_of(kept), MAKE


@EACH
def test_every_cell_has_its_outputs_and_every_picture_an_alternative_text(path: Path) -> None:
    notebook: Any = read_notebook(path)
    counts = [cell.execution_count for cell in notebook.cells if cell.cell_type == 'code']
    assert counts == list(range(1, len(counts) + 1)), MAKE
    assert pictures_of(notebook) and all(pictures_of(notebook))


def test_the_notebooks_are_the_three_that_the_list_of_pages_has() -> None:
    page = (ROOT / 'docs' / 'README.md').read_text(encoding='utf-8')
    assert len(notebooks()) == 3
    assert all(f'](notebooks/{path.name})' in page for path in notebooks())


@EACH
def test_the_page_of_a_notebook_has_its_tables_and_pictures(path: Path, tmp_path: Path) -> None:
    page = notebook_page(path, tmp_path / 'pictures')
    assert '<style' not in page
    assert '<table' in page
    pictures = list((tmp_path / 'pictures').glob('*.png'))
    assert pictures and all(f'](pictures/{each.name})' in page for each in pictures)
