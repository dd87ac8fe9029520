"""Print a table: drawn by rich on a terminal, plain aligned columns in a pipe or a file."""

import sys
from collections.abc import Sequence

from ddct_plant.printable import printable


def text_or_dash(value: float | None, form: str) -> str:
    """Return a number in a format, or a dash for what does not exist or has no limit."""
    return '-' if value is None else format(value, form)


def print_table(title: str, headers: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """Print rows of text on standard output; every row has one cell per header."""
    title, rows = printable(title), [[printable(cell) for cell in row] for row in rows]
    if sys.stdout.isatty() and _print_rich(title, headers, rows):
        return
    widths = [max(len(cell) for cell in column) for column in zip(headers, *rows, strict=True)]
    print(title)
    for row in (headers, *rows):
        cells = [cell.ljust(width) for cell, width in zip(row, widths, strict=True)]
        print('  ' + '  '.join(cells).rstrip())
    print()


def _print_rich(title: str, headers: Sequence[str], rows: Sequence[Sequence[str]]) -> bool:
    """Print with rich and return True, or return False where rich is not installed."""
    try:
        from rich.console import Console
        from rich.markup import escape
        from rich.table import Table
    except ImportError:
        return False
    table = Table(
        title=escape(title),
        title_justify='left',
        box=None,
        collapse_padding=True,
        pad_edge=False,
        header_style='bold underline',
    )
    for header in headers:
        table.add_column(escape(header), no_wrap=True)
    for row in rows:
        table.add_row(*(escape(cell) for cell in row))
    Console().print(table, '')
    return True
