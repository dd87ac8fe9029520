# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of scored runs for the terminal; plain text where the output is not a terminal."""

from collections.abc import Sequence
from dataclasses import replace
from typing import TextIO

from ddct_bringup.bag.run_facts import RunFacts
from ddct_bringup.metrics.catalogue import METRICS, OF_EVERY_RUN, OF_SHIFT, TABLE_5_1
from ddct_bringup.metrics.metric import NO_TIMING
from ddct_bringup.scores.run_notes import (
    beyond_notes,
    in_ms,
    no_floor_notes,
    run_notes,
    unavoidable_notes,
)
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_plant.program.printed_table import print_note, print_table
from ddct_plant.program.table import Column, Quantity, Weight, table_of
from ddct_plant.scenario.differences import scenario_title

RunColumn = Column[ScoredRun]
"""One column of a table of runs."""


def metric(quantity: Quantity, heading: str = '') -> RunColumn:
    """Return the column of a metric; the heading defaults to its symbol and unit."""
    return Column(
        heading or f'{quantity.symbol}\n{quantity.unit}',
        quantity.form,
        lambda run: run.metrics[quantity.key],
        undefined=lambda run: quantity.undefined,
    )


BAG: RunColumn = Column('bag', '', lambda run: run.bag, number=False, weight=Weight.IDENTIFYING)
CONTROLLER: RunColumn = Column(
    'controller', '', lambda run: run.controller, number=False, weight=Weight.IDENTIFYING
)
WEAR: RunColumn = Column('wear', 'g', lambda run: run.facts.wear_gain if run.facts else None)
SHIFT_CONDITIONS: tuple[RunColumn, ...] = (
    Column(
        'off-going\nwear',
        'g',
        lambda run: run.facts.off_going_wear_gain if isinstance(run.facts, RunFacts) else None,
        undefined=lambda run: 'the run is no gear shift',
    ),
    Column(
        'handover',
        '',
        lambda run: run.facts.handover if isinstance(run.facts, RunFacts) else None,
        number=False,
        undefined=lambda run: 'the run is no gear shift',
    ),
)
"""Columns of the conditions that only a gear shift has."""
ENGAGEMENT_TIME, TORSION_STD, ACCELERATION_STD = (metric(each) for each in TABLE_5_1)
_HEADINGS = {
    'slip_final_rpm': 'final\nw_d rpm',
    'slip_rmse_rpm': 'slip\nRMSE rpm',
    'peak_jerk_m_s3': 'jerk\nm/s^3',
}
"""Headings shorter than symbol and unit, in the order of the columns."""
FINAL_SLIP, SLIP_RMSE, PEAK_JERK = (metric(METRICS[key], text) for key, text in _HEADINGS.items())
FURTHER_COLUMNS = tuple(
    metric(each) for each in OF_EVERY_RUN if each.column and each.key not in _HEADINGS
)
"""Columns of all other metrics that are declared to have one."""
OVER_FLOOR: RunColumn = Column(
    'jerk\n/least',
    '.2f',
    lambda run: run.over_floor.get('peak_jerk'),
    undefined=lambda run: 'the run has no floor',
)
"""Column of tables in which a run has its peak jerk over the least that any could have."""
VALID: RunColumn = Column('valid', '', lambda run: 'yes' if run.valid else 'NO', number=False)

COLUMNS = (
    ENGAGEMENT_TIME,
    TORSION_STD,
    ACCELERATION_STD,
    FINAL_SLIP,
    SLIP_RMSE,
    PEAK_JERK,
    *FURTHER_COLUMNS,
    VALID,
)
"""Columns of a table of runs, after those that identify the run."""
_SHIFT_HEADINGS = {
    'shift_time_s': 'shift\ns',
    'torque_phase_s': 'torque\nphase s',
    'inertia_phase_s': 'inertia\nphase s',
    'torque_dip_percent': 'dip\n%',
    'flare_rad_s': 'flare\nrad/s',
    'tie_up_work_j': 'tie-up\nJ',
    'friction_energy_j': 'work\nJ',
    'off_going_friction_energy_j': 'off\nJ',
}
"""Headings of gear shifts that are shorter than symbol and unit, in the order of the columns."""
SHIFT_COLUMNS = (
    *(metric(METRICS[key], text) for key, text in _SHIFT_HEADINGS.items()),
    *(metric(each) for each in OF_SHIFT if each.column and each.key not in _SHIFT_HEADINGS),
    PEAK_JERK,
    VALID,
)
"""Columns of a table of gear shifts, after those that identify the run."""

