# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""CSV: read columns of numbers of any tool, with the line of an error; write text."""

import codecs
import csv
import io
import math
import re
import reprlib
import warnings
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import close_name
from ddct_plant.files.date_times import is_date_time, seconds_since_first
from ddct_plant.files.input_file import located, user_bytes

_DELIMITERS = ',;\t'
_FORMULA = ('=', '@', '+', '-', '\t', '\r')
"""First characters of a formula in a spreadsheet."""
_NUMBER = re.compile(r'[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?')
_LINE = re.compile(r'[^\n]*\n|[^\n]+')
_QUOTED = re.compile(r'(?<![^\n,;\t ])"[^"]*(?:""[^"]*)*"')
_QUOTED_OR_COMMENT = re.compile(rf'({_QUOTED.pattern})|^[^\S\n]*#.*', re.MULTILINE)
_QUOTED_COMMA = re.compile(r'"\s*[-+]?\d*,\d')
_EMPTY = ('', 'nan', 'NaN', 'NAN')
"""Cells without a value."""


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
class _CsvText:
    """Text of a CSV file, its comments left out."""

    path: Path
    text: str
    delimiter: str

    @classmethod
    def of(cls, path: Path) -> '_CsvText':
        """Read a file; its delimiter is that which makes the most cells of the header."""
        with located(str(path)):
            text = _text_of(user_bytes(path))
        if '#' in text:
            text = _QUOTED_OR_COMMENT.sub(r'\1', text)
        found = (cls(path, text, each) for each in _DELIMITERS)
        return max(found, key=lambda each: len(each.header_and_below()[0]))

    def header_and_below(self) -> tuple[list[str], int]:
        """Return the cells of the header, none without one, and the place of the text below it."""
        lines, header = next(self._rows(), (range(1), []))
        return header, sum(map(len, islice(self._lines(), lines.stop - 1)))

    def rows(self) -> Iterator[tuple[int, list[str]]]:
        """Yield the first line, from 1, and the cells of each row below the header."""
        return ((lines.start, cells) for lines, cells in islice(self._rows(), 1, None))

    def _rows(self) -> Iterator[tuple[range, list[str]]]:
        """Yield the lines and the cells of each row that is not blank."""
        reader = csv.reader(self._lines(), delimiter=self.delimiter, skipinitialspace=True)
        start = 1
        try:
            for row in reader:
                cells = [cell.strip() for cell in row]
                if cells not in ([], ['']):
                    yield range(start, reader.line_num + 1), cells
                start = reader.line_num + 1
        except csv.Error as error:
            place = f'{self.path}: line {start}'
            raise ParameterError(
                f'it is no row of CSV ({error}): mend its quotes', place=place
            ) from error

    def _lines(self) -> Iterator[str]:
        return (found[0] for found in _LINE.finditer(self.text))


@dataclass(frozen=True)
class CsvTable:
    """Columns of a CSV file by name."""

    columns: Mapping[str, np.ndarray]
    """Values of each column, (n,), by name; NaN where a cell is empty or `nan`."""
    _source: _CsvText

    @cached_property
    def _lines(self) -> list[int]:
        return [line for line, _ in self._source.rows()]

    def place(self, row: int, column: str) -> str:
        """Return the place of a cell for an error: file, line and column."""
        return f'{self._source.path}: line {self._lines[row]}, column {column}'


def csv_header(path: Path) -> list[str]:
    """Return the names in the header of a file, none of an empty one; raise ParameterError."""
    return _CsvText.of(path).header_and_below()[0]


def read_csv(
    path: Path,
    names: Iterable[str],
    *,
    date_times: Collection[str] = (),
    optional: Collection[str] = (),
) -> CsvTable:
    """
    Return the columns called `names`, each once; those in `optional` may be missing.

    The first line that is neither empty nor a comment (#) is the header. Commas, semicolons or
    tabs part the cells; a comma in a cell is the decimal mark. Columns in `date_times` have dates
    with times, which become s since the first row. Raise ParameterError that names the file, and
    line and column where possible.
    """
    source = _CsvText.of(path)
    header, start = source.header_and_below()
    if not header:
        raise ParameterError('it is empty: give a header and rows of numbers', place=path)
    places = {
        name: _column(path, header, name)
        for name in names
        if name in header or name not in optional
    }
    numbers = {name: place for name, place in places.items() if name not in date_times}
    dates = {name: place for name, place in places.items() if name in date_times}
    cells = _by_pandas(source.text[start:], source.delimiter, len(header), numbers, dates)
    if cells is None:
        cells = _by_hand(source, len(header), numbers, dates)
    if not len(next(iter(cells.values()))):
        raise ParameterError('no row of numbers below the header: give at least one', place=path)
    table = CsvTable(cells, source)
    for name in dates:
        cells[name] = seconds_since_first(cells[name], partial(table.place, column=name))
    return table


