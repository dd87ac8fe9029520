# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of a tuning: the rows of all runs, those of a batch, and all trials."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import pyarrow as pa
import pyarrow.compute as compute

from ddct_bringup.campaign.arrow_columns import arrow_column, read_parquet
from ddct_bringup.campaign.columns import parquet_bytes, schema_of
from ddct_bringup.campaign.conduct import RESUME, SHARDS
from ddct_bringup.campaign.spec import CampaignSpec
from ddct_bringup.tuning.specification.spec import TuningSpec
from ddct_bringup.tuning.study import ANEW
from ddct_bringup.tuning.trial import Trial
from ddct_plant.base.errors import DdctError
from ddct_plant.files.output_file import write_bytes

NUMBER, TRIAL = 'number', 'trial'
"""Column of the number of a trial among the trials, and before the columns of its runs."""
RUNS, TRIALS = 'runs.parquet', 'trials.parquet'
"""Files with the rows of all runs, and with a row for each trial."""


def all_runs(trials: Sequence[Trial], campaign: CampaignSpec) -> pa.Table:
    """Return the rows of the runs of trials, with the number of the trial first."""
    schema = schema_of(campaign)
    named = pa.schema([(TRIAL, pa.int64()), *schema], schema.metadata)
    parts = [
        each.rows.add_column(0, TRIAL, arrow_column(pa.int64(), [each.number] * len(each.rows)))
        for each in trials
        if len(each.rows)
    ]
    return pa.concat_tables(parts).cast(named) if parts else named.empty_table()


def trials_table(trials: Sequence[Trial], spec: TuningSpec) -> pa.Table:
    """
    Return a row for each trial: its number, parameters, objectives, constraints and state.

    Objectives are those over its runs that were computed; a constraint is `constraints.NAME`.
    """
    columns: dict[str, pa.Array] = {NUMBER: _integers([each.number for each in trials])}
    for parameter in spec.parameters:
        kind = pa.int64() if parameter.whole else pa.float64()
        columns[parameter.name] = arrow_column(kind, [e.values[parameter.name] for e in trials])
    goals = {goal.name: goal for goal in spec.objectives}
    goals |= {f'constraints.{each.goal.name}': each.goal for each in spec.constraints}
    for name, goal in goals.items():
        values = [each.estimate(goal, spec) for each in trials]
        columns[name] = arrow_column(pa.float64(), values)
    columns['state'] = arrow_column(pa.string(), [each.state for each in trials])
    columns['reason'] = arrow_column(pa.string(), [each.reason for each in trials])
    columns['runs'] = _integers([len(each.rows) for each in trials])
    return pa.table(columns)


def write_tables(
    out: Path, trials: Sequence[Trial], spec: TuningSpec, campaign: CampaignSpec
) -> None:
    """Write both tables of a tuning; raise DdctError when that fails."""
    write_bytes(str(out / RUNS), parquet_bytes(all_runs(trials, campaign)))
    write_bytes(str(out / TRIALS), parquet_bytes(trials_table(trials, spec)))


def batch_file(out: Path, batch: int) -> Path:
    """Return the path of the rows of a batch."""
    return out / SHARDS / f'{batch:06d}.parquet'


def write_batch(out: Path, batch: int, trials: Sequence[Trial], campaign: CampaignSpec) -> None:
    """Write the rows of a batch; raise DdctError when that fails."""
    write_bytes(str(batch_file(out, batch)), parquet_bytes(all_runs(trials, campaign)), RESUME)


def rows_by_trial(path: Path) -> Mapping[int, pa.Table]:
    """Return the rows in a file of runs by their trials; raise DdctError for a damaged one."""
    try:
        table = read_parquet(path)
        numbers = table[TRIAL]
        rows = table.drop_columns([TRIAL])
        return {
            number: rows.filter(compute.equal(numbers, number))
            for number in compute.unique(numbers).to_pylist()
        }
    except (OSError, pa.ArrowException, LookupError) as error:
        raise DdctError(f'cannot be read ({error}): {ANEW}', place=path) from error


def _integers(values: Sequence[int]) -> pa.Array:
    return arrow_column(pa.int64(), values)
