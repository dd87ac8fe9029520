# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The printed values of the thesis beside ours, as pandas DataFrames."""

from collections.abc import Iterable
from dataclasses import asdict
from typing import Any, NamedTuple

from ddct_bringup.api.result import Run, as_runs
from ddct_bringup.reproduction.numbers.command import SOURCES, compute, require_all
from ddct_bringup.reproduction.numbers.gate import OUTCOMES, judge
from ddct_bringup.reproduction.numbers.gate_tables import count_facts
from ddct_bringup.reproduction.numbers.number_files import thesis_numbers as listed_numbers
from ddct_bringup.reproduction.studies.table_5_2 import SCENARIOS, rated_rows
from ddct_bringup.reproduction.values.orders import WORN
from ddct_bringup.thesis.table_5_1 import PREDICTED, is_thesis_run, thesis_row
from ddct_bringup.thesis.table_metrics import TABLE_METRICS
from ddct_plant.base.options import require_known
from ddct_plant.files.json_records import to_json

THESIS = 'thesis.'
"""Prefix of the column of a printed value."""
HIT = 'hit.'
"""Prefix of the column that says whether a prediction is near the print."""


class ThesisNumbers(NamedTuple):
    """Every number that the thesis prints beside ours, and the counts of the outcomes."""

    table: Any
    """
    pandas DataFrame with a row per printed number, in the order of the sections.

    Columns: `section`, `item`, `printed`, `computed`, `unit`, `tolerance`, `verdict`, `hit`,
    `group`, `reason` as in `ddct thesis numbers --json`, and `outcome`.
    """
    facts: Any
    """pandas DataFrame by outcome: the number of `entries`, and of distinct `facts` in them."""


def thesis_numbers() -> ThesisNumbers:
    """
    Compute every printed number of the thesis and compare it with the print, in seconds.

    The outcomes are those of docs/thesis/reproducing.md. Raise DdctError when a claim of that
    page does not hold.
    """
    import pandas

    rows = judge(listed_numbers(), compute(SOURCES))
    require_all(rows)
    table = pandas.DataFrame([{**to_json(row.entry), 'outcome': row.outcome} for row in rows])
    counts = {
        'entries': table['outcome'].value_counts(),
        'facts': pandas.Series(dict(count_facts(rows))),
    }
    facts = pandas.DataFrame(counts, index=list(OUTCOMES)).fillna(0).astype(int)
    return ThesisNumbers(table, facts.rename_axis('outcome'))


def beside_thesis(runs: Run | Iterable[Run]) -> Any:
    """
    Return a pandas DataFrame with a row per run: the values of Table 5.1, computed and printed.

    Columns by metric: the metric itself, `thesis.METRIC` as printed, and for a predicted row
    `hit.METRIC`, whether it is within the tolerance. `use` is `calibrated` or `predicted`. All but
    the metrics are None for a run without a row in the table, or of other conditions than the
    thesis's.
    """
    import pandas

    shown = as_runs(runs)
    names = pandas.Index([each.controller for each in shown], name='controller')
    return pandas.DataFrame([_row(each) for each in shown], index=names)


def table_5_2(scenario: str = 'thesis') -> Any:
    """
    Run Table 5.2 of the thesis in a scenario, `thesis` or `thesis_sticking`, as a DataFrame.

    A row per wear gain and controller has the values, the state, our ratings, the printed ones,
    and whether our runs confirm these. Raise ParameterError for another scenario.
    """
    import pandas

    require_known([scenario], SCENARIOS, 'scenario')
    rows = [asdict(row) for gain in WORN for row in rated_rows(scenario, gain)]
    return pandas.DataFrame(rows).set_index(['wear_gain', 'controller'])


def _row(run: Run) -> dict[str, object]:
    """Return the columns of one run."""
    settings = run.recording.settings
    compared = settings is not None and is_thesis_run(settings)
    printed = thesis_row(run.controller) if compared else None
    columns: dict[str, object] = {'use': printed.use if printed else None}
    for name in TABLE_METRICS:
        value = run.metrics[name]
        columns[name] = value
        columns[f'{THESIS}{name}'] = printed.printed_values()[name] if printed else None
        predicted = printed is not None and printed.use == PREDICTED
        columns[f'{HIT}{name}'] = printed.hit(name, value) if printed and predicted else None
    return columns
