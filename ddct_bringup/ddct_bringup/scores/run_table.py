# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of scored runs for the terminal; plain text where the output is not a terminal."""

from collections.abc import Sequence
from dataclasses import replace
from typing import TextIO

from ddct_bringup.bag.run_facts import RunFacts
from ddct_bringup.metrics.catalogue import JERK_OVER_LEAST, METRICS, TABLE_5_1
from ddct_bringup.metrics.metric import Metric
from ddct_bringup.scores.engine_cut import cut_note
from ddct_bringup.scores.run_notes import in_ms, run_notes
from ddct_bringup.scores.scored_run import YARDSTICK, ScoredRun
from ddct_plant.program.printed_table import print_table
from ddct_plant.program.table import TextColumn, Weight, table_of
from ddct_plant.scenario.differences import scenario_title

RunColumn = TextColumn[ScoredRun]
"""One column of a table of runs."""


def metric(
    quantity: Metric,
    heading: str = '',
    form: str = '',
    *,
    weight: Weight = Weight.NEEDED,
    factor: float = 1.0,
) -> RunColumn:
    """
    Return the column of a metric times a factor.

    The heading defaults to its symbol and unit, the format to its own.
    """

    def value(run: ScoredRun) -> float | None:
        found = run.metrics[quantity.key]
        # The format of a count takes no float.
        return found if found is None or factor == 1.0 else factor * found

    return TextColumn(
        heading or f'{quantity.symbol}\n{quantity.unit}',
        form or quantity.form,
        value,
        undefined=lambda run: _why_null(quantity.key, run),
        remark=lambda run: _remark(quantity, run),
        weight=weight,
    )


def _why_null(key: str, run: ScoredRun) -> str:
    """Return the reason of a dash; a run that is not valid has a warning instead."""
    return run.null_reasons.get(key, '') if run.valid else ''


def _remark(quantity: Metric, run: ScoredRun) -> str:
    """Return why the least beside a ratio is no bound for the run, empty without such a ratio."""
    if quantity is not JERK_OVER_LEAST or not run.outside:
        return ''
    return f'{run.outside}: {YARDSTICK}'


BAG: RunColumn = TextColumn(
    'bag', '', lambda run: run.bag, number=False, weight=Weight.IDENTIFYING
)
CONTROLLER: RunColumn = TextColumn(
    'controller', '', lambda run: run.controller, number=False, weight=Weight.IDENTIFYING
)
_WEAR: RunColumn = TextColumn(
    'wear', 'g', lambda run: run.facts.wear_gain if run.facts else None, weight=Weight.USEFUL
)
_SHIFT_CONDITIONS: tuple[RunColumn, ...] = (
    TextColumn(
        'off-going\nwear',
        'g',
        lambda run: run.facts.off_going_wear_gain if isinstance(run.facts, RunFacts) else None,
        weight=Weight.DETAIL,
    ),
    TextColumn(
        'handover',
        '',
        lambda run: run.facts.handover if isinstance(run.facts, RunFacts) else None,
        number=False,
        weight=Weight.DETAIL,
    ),
)
"""Columns of the conditions that only a gear shift has."""
STATE: RunColumn = TextColumn('state', '', lambda run: run.state, number=False)
T_A, TORSION_STD, ACCELERATION_STD = (
    metric(each, f'{each.symbol} {each.unit}\nours') for each in TABLE_5_1
)
FINAL_SLIP = metric(METRICS['slip_final_rpm'], 'final\nw_d rpm', '.1f')
_HEADINGS: dict[str, tuple[str, str, Weight, float]] = {
    'time_to_final_lock_s': ('lock\ns', '.2f', Weight.NEEDED, 1.0),
    'torque_late_s': ('late\ns', '.2f', Weight.NEEDED, 1.0),
    'peak_jerk_m_s3': ('jerk\nm/s^3', '.1f', Weight.NEEDED, 1.0),
    'peak_jerk_over_least': ('jerk\n/least', '.1f', Weight.NEEDED, 1.0),
    'friction_work_j': ('work\nkJ', '.1f', Weight.NEEDED, 1e-3),
    'weighted_acceleration_m_s2': ('A_w\nm/s^2', '.2f', Weight.NEEDED, 1.0),
    'releases': ('re-\nleases', '.0f', Weight.NEEDED, 1.0),
    'torque_dip_percent': ('dip\n%', '.0f', Weight.USEFUL, 1.0),
    'flare_rad_s': ('flare\nrad/s', '.1f', Weight.DETAIL, 1.0),
    'tie_up_work_j': ('tie-up\nJ', '.0f', Weight.DETAIL, 1.0),
}
"""Heading, format, weight and factor of the columns of figures."""
FIGURE_COLUMNS = {
    key: metric(METRICS[key], heading, form, weight=weight, factor=factor)
    for key, (heading, form, weight, factor) in _HEADINGS.items()
}
_LEAST: RunColumn = TextColumn(
    'least\nm/s^3',
    '.1f',
    lambda run: run.least_peak_jerk,
    undefined=lambda run: _why_null(JERK_OVER_LEAST.key, run),
    weight=Weight.DETAIL,
)
"""Least peak jerk, which falls with the lock time of the run."""
_OF_LOCK = ('time_to_final_lock_s', 'releases')
"""Figures that a linear clutch never has."""
_REALTIME: tuple[RunColumn, ...] = (
    metric(METRICS['missed_steps'], 'missed\nsteps'),
    TextColumn(
        'latest\nms',
        '.2f',
        lambda run: in_ms(run.metrics['worst_lateness_us']),
        undefined=lambda run: _why_null('worst_lateness_us', run),
    ),
    TextColumn(
        'safe state',
        '',
        lambda run: None if run.safe_state is None else run.safe_state or 'none',
        number=False,
        undefined=lambda run: 'the run was in lock-step' if run.valid else '',
    ),
)
"""Columns of a table with at least one real-time run, before the state."""


