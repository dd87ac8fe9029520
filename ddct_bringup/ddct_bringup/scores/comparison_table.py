# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The table that `compare` prints: computed scores next to Table 5.1 of the thesis."""

from collections.abc import Sequence
from dataclasses import replace
from typing import TextIO

from ddct_bringup.metrics.catalogue import TABLE_5_1
from ddct_bringup.scores.run_table import (
    ACCELERATION_STD,
    CONTROLLER,
    ENGAGEMENT_TIME,
    FINAL_SLIP,
    FURTHER_COLUMNS,
    PEAK_JERK,
    SHIFT_COLUMNS,
    TORSION_STD,
    VALID,
    RunColumn,
    print_runs,
)
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.scores.shift_conditions import shift_conditions
from ddct_bringup.thesis.predictions import predicted_range
from ddct_bringup.thesis.table_5_1 import (
    PREDICTED,
    PREDICTION_TOLERANCE,
    is_thesis_run,
    thesis_row,
)
from ddct_plant.program.printed_table import print_note
from ddct_plant.program.table import Column, Quantity
from ddct_plant.scenario.differences import changed_values, scenario_title
from ddct_plant.scenario.settings import RunSettings

_NOTE = (
    'thesis: Table 5.1. calibrated: this scenario was fitted to the row, so its agreement is a '
    'fit residual; predicted: the row took no part in the fit. Below our figure is its range '
    'over the admissible scenarios, '
    f'below the print hit (within {100 * PREDICTION_TOLERANCE:.0f} % of it) or miss.'
)
_NO_ROW = 'Table 5.1 has no row of this controller'


def print_comparison(
    runs: Sequence[ScoredRun], settings: RunSettings, overrides: Sequence[str], stream: TextIO
) -> None:
    """
    Print one row per run.

    The values of the thesis, and the ranges of the predictions, are shown only for the conditions
    of the thesis.
    """
    columns = [CONTROLLER, ENGAGEMENT_TIME, TORSION_STD, ACCELERATION_STD]
    compared = is_thesis_run(settings)
    if compared:
        columns = [
            CONTROLLER,
            *(
                column
                for ours, quantity in zip(columns[1:], TABLE_5_1, strict=True)
                for column in (_with_range(ours, quantity.key), _thesis(quantity))
            ),
            Column('thesis row', '', _use, number=False, undefined=lambda run: _NO_ROW),
        ]
    columns += [FINAL_SLIP, PEAK_JERK, *FURTHER_COLUMNS, VALID]
    if settings.shift:
        columns = [CONTROLLER, *SHIFT_COLUMNS]
    print_runs(runs, columns, stream, _title(settings, overrides))
    if compared and any(thesis_row(run.controller or '') for run in runs):
        print_note(_NOTE, stream)


def _title(settings: RunSettings, overrides: Sequence[str]) -> str:
    changes = changed_values(settings.scenario) or overrides
    conditions = (
        settings.architecture,
        f'{settings.clutch} clutch',
        f'wear gain {settings.wear_gain:g}',
        *shift_conditions(settings).values(),
        settings.mode,
    )
    return f'{scenario_title(settings.scenario.name, changes)}; {", ".join(conditions)}'


def _with_range(column: RunColumn, name: str) -> RunColumn:
    """Return the column of a metric with the predicted range in a second line."""
    return replace(column, below=lambda run: predicted_range(run.controller or '', name))


def _thesis(quantity: Quantity) -> RunColumn:
    """Return the column of the printed value, with hit or miss below where it is predicted."""

    def value(run: ScoredRun) -> float | None:
        row = thesis_row(run.controller or '')
        return row.printed_values()[quantity.key] if row else None

    def below(run: ScoredRun) -> str:
        row = thesis_row(run.controller or '')
        if row is None or row.use != PREDICTED or not run.valid:
            return ''
        return row.verdict(quantity.key, run.metrics[quantity.key])

    return Column(
        f'thesis\n{quantity.unit}', '.2f', value, below=below, undefined=lambda run: _NO_ROW
    )


def _use(run: ScoredRun) -> str | None:
    row = thesis_row(run.controller or '')
    return row.use if row else None
