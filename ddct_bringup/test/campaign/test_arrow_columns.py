# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Columns of results are those of pyarrow, without the import of pandas."""

from pathlib import Path
from typing import NoReturn

import numpy as np
import pyarrow as pa
import pyarrow.parquet as parquet
import pytest

from ddct_bringup.campaign.arrow_columns import arrow_column, numpy_column, read_parquet

COLUMNS: dict[str, tuple[pa.DataType, list[object]]] = {
    'index': (pa.int64(), [3, -(2**53), 5]),
    'gear': (pa.int64(), [3, None, 5]),
    'jerk': (pa.float64(), [0.1, None, float('inf')]),
    'whole': (pa.float64(), [1, 2.5, 3]),
    'none': (pa.float64(), [None, None, None]),
    'valid': (pa.bool_(), [True, False, True]),
    'maybe': (pa.bool_(), [True, None, False]),
    'reason': (pa.string(), ['', 'größer → 3', None]),
}


@pytest.mark.parametrize('name', COLUMNS)
def test_a_column_is_that_of_pyarrow_and_comes_back_as_its_numbers(
    tmp_path: Path, name: str
) -> None:
    kind, values = COLUMNS[name]
    column = arrow_column(kind, values)
    column.validate(full=True)
    assert column.equals(pa.array(values, kind))
    parquet.write_table(pa.table({name: column}), tmp_path / 'results.parquet')
    read = read_parquet(tmp_path / 'results.parquet')[name]
    ours, theirs = numpy_column(read), read.to_numpy()
    assert ours.dtype == theirs.dtype
    np.testing.assert_array_equal(ours, theirs)


def test_the_columns_of_several_row_groups_are_joined(tmp_path: Path) -> None:
    table = pa.table({'gear': pa.array([1, 2, None, 4], pa.int64())})
    parquet.write_table(table, tmp_path / 'results.parquet', row_group_size=2)
    column = read_parquet(tmp_path / 'results.parquet')['gear'].slice(1)
    np.testing.assert_array_equal(numpy_column(column), [2.0, np.nan, 4.0])


def test_a_list_and_a_group_of_keys_become_json() -> None:
    column = arrow_column(pa.string(), [[0.6, 1.1], {'csv': 'a.csv'}])
    assert column.to_pylist() == ['[0.6, 1.1]', '{"csv": "a.csv"}']


def test_texts_that_are_no_utf_8_are_refused(tmp_path: Path) -> None:
    file = tmp_path / 'results.parquet'
    parquet.write_table(pa.table({'reason': ['stalled']}), file, compression='none')
    file.write_bytes(file.read_bytes().replace(b'stalled', b'sta\xffled'))
    with pytest.raises(pa.ArrowInvalid):
        read_parquet(file)


def test_a_file_with_more_rows_than_it_states_is_refused(tmp_path: Path) -> None:
    """The number of rows is 16 and twice its value in the footer, whose length is at the end."""
    file = tmp_path / 'results.parquet'
    parquet.write_table(pa.table({'index': list(range(50))}), file)
    content = file.read_bytes()
    footer = len(content) - 8 - int.from_bytes(content[-8:-4], 'little')
    place = content.index(b'\x16\x64', footer)
    file.write_bytes(content[:place] + b'\x16\x62' + content[place + 2 :])
    with pytest.raises(pa.ArrowInvalid, match='it has more rows than 49, which it states'):
        read_parquet(file)


@pytest.fixture
def nothing_is_read(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let reading rows fail, so that a file is refused by its metadata or not at all."""

    def read(*_: object) -> NoReturn:
        raise AssertionError('it is read')

    monkeypatch.setattr(parquet.ParquetFile, 'read', read)
    monkeypatch.setattr(parquet.ParquetFile, 'iter_batches', read)


@pytest.mark.parametrize(
    ('values', 'why'),
    [([0, 1], 'it has 2 rows, not 1'), ([[0]], 'the column a is of type list<element: int64>')],
    ids=['too many rows', 'a list'],
)
def test_a_file_is_refused_before_its_rows_are_read(
    tmp_path: Path, nothing_is_read: None, values: list[object], why: str
) -> None:
    file = tmp_path / 'results.parquet'
    parquet.write_table(pa.table({'a': values}), file)
    with pytest.raises(pa.ArrowInvalid, match=why):
        read_parquet(file, 1)
