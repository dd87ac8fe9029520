# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Columns of `results.parquet`, and the conversion of rows to the bytes of a Parquet file."""

import math
from collections.abc import Mapping, Sequence
from operator import attrgetter
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.compute as compute
import pyarrow.parquet as parquet

from ddct_bringup.campaign.arrow_columns import arrow_column, read_parquet
from ddct_bringup.campaign.rows import (
    CONTROLLER,
    INDEX,
    METRIC_COLUMNS,
    PATH,
    SEED,
    SERIAL,
    STATE,
    ScoredRow,
)
from ddct_bringup.campaign.spec import CampaignSpec
from ddct_plant.base.errors import DdctError

SCHEMA_VERSION = 4
"""Schema version of the columns."""
_COMPRESSION = 'zstd'
_ROW_GROUP = 50_000
"""Smallest number of rows in a row group except the last: each group costs a reader memory."""
_FIRST = (
    (INDEX, pa.int64(), attrgetter('index')),
    (CONTROLLER, pa.string(), attrgetter('controller')),
    (PATH, pa.string(), attrgetter('path')),
    (SEED, pa.int64(), attrgetter('seed')),
)
_OUTCOME = (
    ('valid', pa.bool_(), attrgetter('scores.valid')),
    ('reason', pa.string(), attrgetter('scores.reason')),
    (STATE, pa.string(), attrgetter('scores.state')),
    ('why', pa.string(), attrgetter('scores.why')),
)
_OF_RUN = {name: value for name, _, value in (*_FIRST, *_OUTCOME)}
COMPARED = (SEED, *METRIC_COLUMNS, *(name for name, *_ in _OUTCOME))
"""Columns that a repeated run is compared in with its row."""
VECTORISED_RTOL = 1e-9
"""Largest difference of a row of the vectorised path, relative to the larger value."""
VECTORISED_ATOL = {
    'slip_final_rpm': 1e-6,
    'lockup_slip_acceleration_rad_s2': 1e-7,
}
"""
The same in the metric's unit, of metrics that may be far more sensitive than their signals.

1e-9 of 1000 rpm and of 100 rad/s^2, of values near zero.
"""


def schema_of(spec: CampaignSpec) -> pa.Schema:
    """Return the columns of a campaign; each varied key has one under its dotted name."""
    whole = [key for key, each in spec.vary.items() if each.whole]
    return schema_over({key: spec.values_of(key) for key in spec.keys}, whole)


def schema_over(varied: Mapping[str, Sequence[Any]], whole: Sequence[str] = ()) -> pa.Schema:
    """
    Return the columns of runs over the values of keys.

    A key without values has numbers, or whole numbers if it is one of `whole`.
    """
    fields = [
        *((name, kind) for name, kind, _ in _FIRST),
        *(
            (key, pa.int64() if key in whole else _type(values))
            for key, values in varied.items()
            if key != SEED
        ),
        *((name, pa.float64()) for name in METRIC_COLUMNS),
        *((name, kind) for name, kind, _ in _OUTCOME),
    ]
    return pa.schema(fields, {'schema_version': str(SCHEMA_VERSION)})


def runs_table(schema: pa.Schema, runs: Sequence[ScoredRow]) -> pa.Table:
    """Return a row for each run, with these columns."""
    columns = [arrow_column(field.type, _values(runs, field.name)) for field in schema]
    return pa.Table.from_arrays(columns, schema=schema)


def _values(runs: Sequence[ScoredRow], name: str) -> list[Any]:
    if name in _OF_RUN:
        return [_OF_RUN[name](run) for run in runs]
    if name in METRIC_COLUMNS:
        return [run.scores.metrics[name] for run in runs]
    return [run.varied[name] for run in runs]


