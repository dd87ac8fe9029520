"""Tables of scored runs for the terminal; plain text where the output is no terminal."""

from collections.abc import Sequence
from typing import TextIO

from rich.console import Console
from rich.text import Text

from ddct_bringup.scores.scoring import NOT_COMPUTED, Entry
from ddct_bringup.verdict.metric_figures import METRICS, NO_TIMING, TABLE_5_1
from ddct_bringup.verdict.state import SUCCESSES
from ddct_bringup.verdict.verdict import BEYOND, NO_LIMIT, TRACTION
from ddct_plant.base.errors import printable
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.program.table import UNDEFINED, Column, Quantity, drawn_by_rich, table_of
from ddct_plant.scenario.differences import scenario_title

_PIPED_WIDTH = 200
"""Columns of a table that goes to a file or pipe, where nothing needs to fit a screen."""


RunColumn = Column[Entry]
"""One column of a table of runs."""


def fact(name: str, heading: str, form: str = '', *, number: bool = False) -> RunColumn:
    """Return the column of a run's fact, such as its controller."""
    return Column(heading, form, lambda run: run[name], number=number)


def metric(figure: Quantity, heading: str = '') -> RunColumn:
    """Return the column of a metric, under its symbol and unit where there is no heading."""
    return Column(
        heading or f'{figure.symbol}\n{figure.unit}',
        figure.form,
        lambda run: run['metrics'][figure.key],
        undefined=figure.undefined,
    )


BAG = fact('bag', 'bag')
CONTROLLER = fact('controller', 'controller')
WEAR = fact('wear_gain', 'wear', 'g', number=True)
ENGAGEMENT_TIME, TORSION_STD, ACCELERATION_STD = (metric(each) for each in TABLE_5_1)
FINAL_SLIP = metric(METRICS['slip_final_rpm'], 'final\nw_d rpm')
PEAK_JERK = metric(METRICS['peak_jerk_m_s3'], 'jerk\nm/s^3')
VALID: RunColumn = Column('valid', '', lambda run: 'yes' if run['valid'] else 'NO', number=False)

COLUMNS = (
    ENGAGEMENT_TIME,
    TORSION_STD,
    ACCELERATION_STD,
    FINAL_SLIP,
    metric(METRICS['slip_rmse_rpm'], 'slip\nRMSE rpm'),
    PEAK_JERK,
    VALID,
)
"""What every table of runs shows, after the columns that tell the runs apart."""