def identifying_columns(runs: Sequence[ScoredRun]) -> tuple[RunColumn, ...]:
    """Return the columns that identify each of these runs."""
    shifts = any(isinstance(run.facts, RunFacts) and run.facts.of_shift for run in runs)
    return (BAG, CONTROLLER, _WEAR, *(_SHIFT_CONDITIONS if shifts else ()))


def figure_columns(runs: Sequence[ScoredRun]) -> tuple[RunColumn, ...]:
    """Return the columns of the figures that these runs can have, then the state."""
    judged = [run for run in runs if run.valid]
    sticking = any(run.metrics[key] is not None for run in judged for key in _OF_LOCK)
    if judged and not sticking:
        own: tuple[RunColumn, ...] = (T_A, TORSION_STD, ACCELERATION_STD, FINAL_SLIP)
        shown = [each for key, each in FIGURE_COLUMNS.items() if key not in _OF_LOCK]
    else:
        own, shown = (), [*FIGURE_COLUMNS.values()]
    if not any(run.is_shift for run in judged):
        of_shift = {key for key, each in METRICS.items() if each.of_shift}
        shown = [each for each in shown if each not in map(FIGURE_COLUMNS.get, of_shift)]
    shown.insert(shown.index(FIGURE_COLUMNS[JERK_OVER_LEAST.key]) + 1, _LEAST)
    return (*own, *shown, STATE)


def print_runs(
    runs: Sequence[ScoredRun],
    columns: Sequence[RunColumn],
    stream: TextIO,
    title: str | None = None,
    notes: Sequence[str] = (),
) -> None:
    """
    Print one row per run, its state last, with notes below.

    The default title is the scenario with its changes; where the runs have several scenarios each
    row has its own.
    """
    scenarios = {_scenario(run) for run in runs if run.scenario is not None}
    if title is None and len(scenarios) == 1:
        (title,) = scenarios
    if title is None:
        scenario = TextColumn('scenario', '', _scenario, number=False, weight=Weight.USEFUL)
        columns = [columns[0], scenario, *columns[1:]]
    if any(run.facts and run.facts.mode == 'realtime' for run in runs):
        columns = [*columns[:-1], *_REALTIME, columns[-1]]
    of_runs = [f'{run.bag}: {note}' for run in runs for note in run_notes(run)]
    cut = cut_note({run.bag: run.engine_cut for run in runs if run.engine_cut})
    invalid = [f'{run.bag}: not valid: {run.reason}' for run in runs if not run.valid]
    every = [*of_runs, *([cut] if cut else []), *notes]
    table = table_of(title or '', columns, runs, complete='--json FILE', notes=every)
    print_table(replace(table, warnings=invalid), stream)


def _scenario(run: ScoredRun) -> str:
    return scenario_title(run.scenario or '', run.scenario_changes or ())