def parquet_bytes(table: pa.Table, groups: int = 1) -> bytes:
    """Return a table as a Parquet file of so many groups of rows, the same for the same rows."""
    sink = pa.BufferOutputStream()
    in_group = max(len(table) // groups, 1)
    whole = table.combine_chunks()
    parquet.write_table(whole, sink, compression=_COMPRESSION, row_group_size=in_group)
    return sink.getvalue().to_pybytes()


def merge(
    shards: Mapping[Path, int], groups: int, schema: pa.Schema, target: Path, advice: str
) -> None:
    """
    Write the rows of all shards to one file, completely or not at all.

    A shard has as many `groups` of rows as there are controllers. The rows of the first controller
    come first, in the order of the shards. `shards` has the number of rows of each. Raise
    DdctError, with an advice, when that fails.
    """
    at_once = -(-_ROW_GROUP * groups // max(shards.values()))
    files = list(shards)
    partial = target.with_name(f'.{target.name}.partial')
    try:
        partial.unlink(missing_ok=True)  # of a killed program, or a pipe or link of a stranger
        with (
            partial.open('xb') as file,
            parquet.ParquetWriter(file, schema, compression=_COMPRESSION) as writer,
        ):
            for group in range(groups):
                for first in range(0, len(files), at_once):
                    tables = [
                        _rows_of(each, shards[each], groups, group, advice)
                        for each in files[first : first + at_once]
                    ]
                    writer.write_table(pa.concat_tables(tables))
        partial.replace(target)
    except DdctError:
        partial.unlink(missing_ok=True)
        raise
    except (OSError, pa.ArrowException) as error:
        partial.unlink(missing_ok=True)
        why = getattr(error, 'strerror', None) or error
        raise DdctError(f'cannot be written ({why}); {advice}', place=target) from error


def _rows_of(shard: Path, count: int, groups: int, group: int, advice: str) -> pa.Table:
    """Return a group of the rows of a shard; DdctError for one that has not `count` rows."""
    try:
        table = read_parquet(shard, count, group if groups > 1 else None)
        if len(table) * groups != count:
            raise pa.ArrowInvalid(f'it has {len(table)} rows in a group, not {count // groups}')
    except (OSError, pa.ArrowException) as error:
        raise DdctError(f'cannot be read ({error}): remove it; {advice}', place=shard) from error
    return table


def read_row(results: Path, index: int, runs: int) -> dict[str, Any]:
    """Return one of `runs` rows by column name; raise DdctError for a missing file or row."""
    try:
        table = read_parquet(results, runs)
        rows = table.filter(compute.equal(table[INDEX], index)).to_pylist()
    except (OSError, LookupError, ValueError, pa.ArrowException) as error:
        raise DdctError(f'{results}: cannot be read ({error}): finish the campaign') from error
    if not rows:
        last = compute.max(table[INDEX]).as_py()
        raise DdctError(f'{results}: it has no row {index}: the rows are 0 to {last}')
    if PATH not in rows[0]:
        raise DdctError(f'{results}: it has no column {PATH}')
    return rows[0]


def compared_in(row: Mapping[str, Any]) -> list[str]:
    """Return the columns of `COMPARED` that a row has; a row of another version may lack some."""
    return [name for name in COMPARED if name in row]


def differences(row: Mapping[str, Any], again: Mapping[str, Any]) -> list[str]:
    """
    Return the differences of a repeated run from its row, as text.

    Its seed, every metric and its state are compared: for a serial row to the last bit.
    """
    rtol = 0.0 if row[PATH] == SERIAL else VECTORISED_RTOL
    return [
        f'{name} is {again[name]!r}, in the row {row[name]!r}'
        for name in compared_in(row)
        if not _same(row[name], again[name], rtol, VECTORISED_ATOL.get(name, 0.0) if rtol else 0.0)
    ]


def _same(ours: Any, theirs: Any, rtol: float, atol: float) -> bool:
    if isinstance(ours, float) and isinstance(theirs, (int, float)):
        return math.isclose(ours, theirs, rel_tol=rtol, abs_tol=atol)
    return ours == theirs


def _type(values: Sequence[Any]) -> pa.DataType:
    if any(isinstance(value, (str, list, tuple, Mapping)) for value in values):
        return pa.string()
    if values and all(isinstance(value, bool) for value in values):
        return pa.bool_()
    if values and all(isinstance(value, int) for value in values):
        return pa.int64()
    return pa.float64()
