# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Columns of Arrow from values and back, without `pyarrow.array` and `to_numpy`.

Both import pandas where it is installed, which takes longer than a thousand linear runs.
"""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv as arrow_csv
import pyarrow.parquet as parquet

from ddct_plant.base.errors import printable
from ddct_plant.files.csv_table import plain_cell

_NUMBERS = {pa.int64(): np.int64, pa.float64(): np.float64}
_TYPES = (*_NUMBERS, pa.bool_(), pa.string())
_BATCH_ROWS = 65536
"""Rows that are read at once."""


def read_parquet(path: Path, most_rows: int | None = None, group: int | None = None) -> pa.Table:
    """
    Return all rows of a Parquet file, which may have `most_rows` where that is given.

    With `group` return those of one of its row groups.

    Raise OSError or ArrowException where that fails, ArrowException also for texts that are none.
    """
    try:
        with path.open('rb') as opened, parquet.ParquetFile(opened) as file:
            rows = file.metadata.num_rows
            if most_rows is not None and rows > most_rows:
                raise pa.ArrowInvalid(f'it has {rows} rows, not {most_rows}')
            for field in file.schema_arrow:
                if field.type not in _TYPES:
                    raise pa.ArrowInvalid(f'the column {field.name} is of type {field.type}')
            table = _rows_in(file, rows, group)
    except UnicodeDecodeError as error:
        raise pa.ArrowInvalid(f'its names are no text ({error})') from error
    table.validate(full=True)  # texts of a damaged file may be no UTF-8
    return table


def _rows_in(file: parquet.ParquetFile, rows: int, group: int | None) -> pa.Table:
    """Return rows of a file; raise ArrowException once there are more than it states."""
    batches, count = [], 0
    if group is not None and group >= file.num_row_groups:
        raise pa.ArrowInvalid(f'it has {file.num_row_groups} groups of rows')
    for batch in file.iter_batches(_BATCH_ROWS, None if group is None else [group]):
        count += len(batch)
        if count > rows:
            raise pa.ArrowInvalid(f'it has more rows than {rows}, which it states')
        batches.append(batch)
    table = pa.Table.from_batches(batches) if batches else file.read()
    return table.replace_schema_metadata(file.schema_arrow.metadata)


def arrow_column(kind: pa.DataType, values: Sequence[object]) -> pa.Array:
    """
    Return the column of a type, one of int64, float64, bool and string; None is a null.

    In a column of strings a list or a group of keys becomes its JSON.
    """
    nulls = None
    if None in values:
        nulls = _bits(np.array([value is not None for value in values]))
    if kind in _NUMBERS:
        filled = [0 if value is None else value for value in values] if nulls else values
        buffers = [nulls, pa.py_buffer(np.array(filled, dtype=_NUMBERS[kind]))]
    elif pa.types.is_boolean(kind):
        buffers = [nulls, _bits(np.array([bool(value) for value in values], dtype=bool))]
    else:
        texts = [_text(value).encode() for value in values]
        ends = np.cumsum([0, *map(len, texts)], dtype=np.int32)
        buffers = [nulls, pa.py_buffer(ends), pa.py_buffer(b''.join(texts))]
    return pa.Array.from_buffers(kind, len(values), buffers)


def numpy_column(column: pa.ChunkedArray) -> np.ndarray:
    """Return a column of a table, (n,): numbers with NaN for null, or objects with None."""
    if column.type in _NUMBERS and column.num_chunks:
        return np.concatenate([_numbers(chunk) for chunk in column.chunks])
    boolean = pa.types.is_boolean(column.type)
    if boolean or pa.types.is_string(column.type):
        plain = bool if boolean and not column.null_count else object
        return np.array(column.to_pylist(), dtype=plain)
    return np.asarray(column.to_numpy())


def numpy_columns(table: pa.Table) -> dict[str, np.ndarray]:
    """Return the columns of a table by name, (n,) each."""
    return {name: numpy_column(table[name]) for name in table.column_names}


def table_csv(table: pa.Table) -> str:
    """Return a table as CSV, with control characters in its texts escaped."""
    for place, field in enumerate(table.schema):
        if pa.types.is_string(field.type):
            words = [plain_cell(printable(each or '')) for each in table[field.name].to_pylist()]
            table = table.set_column(place, field, arrow_column(field.type, words))
    sink = pa.BufferOutputStream()
    arrow_csv.write_csv(table, sink)
    return sink.getvalue().to_pybytes().decode()


def _numbers(array: pa.Array) -> np.ndarray:
    valid, data = array.buffers()
    values = np.frombuffer(data, _NUMBERS[array.type])[array.offset : array.offset + len(array)]
    if not array.null_count:
        return values
    bits = np.unpackbits(np.frombuffer(valid, np.uint8), bitorder='little')
    return np.where(bits[array.offset : array.offset + len(array)] == 1, values, np.nan)


def _bits(values: np.ndarray) -> pa.Buffer:
    return pa.py_buffer(np.packbits(values, bitorder='little'))


def _text(value: object) -> str:
    if isinstance(value, (list, tuple, Mapping)):
        return json.dumps(value)
    return '' if value is None else str(value)
