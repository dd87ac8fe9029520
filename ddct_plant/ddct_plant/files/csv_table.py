# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""CSV: read columns of numbers of any tool, with the line of an error; write text."""

import csv
import io
import math
import re
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import close_name
from ddct_plant.files.date_times import Instant, instant, is_date_time, seconds_since_first
from ddct_plant.files.input_file import any_text, read_file

COMMENT = '#'
"""First character of a comment line."""
_DELIMITERS = ',;\t'
_FORMULA = ('=', '@', '+', '-', '\t', '\r')
"""First characters of a formula in a spreadsheet."""
_NUMBER = re.compile(r'[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?')
_BLOCK_CHARACTERS = 1_000_000
_EMPTY = ('', 'nan')


def csv_text(names: Iterable[str], rows: Iterable[Sequence[Any]]) -> str:
    """
    Return the text of a CSV file with a header of names and the rows.

    A text that a spreadsheet would compute gets an apostrophe before it.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator='\n')
    writer.writerow([plain_cell(name) for name in names])
    writer.writerows([plain_cell(cell) for cell in row] for row in rows)
    return text.getvalue()


def plain_cell(cell: Any) -> Any:
    """Return a cell that a spreadsheet takes for text or a number, and never for a formula."""
    if not isinstance(cell, str) or not cell.startswith(_FORMULA) or _NUMBER.fullmatch(cell):
        return cell
    return f"'{cell}"


@dataclass(frozen=True)
class CsvTable:
    """Columns of a CSV file by name, with their lines."""

    path: Path
    """Path of the file."""
    lines: np.ndarray
    """Line number of each row, (n,), from 1."""
    columns: dict[str, np.ndarray]
    """Values of each column, (n,), by name; NaN where a cell is empty or `nan`."""

    def place(self, row: int, column: str) -> str:
        """Return the place of a cell for an error: file, line and column."""
        return _place(self.path, int(self.lines[row]), column)


def read_csv(
    path: Path,
    names: Iterable[str],
    *,
    most_bytes: int,
    most_rows: int,
    date_times: Collection[str] = (),
    optional: Collection[str] = (),
) -> CsvTable:
    """
    Return the columns called `names`, each once; those in `optional` may be missing.

    The first line that is neither empty nor a comment (#) is the header. The delimiter is comma,
    semicolon or tab, whichever is most frequent in it; with the latter two a comma may be the
    decimal mark. Columns in `date_times` have dates with times, which become s since the first
    row. Raise ParameterError that names the file, and line and column where possible.
    """
    blocks = _blocks(path, _text(path, most_bytes))
    _, (header,) = next(blocks, ([0], [[]]))
    if not header:
        raise ParameterError('it is empty: give a header and rows of numbers', place=path)
    places = {
        name: _column(path, header, name)
        for name in names
        if name in header or name not in optional
    }
    parts: dict[str, list[np.ndarray]] = {name: [] for name in places}
    instants: dict[str, list[Instant | None]] = {name: [] for name in date_times}
    lines: list[int] = []
    for numbers, rows in blocks:
        _require_rows(path, numbers, rows, len(header), most_rows - len(lines))
        lines += numbers
        columns = list(zip(*rows, strict=True))
        for name, place in places.items():
            if name in instants:
                found = zip(numbers, columns[place], strict=True)
                instants[name] += [_instant(path, line, name, cell) for line, cell in found]
            else:
                parts[name].append(_numbers(path, numbers, name, columns[place]))
    if not lines:
        raise ParameterError('no row of numbers below the header: give at least one', place=path)
    values = {
        name: np.array(_seconds(path, lines, name, instants[name]))
        if name in instants
        else np.concatenate(parts[name])
        for name in places
    }
    return CsvTable(path, np.array(lines), values)


def _require_rows(
    path: Path, numbers: Sequence[int], rows: Sequence[Sequence[str]], width: int, most: int
) -> None:
    """Raise ParameterError for more than `most` rows, or one of another width than the header."""
    if len(rows) > most:
        raise ParameterError(
            'it has too many rows: give fewer', place=f'{path}: line {numbers[most]}'
        )
    for line, row in zip(numbers, rows, strict=True):
        if len(row) != width:
            raise ParameterError(
                f'{len(row)} cells, while the header has {width}: mend the row',
                place=f'{path}: line {line}',
            )


def _text(path: Path, most_bytes: int) -> str:
    try:
        return any_text(read_file(path, most_bytes))
    except OSError as error:
        raise ParameterError(f'cannot be read ({error.strerror})', place=path) from error
    except ParameterError as error:
        raise error.at(path) from error


def _blocks(path: Path, text: str) -> Iterator[tuple[list[int], list[list[str]]]]:
    """
    Yield line numbers and cells of many rows at once, decimal commas as dots.

    The first block is the header alone.
    """
    delimiter = ''
    for number, content in _lines(text):
        kept = [
            (line, each)
            for line, each in enumerate(content, number)
            if each.strip() and not each.lstrip().startswith(COMMENT)
        ]
        if kept and not delimiter:
            line, first = kept.pop(0)
            delimiter = max(_DELIMITERS, key=first.count)
            yield [line], [_cells(path, line, first, delimiter)]
        if kept:
            decimal_comma = delimiter != ','
            rows = [_cells(path, line, each, delimiter, decimal_comma) for line, each in kept]
            yield [line for line, _ in kept], rows


def _lines(text: str) -> Iterator[tuple[int, list[str]]]:
    """Yield blocks of lines with the number of the first of each: all lines fill the memory."""
    start, number = 0, 1
    while start < len(text):
        end = text.find('\n', start + _BLOCK_CHARACTERS) + 1 or len(text)
        lines = text[start:end].splitlines()
        yield number, lines
        start, number = end, number + len(lines)


def _cells(
    path: Path, line: int, text: str, delimiter: str, decimal_comma: bool = False
) -> list[str]:
    if '"' not in text:
        cells = (text.replace(',', '.') if decimal_comma else text).split(delimiter)
        return [cell.strip() for cell in cells]
    try:
        cells = next(csv.reader([text], delimiter=delimiter))
    except csv.Error as error:
        raise ParameterError(
            f'it is no row of CSV ({error})', place=f'{path}: line {line}'
        ) from error
    return [cell.strip().replace(',', '.') if decimal_comma else cell.strip() for cell in cells]


def _column(path: Path, header: list[str], name: str) -> int:
    if (count := header.count(name)) != 1:
        known = close_name(name, [each for each in header if each])
        what = f'the column {name!r} is there {count} times' if count else f'no column {name!r}'
        raise ParameterError(
            f'{what}: {known if not count else "rename one"}', key=name, place=path
        )
    return header.index(name)


def _instant(path: Path, line: int, column: str, cell: str) -> Instant | None:
    if cell.lower() in _EMPTY:
        return None
    try:
        return instant(cell)
    except ParameterError as error:
        raise error.at(_place(path, line, column)) from None


def _seconds(
    path: Path, lines: Sequence[int], column: str, instants: Sequence[Instant | None]
) -> list[float]:
    """Return dates with times as s since the first; refuse a time zone in some of them only."""
    zones = [(line, each[2]) for line, each in zip(lines, instants, strict=True) if each]
    for line, zoned in zones:
        if zoned != zones[0][1]:
            raise ParameterError(
                f'it has {"a" if zoned else "no"} time zone, unlike line {zones[0][0]}: give '
                'every row one, or none',
                place=_place(path, line, column),
            )
    return seconds_since_first(instants)


def _numbers(path: Path, lines: Sequence[int], column: str, cells: Sequence[str]) -> np.ndarray:
    """Return the numbers in cells, (n,), NaN for an empty one."""
    try:
        numbers = np.array([float(cell) for cell in cells])
        if np.isfinite(numbers).all():
            return numbers
    except ValueError:
        pass
    found = zip(lines, cells, strict=True)
    return np.array([_number(path, line, column, cell) for line, cell in found])


def _number(path: Path, line: int, column: str, cell: str) -> float:
    if cell.lower() in _EMPTY:
        return math.nan
    try:
        number = float(cell)
    except ValueError:
        if is_date_time(cell):
            raise ParameterError(
                f'{cell!r} is a date and time: in the column map of a log give it the unit '
                'iso8601, elsewhere write seconds',
                place=_place(path, line, column),
            ) from None
        raise ParameterError(
            f'{cell!r} is no number: mend it, or put # before the line',
            place=_place(path, line, column),
        ) from None
    if not math.isfinite(number):
        raise ParameterError(f'{cell} is not finite: mend it', place=_place(path, line, column))
    return number


def _place(path: Path, line: int, column: str) -> str:
    return f'{path}: line {line}, column {column}'
