# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of scored runs for the terminal; plain text where the output is not a terminal."""

from collections.abc import Sequence
from typing import TextIO

from rich.console import Console
from rich.text import Text

from ddct_bringup.metrics.catalogue import FURTHER, METRICS, TABLE_5_1
from ddct_bringup.metrics.metric import NO_TIMING
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.verdict.state import SUCCESSES
from ddct_bringup.verdict.verdict import BEYOND, NO_LIMIT, UNAVOIDABLE
from ddct_plant.base.errors import printable
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.program.table import UNDEFINED, Column, Quantity, drawn_by_rich, table_of
from ddct_plant.scenario.differences import scenario_title

_PIPED_WIDTH = 200
"""Width in characters of a table written to a file or pipe."""


RunColumn = Column[ScoredRun]
"""One column of a table of runs."""


def metric(quantity: Quantity, heading: str = '') -> RunColumn:
    """Return the column of a metric; the heading defaults to its symbol and unit."""
    return Column(
        heading or f'{quantity.symbol}\n{quantity.unit}',
        quantity.form,
        lambda run: run.metrics[quantity.key],
        undefined=quantity.undefined,
    )


BAG: RunColumn = Column('bag', '', lambda run: run.bag, number=False)
CONTROLLER: RunColumn = Column('controller', '', lambda run: run.controller, number=False)
WEAR: RunColumn = Column('wear', 'g', lambda run: run.facts.wear_gain if run.facts else None)
ENGAGEMENT_TIME, TORSION_STD, ACCELERATION_STD = (metric(each) for each in TABLE_5_1)
_HEADINGS = {
    'slip_final_rpm': 'final\nw_d rpm',
    'slip_rmse_rpm': 'slip\nRMSE rpm',
    'peak_jerk_m_s3': 'jerk\nm/s^3',
}
"""Headings shorter than symbol and unit, in the order of the columns."""
FINAL_SLIP, SLIP_RMSE, PEAK_JERK = (metric(METRICS[key], text) for key, text in _HEADINGS.items())
FURTHER_COLUMNS = tuple(
    metric(each) for each in FURTHER if each.column and each.key not in _HEADINGS
)
"""Columns of all other metrics that are declared to have one."""
OVER_FLOOR: RunColumn = Column(
    'jerk\n/least',
    '.2f',
    lambda run: run.over_floor.get('peak_jerk'),
    undefined='peak jerk over the least at the same lock time has no value: the run has no floor',
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
"""Columns of every table of runs, after those that identify the run."""

STATE: RunColumn = Column('state', '', lambda run: run.verdict.state, number=False)
VERDICT_COLUMNS: tuple[RunColumn, ...] = (
    STATE,
    Column('limits', '', lambda run: run.verdict.limits, number=False),
)
"""
Columns of the verdict, before the last column of a wide terminal; else in lines below the table.
"""
REALTIME_COLUMNS: tuple[RunColumn, ...] = (
    metric(METRICS['missed_steps'], 'missed\nsteps'),
    Column(
        'latest\nms',
        '.2f',
        lambda run: _in_ms(run.metrics['worst_lateness_us']),
        undefined=f'it ran in lock-step, or {NO_TIMING}',
    ),
    Column(
        'safe state',
        '',
        lambda run: _safe_state(run),
        number=False,
        undefined='it ran in lock-step',
    ),
)
"""Additional columns of a table with at least one real-time run."""


def table_console(stream: TextIO) -> Console:
    """Return the console for tables of runs: as wide as the terminal, unlimited elsewhere."""
    width = None if stream.isatty() else _PIPED_WIDTH
    return Console(file=stream, width=width, highlight=False)


def print_runs(
    runs: Sequence[ScoredRun],
    columns: Sequence[RunColumn],
    stream: TextIO,
    title: str | None = None,
) -> None:
    """
    Print one row per run with its verdict, then explanatory notes.

    The notes explain dashes, invalid runs, criteria beyond their limits, and floors. The default
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
    console = table_console(stream)
    wide = [*columns[:-1], *VERDICT_COLUMNS, columns[-1]]
    table = drawn_by_rich(table_of(title or '', wide, runs), ruled=True)
    unbounded = console.options.update(max_width=10 * _PIPED_WIDTH)
    wide_enough = console.measure(table, options=unbounded).maximum <= console.width
    if not wide_enough:
        table = drawn_by_rich(table_of(title or '', columns, runs), ruled=True)
    console.print(table)
    for text in dash_notes(runs, columns):
        console.print(Text(text), soft_wrap=True)
    for run in runs:
        verdict = [] if wide_enough else [_verdict_text(run)]
        scenario = [_scenario(run)] if title is None and run.scenario is not None else []
        for text in [*scenario, *verdict, *run_notes(run)]:
            console.print(Text(printable(f'{run.bag}: {text}'), 'bold'), soft_wrap=True)
    for text in [*beyond_notes(runs), *unavoidable_notes(runs), *no_floor_notes(runs)]:
        console.print(Text(printable(text), 'bold'), soft_wrap=True)


def _verdict_text(run: ScoredRun) -> str:
    return ', '.join(f'{each.heading} {each.text(run)}' for each in VERDICT_COLUMNS)


def dash_notes(runs: Sequence[ScoredRun], columns: Sequence[RunColumn]) -> list[str]:
    """Return a note on the meaning of the dash for each column where a readable run has one."""
    read = [run for run in runs if run.metrics['steps'] is not None]
    return [
        f"{column.heading.splitlines()[0]} '-': {column.undefined}."
        for column in columns
        if column.undefined and any(column.text(run) == UNDEFINED for run in read)
    ]


def run_notes(run: ScoredRun) -> list[str]:
    """Return notes on one run: why it is invalid, or on limitations of its scores."""
    notes = [] if run.valid else [f'not valid: {run.reason}']
    if run.valid and run.fallbacks:
        notes.append(fallback_note(run))
    notes += [*slow_notes(run), *unknown_limits_notes(run)]
    figures: dict[str, list[str]] = {}
    for name, why in run.not_computed.items():
        figures.setdefault(why, []).append(name)
    notes += [f'{why}: no {", ".join(names)}' for why, names in figures.items()]
    if run.before_schema:
        notes.append('recorded before scenarios had a schema_version: judged by what it holds')
    return notes


def beyond_notes(runs: Sequence[ScoredRun]) -> list[str]:
    """
    Return for each exceeded limit its source, and the runs that exceed it with their values.

    Beside a value is the least that a run with the same lock time can have, where it is known.
    """
    beyond: dict[str, list[str]] = {}
    for run in runs:
        for each in run.verdict.results:
            if each.state == BEYOND:
                limit = f'beyond {each.name} {each.limit:g} {each.unit}'
                found = beyond.setdefault(f'{limit} ({each.source})', [])
                least = '' if not each.least else f' (at its lock time at least {each.least:.3g})'
                found.append(f'{run.bag} {each.value:.4g}{least}')
    return [f'{limit}: {", ".join(found)}' for limit, found in beyond.items()]


def unavoidable_notes(runs: Sequence[ScoredRun]) -> list[str]:
    """Return for each limit that no controller can keep its source, and the runs' values."""
    found: dict[str, list[str]] = {}
    for run in runs:
        for each in run.verdict.results:
            if each.state == UNAVOIDABLE:
                limit = (
                    f'unavoidable {each.name} {each.limit:g} {each.unit} ({each.source}): no '
                    f'controller of the clutch can have less than {each.least_at_any_lock:.4g}'
                )
                found.setdefault(limit, []).append(f'{run.bag} {each.value:.4g}')
    return [f'{limit}: {", ".join(values)}' for limit, values in found.items()]


def no_floor_notes(runs: Sequence[ScoredRun]) -> list[str]:
    """Return each reason why runs have no floors, with these runs."""
    found: dict[str, list[str]] = {}
    for run in runs:
        if run.no_floor:
            found.setdefault(run.no_floor, []).append(run.bag)
    return [f'no floor, as {reason}: {", ".join(names)}' for reason, names in found.items()]


def unknown_limits_notes(run: ScoredRun) -> list[str]:
    """Return the limits of a successful run that cannot be checked because a value is missing."""
    verdict = run.verdict
    unknown = [
        each.name for each in verdict.criteria if each.limit is not None and each.value is None
    ]
    if not unknown or verdict.state not in SUCCESSES or verdict.limits != NO_LIMIT:
        return []
    return [f'not known to keep within its limits: no value of {", ".join(unknown)}']


def slow_notes(run: ScoredRun) -> list[str]:
    """Return a note if more than 1 % of a controller's updates are longer than the period."""
    median, most = (_in_ms(run.metrics[f'update_time_{name}_us']) for name in ('median', 'p99'))
    if median is None or most is None or most <= 1e3 * PERIOD_S:
        return []
    return [
        f'too slow for real time: its updates take {median:.1f} ms in the median, 1 % of them '
        f'more than {most:.1f} ms; the period is {1e3 * PERIOD_S:g} ms'
    ]


def fallback_note(run: ScoredRun) -> str:
    """Return a note on a run whose controller had steps without a solution of its program."""
    return (
        f'at {run.fallbacks} of {run.metrics["steps"]} steps its program had no solution in '
        'time: the figures are partly those of its fallback'
    )


def _scenario(run: ScoredRun) -> str:
    return scenario_title(run.scenario or '', run.scenario_changes or ())


def _safe_state(run: ScoredRun) -> str | None:
    return None if run.safe_state is None else run.safe_state or 'none'


def _in_ms(time_us: float | None) -> float | None:
    return None if time_us is None else time_us / 1e3
