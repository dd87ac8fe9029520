# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Read and fill the tables between marks of the pages.

A table is between the lines `<!-- KIND: NAME -->` and `<!-- end -->`, on whichever page of the
docs or of a package.
"""

import re
from collections.abc import Mapping
from pathlib import Path

from ddct_plant.base.errors import DdctError
from ddct_plant.program.table import TextTable
from generator.markdown import as_markdown as markdown_of

DOCS = Path(__file__).resolve().parents[1]


def as_markdown(tables: Mapping[str, TextTable]) -> dict[str, str]:
    """Return the text of each table by name, with a final line end."""
    return {name: markdown_of(table) for name, table in tables.items()}


def shown_tables(kind: str, docs: Path = DOCS) -> dict[str, str]:
    """Return the text between the marks of a kind in the pages, by name."""
    shown: dict[str, str] = {}
    for page in marked_pages(docs):
        for match in _block(kind).finditer(page.read_text(encoding='utf-8')):
            if match[2] in shown:
                raise DdctError(f'{page}: the table {match[2]} of {kind} stands twice in the docs')
            shown[match[2]] = match[3]
    return shown


def rows_of(shown: str) -> list[tuple[str, ...]]:
    """Return the cells of each row of a table as the pages show it, without its header."""
    return [tuple(line[2:-2].split(' | ')) for line in shown.splitlines()[2:]]


def fill_pages(kind: str, tables: Mapping[str, TextTable], docs: Path = DOCS) -> list[Path]:
    """
    Write every table of a kind in its place and return the pages that have changed.

    Raise DdctError, before anything is written, unless the pages together have each table once and
    no other of this kind.
    """
    names = shown_tables(kind, docs)
    if sorted(names) != sorted(tables):
        raise DdctError(
            f'{docs}: the pages must have these tables of {kind}, each once: '
            f'{", ".join(tables)}; they have: {", ".join(names) or "none"}'
        )
    texts = as_markdown(tables)
    changed = []
    for page in marked_pages(docs):
        old = page.read_text(encoding='utf-8')
        new = _block(kind).sub(lambda match: f'{match[1]}{texts[match[2]]}{match[4]}', old)
        if new != old:
            page.write_text(new, encoding='utf-8')
            changed.append(page)
    return changed


def marked_pages(docs: Path = DOCS) -> list[Path]:
    """Return the pages that may have marks: those of the docs, and the READMEs of packages."""
    return sorted([*docs.rglob('*.md'), *docs.parent.glob('ddct_*/README.md')])


def _block(kind: str) -> re.Pattern[str]:
    return re.compile(rf'(<!-- {re.escape(kind)}: (\w+) -->\n)(.*?)(<!-- end -->)', re.DOTALL)