STATE: RunColumn = Column('state', '', lambda run: run['verdict']['state'], number=False)
VERDICT_COLUMNS: tuple[RunColumn, ...] = (
    STATE,
    Column('limits', '', lambda run: run['verdict']['limits'], number=False),
)
"""Before the last column where the terminal is wide enough; otherwise in lines below."""
REALTIME_COLUMNS: tuple[RunColumn, ...] = (
    metric(METRICS['missed_steps'], 'missed\nsteps'),
    Column(
        'latest\nms',
        '.2f',
        lambda run: _in_ms(run['metrics']['worst_lateness_us']),
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
"""What a table also shows when one of its runs was in real time."""


def table_console(stream: TextIO) -> Console:
    """Return where tables of runs are printed: as wide as the terminal, or as any of them."""
    width = None if stream.isatty() else _PIPED_WIDTH
    return Console(file=stream, width=width, highlight=False)


def print_runs(
    runs: Sequence[Entry], columns: Sequence[RunColumn], stream: TextIO, title: str | None = None
) -> None:
    """
    Print one row per run, its verdict included, then what needs a word.

    That are dashes, runs that do not count, and criteria beyond their limits. Without a title it
    is the scenario, with what is changed in it; of several scenarios each run has its own below.
    """
    scenarios = {_scenario(run) for run in runs if run['scenario'] is not None}
    if title is None and len(scenarios) == 1:
        (title,) = scenarios
    if any(run['mode'] == 'realtime' for run in runs):
        columns = [*columns[:-1], *REALTIME_COLUMNS, columns[-1]]
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
        scenario = [_scenario(run)] if title is None and run['scenario'] is not None else []
        for text in [*scenario, *verdict, *run_notes(run)]:
            console.print(Text(printable(f'{run["bag"]}: {text}'), 'bold'), soft_wrap=True)
    for text in beyond_notes(runs):
        console.print(Text(printable(text), 'bold'), soft_wrap=True)


def _verdict_text(run: Entry) -> str:
    return ', '.join(f'{each.heading} {each.text(run)}' for each in VERDICT_COLUMNS)


def dash_notes(runs: Sequence[Entry], columns: Sequence[RunColumn]) -> list[str]:
    """Return for each column in which a run that can be read has a dash, what it means there."""
    read = [run for run in runs if run['metrics']['steps'] is not None]
    return [
        f"{column.heading.splitlines()[0]} '-': {column.undefined}."
        for column in columns
        if column.undefined and any(column.text(run) == UNDEFINED for run in read)
    ]


def run_notes(run: Entry) -> list[str]:
    """Return what to know of one run: why it does not count, or what its figures do not show."""
    notes = [] if run['valid'] else [f'not valid: {run["reason"]}']
    if run['valid'] and run['fallbacks']:
        notes.append(fallback_note(run))
    notes += [*slow_notes(run), *unknown_limits_notes(run)]
    figures: dict[str, list[str]] = {}
    for name, why in run.get(NOT_COMPUTED, {}).items():
        figures.setdefault(why, []).append(name)
    notes += [f'{why}: no {", ".join(names)}' for why, names in figures.items()]
    if run['before_schema']:
        notes.append('recorded before scenarios had a schema_version: judged by what it holds')
    return notes


def beyond_notes(runs: Sequence[Entry]) -> list[str]:
    """Return for each limit that runs are beyond its source, and the runs with their values."""
    beyond: dict[str, list[str]] = {}
    for run in runs:
        traction = {'name': TRACTION, **(run['verdict']['traction'] or {'state': NO_LIMIT})}
        for each in (*run['verdict']['criteria'], traction):
            if each['state'] == BEYOND:
                limit = f'beyond {each["name"]} {each["limit"]:g} {each["unit"]}'
                found = beyond.setdefault(f'{limit} ({each["source"]})', [])
                found.append(f'{run["bag"]} {each["value"]:.4g}')
    return [f'{limit}: {", ".join(found)}' for limit, found in beyond.items()]


def unknown_limits_notes(run: Entry) -> list[str]:
    """Return by which limits a success, beyond none, cannot be judged for want of a value."""
    verdict = run['verdict']
    unknown = [
        each['name']
        for each in verdict['criteria']
        if each['limit'] is not None and each['value'] is None
    ]
    if not unknown or verdict['state'] not in SUCCESSES or verdict['limits'] != NO_LIMIT:
        return []
    return [f'not known to keep within its limits: no value of {", ".join(unknown)}']


def slow_notes(run: Entry) -> list[str]:
    """Return that a controller's updates outlast their period, if more than 1 % of them do."""
    median, most = (_in_ms(run['metrics'][f'update_time_{name}_us']) for name in ('median', 'p99'))
    if median is None or most is None or most <= 1e3 * PERIOD_S:
        return []
    return [
        f'too slow for real time: its updates take {median:.1f} ms in the median, 1 % of them '
        f'more than {most:.1f} ms; the period is {1e3 * PERIOD_S:g} ms'
    ]


def fallback_note(run: Entry) -> str:
    """Return what to know of a run whose controller had to do without a solution."""
    return (
        f'at {run["fallbacks"]} of {run["metrics"]["steps"]} steps its program had no solution in '
        'time: the figures are partly those of its fallback'
    )


def _scenario(run: Entry) -> str:
    return scenario_title(run['scenario'], run['scenario_changes'] or ())


def _safe_state(run: Entry) -> str | None:
    return None if run['safe_state'] is None else run['safe_state'] or 'none'


def _in_ms(time_us: float | None) -> float | None:
    return None if time_us is None else time_us / 1e3
