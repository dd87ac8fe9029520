# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Print of tables within the width of a terminal, or 120 columns in a pipe or a file.

Nothing is cut. Headings and texts wrap at spaces; then columns of less weight are left out and
named below the table; then the needed columns are printed in blocks.
"""

import sys
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TextIO

from rich.cells import cell_len
from rich.console import Console
from rich.text import Text

from ddct_plant.base.errors import printable
from ddct_plant.program.table import UNDEFINED, Table, Weight

REDIRECTED_WIDTH = 120
"""Width in characters of a table in a file or a pipe."""
MOST_NOTES = 6
"""Largest number of lines below a table."""
STAR = '*'
"""Mark of a value with a reservation."""
_LEAST_WIDTH = 40
"""Narrower terminals wrap the lines themselves."""
_INDENT = _GAP = '  '
_READABLE = 28
"""Width in characters to which texts wrap before a column is left out."""
_NARROW = 12
"""Width in characters to which texts wrap before the columns are printed in blocks."""
_LONGEST_WORD = 18
"""Width in characters above which a word may be broken before blocks, unless it identifies."""


def print_table(table: Table, stream: TextIO | None = None) -> None:
    """Print a table on standard output or a stream, its control characters made visible."""
    stream = stream or sys.stdout
    console = Console(file=stream, highlight=False)
    for line, is_heading in table_lines(table, output_width(stream)):
        if stream.isatty():
            console.print(Text(line, 'bold' if is_heading else ''), soft_wrap=True)
        else:
            print(line, file=stream)
    print(file=stream)


def print_tables(tables: Iterable[Table]) -> None:
    """Print one table after the other."""
    for table in tables:
        print_table(table)


def print_note(text: str, stream: TextIO | None = None) -> None:
    """Print a sentence, wrapped as a table is, with its control characters made visible."""
    stream = stream or sys.stdout
    for line in _note_lines(printable(text), output_width(stream), ''):
        print(line, file=stream)


def output_width(stream: TextIO) -> int:
    """Return the width in characters for a stream: that of its terminal, or REDIRECTED_WIDTH."""
    if not stream.isatty():
        return REDIRECTED_WIDTH
    return max(Console(file=stream).width, _LEAST_WIDTH)


def table_lines(table: Table, width: int) -> list[tuple[str, bool]]:
    """Return the lines of a table, none wider than width, and whether each is a heading."""
    every = range(len(table.headers))
    shown = _shown(_columns(table, every), width)
    columns = _columns(table, [column.place for column in shown])
    lines = [(line, False) for line in _wrapped(printable(table.title), width) if line]
    for number, block in enumerate(_blocks(columns, width)):
        lines += [('', False)] if number else []
        widths = _widths(block, width)
        lines += [(line, True) for line in _row([c.heading for c in block], block, widths)]
        for cells in zip(*(column.cells for column in block), strict=True):
            lines += [(line, False) for line in _row(cells, block, widths, first=True)]
    return lines + [(line, False) for line in _footer(table, columns, width)]


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
    def readable(self) -> int:
        """Width in characters with the headings wrapped, and with long texts."""
        return self._wrapped_to(_READABLE, _READABLE)

    @cached_property
    def least(self) -> int:
        """Least width in characters that keeps numbers on a line, and words unless long."""
        identifies = self.weight == Weight.IDENTIFYING
        return self._wrapped_to(_NARROW, _READABLE if identifies else _LONGEST_WORD)

    def _wrapped_to(self, most: int, longest_word: int) -> int:
        """Return the width of texts of at most that width, and of words up to another."""
        words = [word for text in (self.heading, *self.cells) for word in text.split()]
        longest = min(max(map(cell_len, words), default=0), longest_word)
        texts = max(map(_width, self.cells), default=0)
        return max(longest, texts if self.number else min(texts, most))


def _columns(table: Table, places: Sequence[int]) -> list[_Column]:
    """Return columns of a table, the reasons of their dashes and stars numbered by marks."""
    marks = _marks(table, places)
    numbers, weights = list(table.numbers), list(table.weights)
    for place in range(len(numbers), len(table.headers)):
        numbers.append(all(_is_number(row[place]) for row in table.rows))
    weights += [Weight.NEEDED] * (len(table.headers) - len(weights))
    return [
        _Column(
            place,
            table.headers[place],
            _marked(table, place, marks, number=numbers[place]),
            numbers[place],
            weights[place],
        )
        for place in places
    ]


def _marks(table: Table, places: Sequence[int]) -> dict[tuple[str, str], str]:
    """Return the mark of each kind and reason: its n-th reason has its sign n times."""
    marks: dict[tuple[str, str], str] = {}
    for line, row in enumerate(table.rows):
        for place in places:
            if reason := table.reasons.get((line, place)):
                sign = UNDEFINED if _is_dash(row[place]) else STAR
                same = sum(kind == sign for kind, _ in marks)
                marks.setdefault((sign, reason), sign * (same + 1))
    return marks


def _marked(
    table: Table, place: int, marks: dict[tuple[str, str], str], *, number: bool
) -> list[str]:
    """Return the cells of a column with their marks; the digits of numbers stay in line."""
    texts, stars = [], []
    for line, row in enumerate(table.rows):
        reason = table.reasons.get((line, place), '')
        dash = _is_dash(row[place])
        mark = marks.get((UNDEFINED if dash else STAR, reason), '')
        first, *below = row[place].split('\n')
        texts.append([mark if dash and mark else printable(first), *map(printable, below)])
        stars.append('' if dash else mark)
    longest = max(map(len, stars), default=0) if number else 0
    return [
        '\n'.join([first + star.ljust(longest), *(text + ' ' * longest for text in below)])
        for (first, *below), star in zip(texts, stars, strict=True)
    ]


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return _is_dash(cell)
    return True


def _is_dash(cell: str) -> bool:
    return cell.split('\n')[0] == UNDEFINED


def _shown(columns: Sequence[_Column], width: int) -> list[_Column]:
    """Return the needed columns, and of the others by weight those for which there is room."""
    shown = [column for column in columns if column.weight >= Weight.NEEDED]
    others = [column for column in columns if column.weight < Weight.NEEDED]
    for column in sorted(others, key=lambda column: -column.weight):
        if _readable_width([*shown, column]) <= width:
            shown.append(column)
    return sorted(shown, key=lambda column: column.place)


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


def _readable_width(columns: Sequence[_Column]) -> int:
    return sum(column.readable + len(_GAP) for column in columns)


def _least_width(columns: Sequence[_Column]) -> int:
    return sum(column.least + len(_GAP) for column in columns)


def _widths(columns: Sequence[_Column], width: int) -> list[int]:
    """Return the width of each column; the widest is wrapped first, and broken last."""
    room = width - len(_GAP) * len(columns)
    widths = [min(column.natural, room) for column in columns]
    for least in ([column.least for column in columns], [1] * len(columns)):
        while sum(widths) > room:
            wide = [place for place, each in enumerate(widths) if each > least[place]]
            if not wide:
                break
            widths[max(wide, key=widths.__getitem__)] -= 1
    return widths


def _row(
    cells: Sequence[str], columns: Sequence[_Column], widths: Sequence[int], *, first: bool = False
) -> Iterator[str]:
    """Yield the lines of a row; they begin at its first line, or end at its last."""
    wrapped = [_wrapped(cell, width) for cell, width in zip(cells, widths, strict=True)]
    height = max(map(len, wrapped))
    for line in range(height):
        parts = []
        for lines, column, width in zip(wrapped, columns, widths, strict=True):
            place = line if first else line - height + len(lines)
            text = lines[place] if 0 <= place < len(lines) else ''
            space = ' ' * (width - cell_len(text))
            parts.append(space + text if column.number else text + space)
        yield (_INDENT + _GAP.join(parts)).rstrip()


def _footer(table: Table, columns: Sequence[_Column], width: int) -> list[str]:
    """Return the lines below a table: columns left out, warnings, reasons of marks, notes."""
    places = [column.place for column in columns]
    lines = _note_lines(_left_out(table, places), width)
    marks = (f'{mark}  {reason}' for mark, reason in _reasons(table, places))
    notes = [*table.warnings, *marks, *table.notes]
    for number, note in enumerate(notes):
        new, rest = _note_lines(printable(note), width), len(notes) - number
        if len(lines) + len(new) + (rest > 1) > MOST_NOTES:
            where = f', with {table.complete}' if table.complete else ''
            return [*lines, f'{_INDENT}{rest} more {"notes" if rest > 1 else "note"}{where}']
        lines += new
    return lines


def _reasons(table: Table, places: Sequence[int]) -> list[tuple[str, str]]:
    """Return each mark with its reason, the stars first."""
    return sorted((mark, reason) for (_, reason), mark in _marks(table, places).items())


def _left_out(table: Table, shown: Sequence[int]) -> str:
    """Return the sentence on the columns that are not shown; empty if all are."""
    names = [
        ' '.join(header.split())
        for place, header in enumerate(table.headers)
        if place not in shown
    ]
    if not names:
        return ''
    every = _readable_width(_columns(table, range(len(table.headers))))
    where = f'with {table.complete}' if table.complete else f'on a terminal of {every} columns'
    return f'not shown: {", ".join(names)}; all {where}'


def _note_lines(text: str, width: int, indent: str = _INDENT) -> list[str]:
    """Return the lines of a note, those after the first indented more; none of an empty one."""
    lines = _wrapped(text, width - len(indent + _INDENT))
    return [
        f'{indent}{_INDENT if number else ""}{line}' for number, line in enumerate(lines) if line
    ]


def _width(text: str) -> int:
    return max((cell_len(line) for line in text.split('\n')), default=0)


def _wrapped(text: str, width: int) -> list[str]:
    """Return the lines of a text, wrapped at spaces; a word is broken only where it is wider."""
    if _width(text) <= width:
        return text.split('\n')
    wrapped = Text(text).wrap(Console(width=width), width, overflow='fold')
    return [line.plain.rstrip() for line in wrapped]
