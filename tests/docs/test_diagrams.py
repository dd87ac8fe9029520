"""The diagrams of the pages are those that their program draws."""

import runpy
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / 'docs'


def test_the_images_are_what_the_program_draws(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(DOCS))
    program = runpy.run_path(str(DOCS / 'block_diagrams.py'))
    sys.modules.pop('diagrams')
    drawings = program['drawings']()
    assert len(drawings) == 5
    for file, drawing in drawings.items():
        ElementTree.fromstring(drawing)
        again = 'draw it again: .venv/bin/python docs/block_diagrams.py'
        assert (DOCS / 'images' / file).read_text(encoding='utf-8') == drawing, again
