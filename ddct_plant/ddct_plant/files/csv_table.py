# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""CSV: read columns of numbers of any tool, with the line of an error; write text."""

import csv
import io
import math
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
_EMPTY = ('', 'nan')


def csv_text(names: Iterable[str], rows: Iterable[Sequence[Any]]) -> str:
    """Return the text of a CSV file with a header of names and the rows."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator='\n')
    writer.writerow(names)
    writer.writerows(rows)
    return text.getvalue()


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
) -> CsvTable:
    """
    Return the columns called `names`, each once.

    The first line that is neither empty nor a comment (#) is the header. The delimiter is comma,
    semicolon or tab, whichever is most frequent in it; with the latter two a comma may be the
    decimal mark. Columns in `date_times` have dates with times, which become s since the first
    row. Raise ParameterError that names the file, and line and column where possible.
    """
    rows = _rows(_text(path, most_bytes))
    _, header = next(rows, (0, []))
    if not header:
        raise ParameterError('it is empty: give a header and rows of numbers', place=path)
    places = {name: _column(path, header, name) for name in names}
    cells: dict[str, list[Any]] = {name: [] for name in places}
    lines: list[int] = []
    for line, row in rows:
        if len(lines) == most_rows:
            raise ParameterError(
                f'more than {most_rows} rows: give fewer', place=f'{path}: line {line}'
            )
        if len(row) != len(header):
            raise ParameterError(
                f'{len(row)} cells, while the header has {len(header)}: mend the row',
                place=f'{path}: line {line}',
            )
        lines.append(line)
        for name, place in places.items():
            read = _instant if name in date_times else _number
            cells[name].append(read(path, line, name, row[place]))
    if not lines:
        raise ParameterError('no row of numbers below the header: give at least one', place=path)
    for name in cells.keys() & set(date_times):
        cells[name] = _seconds(path, lines, name, cells[name])
    return CsvTable(path, np.array(lines), {name: np.array(each) for name, each in cells.items()})


def _text(path: Path, most_bytes: int) -> str:
    try:
        return any_text(read_file(path, most_bytes))
    except OSError as error:
        raise ParameterError(f'cannot be read ({error.strerror})', place=path) from error
    except ParameterError as error:
        raise error.at(path) from error


def _rows(text: str) -> Iterator[tuple[int, list[str]]]:
    """Yield line number and cells of each row, decimal commas as dots; the header first."""
    delimiter = ''
    for line, content in enumerate(text.splitlines(), 1):
        if not content.strip() or content.lstrip().startswith(COMMENT):
            continue
        first = not delimiter
        delimiter = delimiter or max(_DELIMITERS, key=content.count)
        cells = [cell.strip() for cell in next(csv.reader([content], delimiter=delimiter))]
        if delimiter != ',' and not first:
            cells = [cell.replace(',', '.') for cell in cells]
        yield line, cells


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
