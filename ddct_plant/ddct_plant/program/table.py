# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Quantities, tables of them, and their print: rich on a terminal, plain in a pipe or a file."""

import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import zip_longest
from typing import Any, Generic, TypeVar

from rich.box import SIMPLE
from rich.console import Console
from rich.markup import escape
from rich.table import Table as RichTable
from rich.text import Text

from ddct_plant.base.errors import printable

PURE = '1'
"""Unit of a pure number."""
UNDEFINED = '-'
"""Text of an undefined value."""


@dataclass(frozen=True)
class Quantity:
    """A number of a run, described once for terminal, JSON, documentation pages and the report."""

    key: str
    """Key in JSON."""
    symbol: str
    """Symbol in tables; an underscore begins its index."""
    unit: str
    """Unit, such as m/s^2, or PURE."""
    form: str
    """Format of the number, such as '.3f'."""
    meaning: str
    """Meaning in a few words."""
    undefined: str = ''
    """Condition under which it has no value."""

    @property
    def heading(self) -> str:
        """Symbol and unit, as the heading of a column."""
        return self.symbol if self.unit == PURE else f'{self.symbol} {self.unit}'

    def cell(self, values: Mapping[str, object]) -> str:
        """Return the text of this quantity's value, from values by key."""
        return text_or_dash(values[self.key], self.form)


Row = TypeVar('Row')


@dataclass(frozen=True)
class Column(Generic[Row]):
    """Column of a table: its heading, and the value and text of each row."""

    heading: str
    """Heading; a newline separates name and unit."""
    form: str
    """Format of the value, such as '.3f'."""
    value: Callable[[Row], Any]
    """Function from a row to its value; None, shown as a dash, where it is undefined."""
    number: bool = True
    """Whether the column is aligned to the right, where rich draws the table."""
    below: Callable[[Row], str] = lambda row: ''
    """Function from a row to the second line beneath the value; empty for none."""
    undefined: str = ''
    """Reason for an undefined value."""

    def text(self, row: Row) -> str:
        """Return the text of a row's value."""
        return text_or_dash(self.value(row), self.form)

    def cell(self, row: Row) -> str:
        """Return the text of a row's cell, of one line or two."""
        lines = (self.text(row), self.below(row))
        return '\n'.join(printable(line) for line in lines if line)


@dataclass(frozen=True)
class Table:
    """Rows of text, one cell per header, the same for the terminal and a documentation page."""

    title: str
    headers: Sequence[str]
    rows: Sequence[Sequence[str]]
    numbers: Sequence[bool] = field(default=(), kw_only=True)
    """Whether each column, from the first on, is aligned to the right; rich only."""

    def as_dict(self) -> dict[str, object]:
        """Return title, headers and rows for JSON, a row as a mapping from header to cell."""
        rows = [dict(zip(self.headers, row, strict=True)) for row in self.rows]
        return {'title': self.title, 'headers': list(self.headers), 'rows': rows}


def table_of(title: str, columns: Sequence[Column[Row]], rows: Iterable[Row]) -> Table:
    """Return the table of columns over rows."""
    return Table(
        title,
        [column.heading for column in columns],
        [[column.cell(row) for column in columns] for row in rows],
        numbers=[column.number for column in columns],
    )


def text_or_dash(value: object, form: str) -> str:
    """Return a value in a format, or a dash for None: an undefined value or no limit."""
    return UNDEFINED if value is None else format(value, form)


def as_markdown(table: Table) -> str:
    """Return a table as Markdown, with a final line end."""
    separator = ['---'] * len(table.headers)
    return ''.join(f'{_line(cells)}\n' for cells in (table.headers, separator, *table.rows))


def _line(cells: Sequence[str]) -> str:
    escaped = (cell.replace('|', r'\|') for cell in cells)
    return f'| {" | ".join(escaped)} |'


def print_table(table: Table) -> None:
    """Print a table on standard output, the control characters of its cells made visible."""
    rows = [[printable(cell) for cell in row] for row in table.rows]
    table = replace(table, title=printable(table.title), rows=rows)
    if sys.stdout.isatty():
        Console(highlight=False).print(drawn_by_rich(table), '')
        return
    columns = zip(table.headers, *rows, strict=True)
    widths = [max(len(cell) for cell in column) for column in columns]
    print(table.title)
    for row in (table.headers, *rows):
        cells = [cell.ljust(width) for cell, width in zip(row, widths, strict=True)]
        print('  ' + '  '.join(cells).rstrip())
    print()


def print_tables(tables: Iterable[Table]) -> None:
    """Print one table after the other."""
    for table in tables:
        print_table(table)


def drawn_by_rich(table: Table, *, ruled: bool = False) -> RichTable:
    """Return the table of rich; with `ruled` it has a rule below its headers, and cells wrap."""
    drawn = RichTable(
        title=escape(table.title) or None,
        title_justify='center' if ruled else 'left',
        box=SIMPLE if ruled else None,
        collapse_padding=True,
        pad_edge=False,
        header_style='table.header' if ruled else 'bold underline',
    )
    for header, number in zip_longest(table.headers, table.numbers):
        drawn.add_column(Text(header), justify='right' if number else 'left', no_wrap=not ruled)
    for row in table.rows:
        drawn.add_row(*(Text(cell) for cell in row))
    return drawn
