"""Figures, tables of them, and their print: by rich on a terminal, plain in a pipe or a file."""

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


@dataclass(frozen=True)
class Figure:
    """A number, described once for terminal, JSON, documentation pages and the report."""

    key: str
    """Name in JSON."""
    symbol: str
    """What a table calls it; an underscore begins the index."""
    unit: str
    """Such as m/s^2, or PURE."""
    form: str
    """Format of the number."""
    meaning: str
    undefined: str = ''
    """When it has no value."""

    @property
    def heading(self) -> str:
        """Symbol and unit."""
        return self.symbol if self.unit == PURE else f'{self.symbol} {self.unit}'

    def cell(self, values: Mapping[str, float | None]) -> str:
        """Return its text among values by name."""
        return text_or_dash(values[self.key], self.form)


Row = TypeVar('Row')


@dataclass(frozen=True)
class Column(Generic[Row]):
    """What a table says of each of its rows."""

    heading: str
    """A newline parts the name from the unit."""
    form: str
    """Format of the value."""
    value: Callable[[Row], Any]
    """None, shown as a dash, for what is undefined."""
    number: bool = True
    """Whether it belongs to the right of its column, where rich draws the table."""
    below: Callable[[Row], str] = lambda row: ''
    """What a second line says beneath the value; empty for none."""
    undefined: str = ''
    """Why there may be a dash."""

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
    """Which columns are aligned to the right, from the first on; by rich alone."""


def table_of(title: str, columns: Sequence[Column[Row]], rows: Iterable[Row]) -> Table:
    """Return the table of columns over rows."""
    return Table(
        title,
        [column.heading for column in columns],
        [[column.cell(row) for column in columns] for row in rows],
        numbers=[column.number for column in columns],
    )


def text_or_dash(value: Any, form: str) -> str:
    """Return a value in a format, or a dash for what does not exist or has no limit."""
    return UNDEFINED if value is None else format(value, form)


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
    """Return a table as rich draws it; with a rule below its headers, cells may wrap."""
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
