# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Print of tables by rich within the width of a terminal, or 120 columns in a pipe or a file.

Nothing is cut. Headings and texts wrap at spaces; then columns of less weight are left out and
named below the table; then the needed columns are printed in blocks.
"""

import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TextIO

from rich.cells import cell_len
from rich.console import Console
from rich.table import Table as Grid
from rich.text import Text

from ddct_plant.base.errors import printable
from ddct_plant.program.table import UNDEFINED, TextTable, Weight

_REDIRECTED_WIDTH = 120
"""Width in characters of a table in a file or a pipe."""
_MOST_NOTES = 6
"""Largest number of notes below a table."""
_STAR = '*'
"""Mark of a value with a reservation."""
_LEAST_WIDTH = 40
"""Narrower terminals wrap the lines themselves."""
_GAP = '  '
"""Space before each column and each note."""
_READABLE = 28
"""Width in characters to which texts wrap before a column is left out."""
_NARROW = 12
"""Width in characters to which texts wrap before the columns are printed in blocks."""
_LONGEST_WORD = 24
"""Width in characters above which a word may be broken."""


def print_table(table: TextTable, stream: TextIO | None = None) -> None:
    """Print a table on standard output or a stream, its control characters made visible."""
    stream = stream or sys.stdout
    console = _console(stream)
    every = range(len(table.headers))
    columns, _ = _marked(table, every)
    shown = _shown(columns, console.width)
    left_out = [column for column in columns if column.place not in shown]
    columns, reasons = _marked(table, shown)
    with console.capture() as printed:
        if table.title:
            console.print(Text(printable(table.title)))
        for number, block in enumerate(_blocks(columns, console.width)):
            if number:
                console.print()
            console.print(_grid(block, console.width))
        for note in _notes(table, left_out, reasons, _readable_width([*columns, *left_out])):
            console.print(_wrapped(printable(note), console, _GAP))
    # Rich fills the last column with spaces.
    print(*(line.rstrip(' ') for line in printed.get().split('\n')), sep='\n', file=stream)


def print_tables(tables: Iterable[TextTable]) -> None:
    """Print one table after the other."""
    for table in tables:
        print_table(table)


def print_note(text: str, stream: TextIO | None = None) -> None:
    """Print a sentence, wrapped as a table is, with its control characters made visible."""
    stream = stream or sys.stdout
    print(_wrapped(printable(text), _console(stream), '').plain, file=stream)


def _console(stream: TextIO | None) -> Console:
    """
    Return the console of a stream, as wide as its terminal or _REDIRECTED_WIDTH.

    The stream is None for a standard output that was closed before the start; nothing is printed.
    """
    is_terminal = stream is not None and stream.isatty()
    width = None if is_terminal else _REDIRECTED_WIDTH
    console = Console(
        file=stream,
        force_terminal=is_terminal,
        force_jupyter=False,  # in a notebook too it is text
        width=width,
        highlight=False,
    )
    console.width = max(console.width, _LEAST_WIDTH)
    return console


@dataclass(frozen=True)
class _Column:
    """Texts of one column, with their marks."""

    place: int
    heading: str
    cells: Sequence[str]
    number: bool
    weight: Weight

    @cached_property
    def natural(self) -> int:
        """Width in characters without wrapped lines."""
        return max(map(_width, (self.heading, *self.cells)))

    @cached_property
    def least(self) -> int:
        """Least width in characters that keeps numbers on a line, and words unless long."""
        return self.wrapped_to(_NARROW)

    def wrapped_to(self, most: int) -> int:
        """Return the width of texts of at most that width, and of words unless long."""
        words = (word for text in (self.heading, *self.cells) for word in text.split())
        longest = min(max(map(cell_len, words), default=0), _LONGEST_WORD)
        texts = max(map(_width, self.cells), default=0)
        return max(longest, texts if self.number else min(texts, most))


def _width(text: str) -> int:
    return max(map(cell_len, text.split('\n')))


def _marked(table: TextTable, places: Sequence[int]) -> tuple[list[_Column], dict[str, str]]:
    """Return columns with marks at their dashes and stars, and the reason of each mark."""
    marks: dict[tuple[str, str], str] = {}
    cells: dict[int, list[str]] = {place: [] for place in places}
    for line, row in enumerate(table.rows):
        for place in places:
            text = printable(row[place])
            if reason := table.reasons.get((line, place)):
                sign = UNDEFINED if text == UNDEFINED else _STAR
                # The n-th reason has its sign n times.
                same = sum(kind == sign for kind, _ in marks)
                mark = marks.setdefault((sign, reason), sign * (same + 1))
                text = mark if sign == UNDEFINED else text + mark
            cells[place].append(text)
    columns = [_column(table, place, cells[place]) for place in places]
    return columns, {mark: reason for (_, reason), mark in marks.items()}


def _column(table: TextTable, place: int, cells: Sequence[str]) -> _Column:
    """Return a column; in one of numbers, spaces in place of stars keep the digits in line."""
    weight = table.weights[place] if place < len(table.weights) else Weight.NEEDED
    if place < len(table.numbers):
        number = table.numbers[place]
    else:
        number = all(_is_number(row[place]) for row in table.rows)
    if number:
        stars = [len(cell) - len(cell.rstrip(_STAR)) for cell in cells]
        longest = max(stars, default=0)
        cells = [cell + ' ' * (longest - own) for cell, own in zip(cells, stars, strict=True)]
    return _Column(place, table.headers[place], cells, number, weight)


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return cell == UNDEFINED
    return True


def _shown(columns: Sequence[_Column], width: int) -> list[int]:
    """Return the needed columns, and of the others by weight those for which there is room."""
    shown = [column for column in columns if column.weight >= Weight.NEEDED]
    others = [column for column in columns if column.weight < Weight.NEEDED]
    for column in sorted(others, key=lambda column: -column.weight):
        if _readable_width([*shown, column]) <= width:
            shown.append(column)
    return sorted(column.place for column in shown)


def _readable_width(columns: Sequence[_Column]) -> int:
    return sum(len(_GAP) + column.wrapped_to(_READABLE) for column in columns)


def _least_width(columns: Sequence[_Column]) -> int:
    return sum(len(_GAP) + column.least for column in columns)


def _blocks(columns: Sequence[_Column], width: int) -> list[list[_Column]]:
    """Return the columns in blocks that fit into the width, each with the identifying columns."""
    if _least_width(columns) <= width:
        return [list(columns)]
    keys = [column for column in columns if column.weight == Weight.IDENTIFYING]
    blocks: list[list[_Column]] = [[]]
    for column in columns:
        if column in keys:
            continue
        if blocks[-1] and _least_width([*keys, *blocks[-1], column]) > width:
            blocks.append([])
        blocks[-1].append(column)
    return [[*keys, *block] for block in blocks]


def _grid(block: Sequence[_Column], width: int) -> Grid:
    """Return a block of columns for the console."""
    grid = Grid(box=None, padding=(0, 0, 0, len(_GAP)), header_style='bold')
    widths = _widths(block, width - len(_GAP) * len(block))
    for column, each in zip(block, widths, strict=True):
        heading = Text(column.heading, justify='right' if column.number else 'left')
        grid.add_column(heading, width=each, overflow='fold')
    for cells in zip(*(column.cells for column in block), strict=True):
        # Rich's justification to the right would drop the spaces behind digits.
        placed = zip(block, cells, widths, strict=True)
        grid.add_row(*(Text(cell.rjust(w) if each.number else cell) for each, cell, w in placed))
    return grid


def _widths(block: Sequence[_Column], room: int) -> list[int]:
    """Return the width of each column; the widest ones are wrapped, and broken where they must."""

    def at_most(width: int) -> list[int]:
        return [max(column.least, min(column.natural, width)) for column in block]

    widths = next(
        (fitting for width in range(room, 0, -1) if sum(fitting := at_most(width)) <= room),
        at_most(1),
    )
    while sum(widths) > room:
        widths[widths.index(max(widths))] -= 1
    return widths


def _notes(
    table: TextTable, left_out: Sequence[_Column], reasons: dict[str, str], width: int
) -> list[str]:
    """Return the notes below a table, which is `width` characters wide with all columns."""
    notes = [*table.warnings, *(f'{mark}  {reasons[mark]}' for mark in sorted(reasons))]
    notes += table.notes
    if left_out:
        names = ', '.join(' '.join(column.heading.split()) for column in left_out)
        where = f'with {table.complete}' if table.complete else f'on a terminal of {width} columns'
        notes.insert(0, f'not shown: {names}; all {where}')
    if len(notes) > _MOST_NOTES:
        where = f', with {table.complete}' if table.complete else ''
        notes[_MOST_NOTES - 1 :] = [f'{len(notes) - _MOST_NOTES + 1} more notes{where}']
    return notes


def _wrapped(text: str, console: Console, indent: str) -> Text:
    """Return a sentence in lines, those after the first indented more."""
    lines = Text(text).wrap(console, console.width - len(indent + _GAP), overflow='fold')
    return Text(indent + f'\n{indent}{_GAP}'.join(line.plain.rstrip() for line in lines))
