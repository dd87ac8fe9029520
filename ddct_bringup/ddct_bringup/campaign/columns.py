"""The columns of `results.parquet`, and how rows become the bytes of a Parquet file."""

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as parquet

from ddct_bringup.campaign.rows import CRITERION_COLUMNS, METRIC_COLUMNS, SERIAL
from ddct_bringup.campaign.spec import CampaignSpec
from ddct_plant.base.errors import DdctError

SCHEMA_VERSION = 2
"""Of the columns: from 2 on each row has its `seed`."""
INDEX, CONTROLLER, PATH, SEED = 'index', 'controller', 'path', 'seed'
_COMPRESSION = 'zstd'
_ROW_GROUP = 50_000
"""Rows at least, but in the last group: each group costs a reader memory."""
_VERDICT = (
    ('valid', pa.bool_()),
    ('reason', pa.string()),
    ('verdict_state', pa.string()),
    ('verdict_limits', pa.string()),
)
COMPARED = (SEED, *METRIC_COLUMNS, *(name for name, _ in _VERDICT), *CRITERION_COLUMNS)
"""What a run that is made again must have as its row has it."""
VECTORISED_RTOL = 1e-9
"""What a row of the vectorised path may differ by then, relative to the larger value."""


def schema_of(spec: CampaignSpec) -> pa.Schema:
    """Return the columns of a campaign; what varies has one by its dotted key."""
    fields = [
        (INDEX, pa.int64()),
        (CONTROLLER, pa.string()),
        (PATH, pa.string()),
        (SEED, pa.int64()),
        *((key, _type(spec, key)) for key in spec.keys if key != SEED),
        *((name, pa.float64()) for name in METRIC_COLUMNS),
        *_VERDICT,
        *((name, pa.float64()) for name in CRITERION_COLUMNS),
    ]
    return pa.schema(fields, {'schema_version': str(SCHEMA_VERSION)})


def shard_bytes(schema: pa.Schema, rows: Iterable[Mapping[str, Any]]) -> bytes:
    """Return rows as a Parquet file, the same bytes for the same rows."""
    cells = [{name: _cell(row[name]) for name in schema.names} for row in rows]
    sink = pa.BufferOutputStream()
    table = pa.Table.from_pylist(cells, schema)
    parquet.write_table(table, sink, compression=_COMPRESSION)
    return sink.getvalue().to_pybytes()


def holds_rows(path: Path, schema: pa.Schema, first: int, last: int) -> bool:
    """Say whether a file is whole and holds the rows `first` to `last`, the latter excluded."""
    try:
        table = parquet.read_table(path)
    except (OSError, pa.ArrowException):
        return False
    return table.schema.equals(schema) and table[INDEX].to_pylist() == list(range(first, last))


def merge(
    shards: Sequence[Path], shard_size: int, schema: pa.Schema, target: Path, advice: str
) -> None:
    """
    Write the rows of all shards, in their order, into one file, whole or not at all.

    `shard_size` is the number of rows in each but the last. Raise DdctError, with an advice, when
    that fails.
    """
    in_group = -(-_ROW_GROUP // shard_size)
    partial = target.with_name(f'.{target.name}.partial')
    try:
        with (
            partial.open('wb') as file,
            parquet.ParquetWriter(file, schema, compression=_COMPRESSION) as writer,
        ):
            for first in range(0, len(shards), in_group):
                tables = [parquet.read_table(each) for each in shards[first : first + in_group]]
                writer.write_table(pa.concat_tables(tables))
        partial.replace(target)
    except (OSError, pa.ArrowException) as error:
        partial.unlink(missing_ok=True)
        why = getattr(error, 'strerror', None) or error
        raise DdctError(f'{target}: cannot be written ({why}); {advice}') from error


def read_row(results: Path, index: int) -> dict[str, Any]:
    """Return one row by column name; raise DdctError for a file or a row that is not there."""
    try:
        rows = parquet.read_table(results, filters=[(INDEX, '=', index)]).to_pylist()
    except (OSError, pa.ArrowException) as error:
        raise DdctError(f'{results}: cannot be read ({error}): finish the campaign') from error
    if not rows:
        raise DdctError(f'{results}: it has no row {index}')
    if PATH not in rows[0]:
        raise DdctError(f'{results}: it has no column {PATH}')
    return rows[0]


def compared_in(row: Mapping[str, Any]) -> list[str]:
    """Return what of `COMPARED` a row has: that of another version may lack some."""
    return [name for name in COMPARED if name in row]


def differences(row: Mapping[str, Any], again: Mapping[str, Any]) -> list[str]:
    """
    Return in words what of a run that was made again is not what its row says.

    Its seed and every metric, criterion and word of the verdict count: of a serial row to the
    last bit.
    """
    rtol = 0.0 if row[PATH] == SERIAL else VECTORISED_RTOL
    return [
        f'{name} is {again[name]!r}, in the row {row[name]!r}'
        for name in compared_in(row)
        if not _same(row[name], again[name], rtol)
    ]


def _same(ours: Any, theirs: Any, rtol: float) -> bool:
    if isinstance(ours, float) and isinstance(theirs, (int, float)):
        return math.isclose(ours, theirs, rel_tol=rtol)
    return ours == theirs


def _cell(value: Any) -> Any:
    """Return a value as a cell holds it: a list, or a group of keys, as text."""
    return json.dumps(value) if isinstance(value, (list, tuple, Mapping)) else value


def _type(spec: CampaignSpec, key: str) -> pa.DataType:
    values = spec.values_of(key)
    if any(isinstance(value, (str, list, tuple, Mapping)) for value in values):
        return pa.string()
    if values and all(isinstance(value, bool) for value in values):
        return pa.bool_()
    whole = key in spec.vary and spec.vary[key].whole
    if whole or (values and all(isinstance(value, int) for value in values)):
        return pa.int64()
    return pa.float64()
