# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Read the results of a campaign of this version or another, with the columns that exist."""

from pathlib import Path

import numpy as np
import pyarrow as pa

from ddct_bringup.campaign.arrow_columns import numpy_column, read_parquet
from ddct_bringup.campaign.columns import COMPARED, CONTROLLER, INDEX, PATH, SCHEMA_VERSION
from ddct_bringup.campaign.conduct import RESULTS
from ddct_bringup.campaign.keys import COMMON, option_of
from ddct_bringup.campaign.plan import RecordedCampaign
from ddct_bringup.campaign.rows import STATE
from ddct_bringup.campaign.spec import CampaignSpec
from ddct_bringup.evaluation.grouped_rows import By, GroupedRows
from ddct_bringup.evaluation.summary import OtherVersion
from ddct_bringup.manifest.file_states import require_unaltered
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.files.input_file import SCHEMA_KEY, require_schema_version
from ddct_plant.scenario.choices.scenarios import Choice
from ddct_plant.scenario.differences import values_by_key
from ddct_plant.scenario.settings import RunSettings

REQUIRED = (INDEX, CONTROLLER, 'valid', 'reason', STATE)
"""Required columns, besides those of the varied keys."""
_DIGEST_ADVICE = (
    'put the original back, or give --resume to ddct campaign, which computes the rows again'
)
_RESUME_ADVICE = 'give --resume to ddct campaign, which writes it from what is done'


def require_as_written(folder: Path) -> None:
    """
    Raise DdctError unless the rows of a campaign are as their digest.

    Flipped bits may change numbers and nothing else.
    """
    require_unaltered(folder, (RESULTS,), advice=_DIGEST_ADVICE)


def read_table(folder: Path, recorded: RecordedCampaign) -> pa.Table:
    """
    Return the rows of a finished campaign, with the columns that its file has.

    Results of a version with fewer or other metrics are read too. Raise DdctError without the
    rows, or without a required column.
    """
    path = folder / RESULTS
    require_as_written(folder)
    try:
        table = read_parquet(path, recorded.plan.runs)
        metadata = table.schema.metadata or {}
        _require_single(table)
        require_schema_version(
            {SCHEMA_KEY: int(metadata.get(SCHEMA_KEY.encode(), 0))}, SCHEMA_VERSION
        )
    except FileNotFoundError as error:
        raise DdctError(
            f'{folder}: no {RESULTS} in it, so the campaign is not finished: {_RESUME_ADVICE}'
        ) from error
    except ParameterError as error:
        raise DdctError(f'{path}: {error}') from error
    except (OSError, ValueError, pa.ArrowException) as error:
        why = next(iter(str(error).splitlines()), type(error).__name__)
        raise DdctError(f'{path}: it is damaged ({why}): {_RESUME_ADVICE}') from error
    _require_types(table, path)
    for name in (*REQUIRED, *recorded.plan.grid, *recorded.plan.random):
        if name not in table.column_names:
            raise DdctError(f'it has no column {name}: {_RESUME_ADVICE}', place=path)
    if not np.array_equal(numpy_column(table[INDEX]), np.arange(recorded.plan.runs)):
        raise DdctError(
            f'{path}: its rows are not the {recorded.plan.runs} runs that {folder} was started '
            f'with: {_RESUME_ADVICE}'
        )
    return table


def _require_types(table: pa.Table, path: Path) -> None:
    """Raise DdctError for a required column of another type."""
    for name, kind in ((CONTROLLER, 'string'), (STATE, 'string'), ('valid', 'bool')):
        if name in table.column_names and str(table.schema.field(name).type) != kind:
            raise DdctError(f'its column {name} is no {kind}: {_RESUME_ADVICE}', place=path)


def _require_single(table: pa.Table) -> None:
    """Raise ValueError for a column that is there twice."""
    for field in table.schema:
        if table.column_names.count(field.name) > 1:
            raise ValueError(f'the column {field.name} is there twice')


def grouped_rows(recorded: RecordedCampaign, table: pa.Table) -> GroupedRows:
    """Return the rows of a campaign, grouped by what its manifest says was varied."""
    plan, columns = recorded.plan, table.column_names
    expected = (*REQUIRED, PATH, *COMPARED, *plan.grid, *plan.random)
    absent = tuple(name for name in COMPARED if name not in columns)
    unknown = tuple(name for name in columns if name not in expected)
    nominal: dict[str, float] = {}
    why = ''
    try:
        nominal = nominal_values(recorded.campaign_spec())
    except DdctError as error:  # a key or a scenario of another version, or a file that is gone
        why = str(error)
    other = OtherVersion(absent, unknown, why)
    return GroupedRows(table, By(plan.grid, plan.random, nominal, other))


def nominal_values(spec: CampaignSpec) -> dict[str, float]:
    """
    Return the nominal values of the numbers that a specification varies.

    They are those of its scenario, the first of several, or the default where the scenario has
    none. Raise DdctError for a scenario that can no longer be read.
    """
    first = {key: spec.values_of(key)[0] for key in COMMON if key in spec.keys}
    common = {**spec.common, **first}
    scenario = spec.scenario_file(Choice.taken_from(common)).scenario()
    given = {**RunSettings.of(scenario, common).values, **values_by_key(scenario)}
    found: dict[str, float] = {}
    for key in spec.keys:
        option = option_of(key, key)
        value = given.get(key, option.default if option else None)
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            found[key] = float(value)
    return found
