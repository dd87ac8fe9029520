# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What `sweep` shows: a row for each run, and why runs are not valid."""

from collections.abc import Sequence

from ddct_bringup.campaign.rows import ScoredRow
from ddct_bringup.documents.document import Cell, Column, Document, Note, Table
from ddct_bringup.metrics.metric import Metric
from ddct_bringup.scores.run_table import metric
from ddct_bringup.sweep.axis import value_text
from ddct_bringup.sweep.sweep import Sweep
from ddct_plant.program.table import PURE, Weight


def sweep_shown(sweep: Sweep, runs: Sequence[ScoredRow], metrics: Sequence[Metric]) -> Document:
    """Return the document of a sweep: controller, varied values, metrics and state of each run."""
    columns = [
        Column('controller', number=False, weight=Weight.IDENTIFYING),
        *(
            Column(axis.key, axis.unit or PURE, number=axis.numeric, weight=Weight.IDENTIFYING)
            for axis in sweep.axes
        ),
        *(Column(each.symbol, each.unit, each.form) for each in metrics),
        Column('state', number=False),
    ]
    rows = [
        (
            run.scores.controller,
            *(value_text(run.varied[axis.key]) for axis in sweep.axes),
            *(_figure(run, each) for each in metrics),
            run.scores.state,
        )
        for run in runs
    ]
    table = Table(f'{sweep.conditions}; {sweep.varied}', columns, rows)
    notes = [Note(text) for text in _invalid(runs)]
    return Document('Sweep', sweep.conditions, sweep.varied, [table, *notes])


def _figure(run: ScoredRow, of: Metric) -> Cell:
    """Return a metric of a run, or a dash with the reason."""
    column = metric(of)
    value = column.value(run.scores)
    if value is not None:
        return Cell(value)
    if not run.scores.valid:
        return Cell(None, reason=f'not valid: {run.scores.reason}')
    return Cell(None, reason=column.undefined(run.scores))


def _invalid(runs: Sequence[ScoredRow]) -> list[str]:
    """Return sentences on invalid runs with their values, as `wear_gain=0.7`."""
    failed: dict[str, list[str]] = {}
    for run in runs:
        if not run.scores.valid:
            reason = f'{run.scores.controller} is not valid: {run.scores.reason}'
            place = ', '.join(f'{key}={value_text(value)}' for key, value in run.varied.items())
            failed.setdefault(reason, []).append(place)
    return [f'{reason} (at {"; ".join(places)})' for reason, places in failed.items()]