STATE: RunColumn = Column('state', '', lambda run: run.verdict.state, number=False)
VERDICT_COLUMNS: tuple[RunColumn, ...] = (
    STATE,
    Column('limits', '', lambda run: run.verdict.limits, number=False, weight=Weight.USEFUL),
)
"""
Columns of the verdict, before the last column.
"""
REALTIME_COLUMNS: tuple[RunColumn, ...] = (
    metric(METRICS['missed_steps'], 'missed\nsteps'),
    Column(
        'latest\nms',
        '.2f',
        lambda run: in_ms(run.metrics['worst_lateness_us']),
        undefined=lambda run: f'it ran in lock-step, or {NO_TIMING}',
    ),
    Column(
        'safe state',
        '',
        lambda run: _safe_state(run),
        number=False,
        undefined=lambda run: 'it ran in lock-step',
    ),
)
"""Additional columns of a table with at least one real-time run."""


def identifying_columns(runs: Sequence[ScoredRun]) -> tuple[RunColumn, ...]:
    """Return the columns that identify each of these runs."""
    shifts = any(isinstance(run.facts, RunFacts) and run.facts.of_shift for run in runs)
    return (BAG, CONTROLLER, WEAR, *(SHIFT_CONDITIONS if shifts else ()))


def columns_of(runs: Sequence[ScoredRun]) -> tuple[RunColumn, ...]:
    """Return the columns of a table of these runs, after those that identify the run."""
    shifts = [run.is_shift for run in runs if run.valid]
    if not any(shifts):
        return COLUMNS
    return SHIFT_COLUMNS if all(shifts) else tuple(dict.fromkeys((*COLUMNS[:-1], *SHIFT_COLUMNS)))


def print_runs(
    runs: Sequence[ScoredRun],
    columns: Sequence[RunColumn],
    stream: TextIO,
    title: str | None = None,
) -> None:
    """
    Print one row per run with its verdict, then explanatory notes.

    The notes explain invalid runs, criteria beyond their limits, and floors. The default
    title is the scenario with its changes; where the runs have several scenarios each row has its
    own below it.
    """
    scenarios = {_scenario(run) for run in runs if run.scenario is not None}
    if title is None and len(scenarios) == 1:
        (title,) = scenarios
    if any(run.facts and run.facts.mode == 'realtime' for run in runs):
        columns = [*columns[:-1], *REALTIME_COLUMNS, columns[-1]]
    if PEAK_JERK in columns and any('peak_jerk' in run.over_floor for run in runs):
        place = list(columns).index(PEAK_JERK) + 1
        columns = [*columns[:place], OVER_FLOOR, *columns[place:]]
    shown = [_with_reason(each) for each in (*columns[:-1], *VERDICT_COLUMNS, columns[-1])]
    print_table(table_of(title or '', shown, runs, complete='--json FILE'), stream)
    for run in runs:
        scenario = [_scenario(run)] if title is None and run.scenario is not None else []
        for text in [*scenario, *run_notes(run)]:
            print_note(f'{run.bag}: {text}', stream)
    for text in [*beyond_notes(runs), *unavoidable_notes(runs), *no_floor_notes(runs)]:
        print_note(text, stream)


def _with_reason(column: RunColumn) -> RunColumn:
    """Return a column whose dashes have the reason of an invalid run, where that is the cause."""
    return replace(
        column,
        undefined=lambda run: column.undefined(run) if run.valid else f'not valid: {run.reason}',
    )


def _scenario(run: ScoredRun) -> str:
    return scenario_title(run.scenario or '', run.scenario_changes or ())


def _safe_state(run: ScoredRun) -> str | None:
    return None if run.safe_state is None else run.safe_state or 'none'
