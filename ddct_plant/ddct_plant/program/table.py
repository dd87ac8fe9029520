"""A table of text, and its print: drawn by rich on a terminal, plain in a pipe or a file."""

import sys
from collections.abc import Sequence
from dataclasses import dataclass

from ddct_plant.base.printable import printable


@dataclass(frozen=True)
class Table:
    """Rows of text, one cell per header, the same for the terminal and a documentation page."""

    title: str
    headers: Sequence[str]
    rows: Sequence[Sequence[str]]


def text_or_dash(value: float | None, form: str) -> str:
    """Return a number in a format, or a dash for what does not exist or has no limit."""
    return '-' if value is None else format(value, form)


def print_table(table: Table) -> None:
    """Print a table on standard output, the control characters of its cells made visible."""
    rows = [[printable(cell) for cell in row] for row in table.rows]
    table = Table(printable(table.title), table.headers, rows)
    if sys.stdout.isatty() and _print_rich(table):
        return
    columns = zip(table.headers, *rows, strict=True)
    widths = [max(len(cell) for cell in column) for column in columns]
    print(table.title)
    for row in (table.headers, *rows):
        cells = [cell.ljust(width) for cell, width in zip(row, widths, strict=True)]
        print('  ' + '  '.join(cells).rstrip())
    print()


def _print_rich(table: Table) -> bool:
    """Print with rich and return True, or return False where rich is not installed."""
    try:
        from rich.console import Console
        from rich.markup import escape
        from rich.table import Table as RichTable
    except ImportError:
        return False
    drawn = RichTable(
        title=escape(table.title),
        title_justify='left',
        box=None,
        collapse_padding=True,
        pad_edge=False,
        header_style='bold underline',
    )
    for header in table.headers:
        drawn.add_column(escape(header), no_wrap=True)
    for row in table.rows:
        drawn.add_row(*(escape(cell) for cell in row))
    Console().print(drawn, '')
    return True
