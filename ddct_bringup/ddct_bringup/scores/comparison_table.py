# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The table that `compare` prints: scores, for the thesis's conditions beside its Table 5.1."""

from collections.abc import Sequence
from dataclasses import replace
from typing import TextIO

from ddct_bringup.metrics.catalogue import TABLE_5_1
from ddct_bringup.scores.run_table import (
    ACCELERATION_STD,
    CONTROLLER,
    FIGURE_COLUMNS,
    FINAL_SLIP,
    STATE,
    T_A,
    TORSION_STD,
    RunColumn,
    figure_columns,
    print_runs,
)
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.scores.shift_conditions import shift_conditions
from ddct_bringup.thesis.table_5_1 import (
    PREDICTED,
    PREDICTION_TOLERANCE,
    is_thesis_run,
    thesis_row,
)
from ddct_plant.program.table import Quantity, TextColumn, Weight
from ddct_plant.scenario.differences import changed_values, scenario_title
from ddct_plant.scenario.settings import RunSettings

_NOTE = (
    'thesis: Table 5.1. The scenario was fitted to its calibrated rows; a predicted one took no '
    f'part in the fit, and is a hit within {100 * PREDICTION_TOLERANCE:.0f} % in all three values.'
)
_NO_ROW = 'Table 5.1 has no row of this controller'
_BESIDE = ('peak_jerk_m_s3', 'peak_jerk_over_least', 'weighted_acceleration_m_s2')
"""Figures beside the table of the thesis where there is room."""


def print_comparison(
    runs: Sequence[ScoredRun], settings: RunSettings, overrides: Sequence[str], stream: TextIO
) -> None:
    """
    Print one row per run.

    The values of the thesis are shown only for the conditions of the thesis.
    """
    title = _title(settings, overrides)
    if not is_thesis_run(settings):
        print_runs(runs, (CONTROLLER, *figure_columns(runs)), stream, title)
        return
    ours = zip((T_A, TORSION_STD, ACCELERATION_STD), TABLE_5_1, strict=True)
    beside = [_of_less_weight(FIGURE_COLUMNS[key]) for key in _BESIDE]
    columns = (
        CONTROLLER,
        *(each for column, quantity in ours for each in (column, _thesis(quantity))),
        TextColumn(
            'row', '', _use, number=False, undefined=lambda run: _NO_ROW, weight=Weight.USEFUL
        ),
        FINAL_SLIP,
        *beside,
        STATE,
    )
    has_row = any(thesis_row(run.controller or '') for run in runs)
    notes = [_NOTE] if has_row else []
    print_runs(runs, columns, stream, title, [*notes, *_least_notes(runs)])


def _least_notes(runs: Sequence[ScoredRun]) -> list[str]:
    """Return the note on the least beside each ratio, which the table has no room for."""
    least = [(run.bag, run.least_peak_jerk) for run in runs]
    shown = ', '.join(f'{name} {value:.2g}' for name, value in least if value is not None)
    return [f'least jerk in m/s^3, which falls with the lock time: {shown}'] if shown else []


def _of_less_weight(column: RunColumn) -> RunColumn:
    return replace(column, weight=Weight.DETAIL)


def _title(settings: RunSettings, overrides: Sequence[str]) -> str:
    changes = changed_values(settings.scenario) or overrides
    conditions = (
        settings.known.architecture,
        f'wear gain {settings.case.wear_gain:g}',
        *shift_conditions(settings).values(),
        settings.known.mode,
    )
    return f'{scenario_title(settings.scenario.name, changes)}; {", ".join(conditions)}'


def _thesis(quantity: Quantity) -> RunColumn:
    """Return the column of the printed value."""

    def value(run: ScoredRun) -> float | None:
        row = thesis_row(run.controller or '')
        return row.printed_values()[quantity.key] if row else None

    return TextColumn('thesis', '.2f', value, undefined=lambda run: _NO_ROW)


def _use(run: ScoredRun) -> str | None:
    """Return whether the row is calibrated, or predicted with a hit or a miss."""
    row = thesis_row(run.controller or '')
    if row is None or row.use != PREDICTED or not run.valid:
        return row.use if row else None
    words = {row.verdict(each.key, run.metrics[each.key]) for each in TABLE_5_1}
    return f'{row.use}, {"hit" if words == {"hit"} else "miss"}'
