# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The record of trials: their rows and entries by batch, each written completely."""

from collections.abc import Sequence
from pathlib import Path

import pyarrow as pa

from ddct_bringup.campaign.arrow_columns import read_parquet
from ddct_bringup.campaign.columns import parquet_bytes, rows_table, schema_of
from ddct_bringup.campaign.conduct import RESUME, SHARDS
from ddct_bringup.campaign.rows import Row
from ddct_bringup.campaign.spec import CampaignSpec
from ddct_bringup.tuning.specification.spec import TuningSpec
from ddct_bringup.tuning.trial import Trial, TrialEntry
from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import read_json, write_json
from ddct_plant.files.output_file import write_bytes

TRIAL = 'trial'
"""Column of the number of the trial, before those of a campaign."""
RUNS, TRIALS = 'runs.parquet', 'trials.json'
"""Files with the rows of all runs, and with the entries of all trials."""
ANEW = 'start the tuning anew'
"""What to do where the record of a tuning cannot be read."""


def run_schema(spec: CampaignSpec) -> pa.Schema:
    """Return the columns of the rows of a tuning."""
    schema = schema_of(spec)
    return pa.schema([(TRIAL, pa.int64()), *schema], schema.metadata)


def write_batch(
    out: Path, batch: int, trials: Sequence[Trial], spec: TuningSpec, campaign: CampaignSpec
) -> None:
    """Write the rows of a batch, then its entries: a batch without entries does not count."""
    rows, entries = batch_files(out, batch)
    write_bytes(str(rows), rows_bytes(trials, campaign), RESUME)
    write_json(str(entries), [each.entry(spec) for each in trials], RESUME)


def rows_bytes(trials: Sequence[Trial], campaign: CampaignSpec) -> bytes:
    """Return the rows of trials as a Parquet file, the same bytes for the same rows."""
    rows = [{**row, TRIAL: each.number} for each in trials for row in each.rows]
    return parquet_bytes(rows_table(run_schema(campaign), rows))


def batch_files(out: Path, batch: int) -> tuple[Path, Path]:
    """Return the paths of the rows and of the entries of a batch."""
    folder = out / SHARDS
    return folder / f'{batch:06d}.parquet', folder / f'{batch:06d}.json'


def read_batch(out: Path, batch: int) -> list[Trial] | None:
    """Return the trials of a batch, None for one that is not complete; DdctError where damaged."""
    rows, entries = batch_files(out, batch)
    if not entries.exists():
        return None
    return trials_of(read_entries(entries), rows)


def read_entries(path: Path) -> list[TrialEntry]:
    """Return the entries of trials in a file; raise DdctError where it cannot be read."""
    return read_json(list[TrialEntry], path, advice=ANEW)


def trials_of(entries: Sequence[TrialEntry], rows: Path) -> list[Trial]:
    """Return trials of their entries and of the file with their rows."""
    try:
        table = read_parquet(rows).to_pylist()
        by_trial: dict[int, list[Row]] = {}
        for row in table:
            by_trial.setdefault(row.pop(TRIAL), []).append(row)
        return [_trial(entry, by_trial.get(entry.number, [])) for entry in entries]
    except (OSError, pa.ArrowException, LookupError, TypeError) as error:
        raise DdctError(f'cannot be read ({error}): {ANEW}', place=rows) from error


def _trial(entry: TrialEntry, rows: Sequence[Row]) -> Trial:
    return Trial(entry.number, entry.parameters, rows, entry.further, entry.state, entry.reason)
