# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Documents on the terminal: their tables, remarks and notes, in the order of the page."""

import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TextIO

from ddct_bringup.documents.document import (
    Block,
    Cell,
    Document,
    Note,
    Remarks,
    Section,
    Table,
)
from ddct_plant.program.printed_table import print_note, print_table
from ddct_plant.program.table import PURE, TextTable

_MOST_IN_GROUP = 3
"""Largest number of columns in groups that a table has side by side."""


def print_document(document: Document, stream: TextIO | None = None) -> None:
    """
    Print a document on standard output or a stream.

    What is folded on the page, figures and meanings are left out.
    """
    stream = stream or sys.stdout
    after_text = False
    for block in printed_blocks(document.content):
        is_text = isinstance(block, Note)
        if after_text and not is_text:
            print(file=stream)
        after_text = is_text
        if isinstance(block, Table):
            for part in _parts(block):
                print_table(text_table(part, document.complete), stream)
        elif isinstance(block, Remarks):
            for line in [f'{block.title}:', *block.lines] if block.alarming else block.lines:
                print_note(line, stream)
            print(file=stream)
        else:
            print_note(block.text, stream)
            if block.command:
                print(f'  {block.command}', file=stream)  # in one line, so that it can be copied
            if block.after:
                print_note(block.after, stream)


def _parts(table: Table) -> Iterator[Table]:
    """Yield a table, or where it has wide groups of columns one table for each group."""
    groups = Counter(column.group for column in table.columns if column.group)
    if max(groups.values(), default=0) <= _MOST_IN_GROUP:
        yield table
        return
    for group in groups:
        places = [at for at, each in enumerate(table.columns) if each.group in ('', group)]
        yield replace(
            table,
            title=f'{table.title}, {group}',
            columns=[replace(table.columns[at], group='') for at in places],
            rows=[[row[at] for at in places] for row in table.rows],
        )


def printed_blocks(blocks: Sequence[Block], title: str = '') -> Iterator[Table | Remarks | Note]:
    """Yield what the terminal shows; a table without a title gets that of its section."""
    for block in blocks:
        if isinstance(block, Section):
            if not (block.folded or block.page_only):
                yield from printed_blocks(block.content, block.title)
        elif isinstance(block, Table):
            yield block if block.title or not title else replace(block, title=title)
        elif isinstance(block, Remarks) or (isinstance(block, Note) and not block.page_only):
            yield block


def text_table(table: Table, complete: str = '') -> TextTable:
    """Return the texts of a table, for the terminal and for pages of the documentation."""
    cells = table.cells
    return TextTable(
        table.title,
        [column.heading for column in table.columns],
        [[_text(cell) for cell in row] for row in cells],
        numbers=[column.number for column in table.columns],
        weights=[column.weight for column in table.columns],
        reasons={
            (line, place): cell.reason
            for line, row in enumerate(cells)
            for place, cell in enumerate(row)
            if cell.reason
        },
        notes=table.notes,
        complete=complete,
    )


def _text(cell: Cell) -> str:
    unit = '' if cell.unit == PURE else f' {cell.unit}'
    below = f'; {cell.below}' if cell.below else ''
    return f'{cell.text}{unit}{below}'