def _by_pandas(
    text: str,
    delimiter: str,
    width: int,
    numbers: Mapping[str, int],
    dates: Mapping[str, int],
) -> dict[str, np.ndarray] | None:
    """
    Return numbers, and dates as texts, by name, of the text below a header of `width` cells.

    The result is None where a row has another width, or a cell is no finite number.
    """
    import pandas  # late: a run without a CSV file does not need it

    # From 3.1 on pandas reads every number to the last bit, and warns of this argument.
    version = tuple(int(part) for part in pandas.__version__.split('.')[:2])
    exact: Any = {} if version >= (3, 1) else {'float_precision': 'round_trip'}
    decimal_comma = _QUOTED_COMMA.search(text) if delimiter == ',' else ',' in text
    try:
        with warnings.catch_warnings():
            warnings.simplefilter('error', pandas.errors.ParserWarning)  # a row is too long
            frame = pandas.read_csv(
                io.BytesIO(text.encode()),
                sep=delimiter,
                header=None,
                names=range(width),
                index_col=False,
                dtype=dict.fromkeys(dates.values(), str),
                decimal=',' if decimal_comma else '.',
                keep_default_na=False,
                na_values=_EMPTY,
                skipinitialspace=True,
                low_memory=False,
                **exact,
            )
    except (ValueError, pandas.errors.ParserWarning):
        return None
    parted = _QUOTED.sub('', text) if '"' in text else text
    if parted.count(delimiter) != len(frame) * (width - 1):  # pandas fills up a short row
        return None
    if any(frame[place].dtype.kind not in 'iuf' for place in numbers.values()):
        return None
    columns = {name: frame[place].to_numpy(float) for name, place in numbers.items()}
    if any(np.isinf(each).any() for each in columns.values()):
        return None
    texts = {name: frame[place].fillna('').str.strip() for name, place in dates.items()}
    return {**columns, **{name: each.to_numpy() for name, each in texts.items()}}


def _by_hand(
    source: _CsvText, width: int, numbers: Mapping[str, int], dates: Mapping[str, int]
) -> dict[str, np.ndarray]:
    """Return what `_by_pandas` does, also with both decimal marks; refuse a bad cell."""
    columns: dict[str, list[Any]] = {name: [] for name in (*numbers, *dates)}
    for line, cells in source.rows():
        place = f'{source.path}: line {line}'
        if len(cells) != width:
            raise ParameterError(
                f'{len(cells)} cells in the row, {width} in the header: mend the row', place=place
            )
        for name, column in numbers.items():
            columns[name].append(_number(cells[column], f'{place}, column {name}'))
        for name, column in dates.items():
            columns[name].append('' if cells[column] in _EMPTY else cells[column])
    return {name: np.array(each) for name, each in columns.items()}


def _column(path: Path, header: list[str], name: str) -> int:
    if (count := header.count(name)) != 1:
        known = close_name(name, [each for each in header if each])
        what = f'the column {name!r} is there {count} times' if count else f'no column {name!r}'
        raise ParameterError(
            f'{what}: {known if not count else "rename one"}', key=name, place=path
        )
    return header.index(name)


def _number(cell: str, place: str) -> float:
    if cell in _EMPTY:
        return math.nan
    try:
        number = float(cell.replace(',', '.'))
    except ValueError:
        advice = 'mend it, or put # before the line'
        if is_date_time(cell):
            raise ParameterError(
                f'{cell!r} is a date and time: in the column map of a log give it the unit '
                'iso8601, elsewhere write seconds',
                place=place,
            ) from None
        raise ParameterError(f'{reprlib.repr(cell)} is no number: {advice}', place=place) from None
    if not math.isfinite(number):
        raise ParameterError(f'{cell} is not finite: mend it', place=place)
    return number


def _text_of(data: bytes) -> str:
    """
    Return the text of bytes from another tool, in one of the usual encodings and ends of lines.

    A byte order mark decides for UTF-8 or UTF-16. Without one the encoding is UTF-8 where that is
    possible, else Windows-1252, else Latin-1. Raise ParameterError for bytes that are no text.
    """
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        encodings = ['utf-16']
    else:
        encodings = ['utf-8-sig', 'cp1252', 'latin-1']
    for encoding in encodings:
        try:
            text = data.decode(encoding)
        except UnicodeDecodeError:
            continue
        if '\0' not in text:
            return text.replace('\r\n', '\n').replace('\r', '\n')
    raise ParameterError('it is no text: give a file of text, best in UTF-8')
