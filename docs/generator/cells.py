# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Cells of generated tables that a sentence of a page repeats.

A repeated cell is between `<!-- cell: KIND NAME; ROW; COLUMN -->` and `<!-- end -->`. KIND and
NAME are those of the table's mark. ROW is the first cell of the row, or, where several rows have
it, as many first cells as one row alone has, with `;` between them. COLUMN is the heading. A
further part such as `.1f` rounds the number.
"""

import re
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path

from ddct_plant.base.errors import DdctError
from generator.pages import rows_of, shown_tables

Shown = Callable[[str], Mapping[str, str]]
"""Function that returns the text of the tables of a kind by name."""
_MARKED = re.compile(r'(<!-- cell: (.+?) -->)(.*?)(<!-- end -->)', re.DOTALL)
_FORM = re.compile(r'\.\df')


def marked_cells(page: Path) -> list[tuple[str, str]]:
    """Return reference and text of each repeated cell on a page, in their order."""
    return [(match[2], match[3]) for match in _MARKED.finditer(page.read_text(encoding='utf-8'))]


def fill_cells(page: Path) -> bool:
    """Write the repeated cells of a page; return whether it has changed."""
    old, shown = page.read_text(encoding='utf-8'), cache(shown_tables)
    new = _MARKED.sub(lambda match: f'{match[1]}{cell(match[2], shown)}{match[4]}', old)
    if new != old:
        page.write_text(new, encoding='utf-8')
    return new != old


def cell(reference: str, tables: Shown = shown_tables) -> str:
    """Return the text of a cell; raise DdctError unless one row and one column fit."""
    table, *row, column = (part.strip() for part in reference.split(';'))
    form = ''
    if _FORM.fullmatch(column):
        form, column = column, row.pop()
    kind, _, name = table.partition(' ')
    try:
        shown = tables(kind)[name]
    except KeyError:
        raise DdctError(f'cell {reference}: no page has the table {table}', key=table) from None
    headers = shown.splitlines()[0][2:-2].split(' | ')
    rows = [cells for cells in rows_of(shown) if list(cells[: len(row)]) == row]
    if len(rows) != 1 or headers.count(column) != 1:
        raise DdctError(
            f'cell {reference}: {table} has {len(rows)} such rows and the columns '
            f'{", ".join(headers)}: name one row and one column',
            key=reference,
        )
    text = rows[0][headers.index(column)]
    return f'{float(text):{form}}' if form else text
