# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of scores on the page: comparison with Table 5.1, every metric, and the verdicts."""

from collections.abc import Sequence
from dataclasses import dataclass

from ddct_bringup.metrics.catalogue import CRITERIA
from ddct_bringup.report.page_parts import number_text, value_text
from ddct_bringup.scores.scored_recording import ScoredRecording
from ddct_bringup.thesis.predictions import predicted_range
from ddct_bringup.thesis.table_5_1 import PREDICTED, ThesisRow, is_thesis_run, thesis_row
from ddct_bringup.verdict.limits import TRACTION
from ddct_bringup.verdict.verdict import NO_LIMIT, CriterionResult
from ddct_plant.program.table import Quantity

_NO_PHASES = 'a log does not tell when the plates were locked'
OF_NO_LOG = {
    'time_to_lock': _NO_PHASES,
    'releases_after_lock': _NO_PHASES,
    'peak_temperature': 'a log has no temperature of the facing',
    'deadline_misses': 'a log has no steps of the controller',
    'friction_work_over_least': 'a log has no inertias of the car',
}
"""Reasons why no log of a car has a value, by criterion."""
NOT_JUDGED = 'the run failed or cannot be read'


@dataclass(frozen=True)
class Cell:
    """Metric of one run, with the value of the thesis where there is one."""

    value: float | None
    text: str
    share: float = 0.0
    """Length of the bar, 0 to 1."""
    thesis: float | None = None
    thesis_text: str = ''
    thesis_share: float = 0.0
    """Position of the thesis's value along the bar, 0 to 1."""
    difference: str = ''
    """Computed value minus the thesis's, signed."""
    spread: str = ''
    """Range over the admissible scenarios, for a predicted value."""
    verdict: str = ''
    """Hit or miss, for a predicted value of a valid run."""


def comparable_rows(runs: Sequence[ScoredRecording]) -> list[ThesisRow | None]:
    """Return for each run the row of Table 5.1 that it is comparable with."""
    return [
        thesis_row(run.scores.label)
        if run.settings is not None and is_thesis_run(run.settings)
        else None
        for run in runs
    ]


def metric_cells(
    column: Quantity, runs: Sequence[ScoredRecording], rows: Sequence[ThesisRow | None]
) -> list[Cell]:
    """Return one cell per run; bars have the scale of the largest value, computed or printed."""
    values = [run.scores.metrics[column.key] for run in runs]
    printed = [
        row if row is not None and column.key in row.printed_values() else None for row in rows
    ]
    of_thesis = [row.printed_values()[column.key] for row in printed if row is not None]
    largest = max(
        (abs(value) for value in (*values, *of_thesis) if value is not None), default=0.0
    )
    return [
        _cell(column, value, row, largest or 1.0, valid=run.scores.valid)
        for run, value, row in zip(runs, values, printed, strict=True)
    ]


def _cell(
    column: Quantity,
    value: float | None,
    row: ThesisRow | None,
    largest: float,
    *,
    valid: bool,
) -> Cell:
    text = number_text(value, column.form)
    share = 0.0 if value is None else abs(value) / largest
    if row is None:
        return Cell(value, text, share)
    thesis = row.printed_values()[column.key]
    predicted = row.use == PREDICTED
    return Cell(
        value,
        text,
        share,
        thesis,
        f'{thesis:.2f}',
        thesis / largest,
        '' if value is None else f'{100.0 * (value / thesis - 1.0):+.0f} %',
        predicted_range(row.controller, column.key) if predicted else '',
        row.verdict(column.key, value) if predicted and valid else '',
    )


@dataclass(frozen=True)
class VerdictCell:
    """Criterion of one run."""

    value: float | None
    text: str
    state: str
    """State of the criterion: `within`, `beyond`, `unavoidable` or `no_limit`."""
    floor: str
    """Least value that stands beside it, with its meaning; empty without one."""
    why_dash: str
    """Reason why there is no value, empty where there is one."""


@dataclass(frozen=True)
class VerdictRow:
    """One criterion, or the traction, for all runs."""

    criterion: Quantity
    limit: str
    """Limit as text, empty where none applies."""
    source: str
    convention: bool
    """Whether the limit is a convention rather than published."""
    cells: tuple[VerdictCell, ...]

    @property
    def reasons(self) -> str:
        """Reasons why judged runs have no value, empty where all have one."""
        found = dict.fromkeys(cell.why_dash for cell in self.cells)
        return '; '.join(each for each in found if each not in ('', NOT_JUDGED))


_TRACTION = Quantity(
    TRACTION,
    TRACTION,
    'm/s^2',
    '.4g',
    'largest driving force at the wheels over the mass of the car, beside what the driven axle '
    'can carry',
    'the plant is not known',
)


def verdict_rows(runs: Sequence[ScoredRecording]) -> list[VerdictRow]:
    """Return a row per criterion, then the traction; a run not judged has no values."""
    judged = [{each.name: each for each in run.scores.verdict.results} for run in runs]
    reasons = [{**(OF_NO_LOG if run.measured else {}), **run.scores.not_computed} for run in runs]
    return [
        _verdict_row(
            figure,
            [each.get(figure.key) for each in judged],
            [each.get(figure.key, figure.undefined) for each in reasons],
        )
        for figure in (*CRITERIA, _TRACTION)
    ]


def _verdict_row(
    criterion: Quantity, found: Sequence[CriterionResult | None], reasons: Sequence[str]
) -> VerdictRow:
    # All runs of a page have one scenario, so one limit applies to all.
    limited = next((each for each in found if each and each.limit is not None), None)
    return VerdictRow(
        criterion=criterion,
        limit=value_text(limited.limit) if limited else '',
        source=(limited.source or '') if limited else '',
        convention=bool(limited and limited.convention),
        cells=tuple(_verdict_cell(*each) for each in zip(found, reasons, strict=True)),
    )


def _verdict_cell(found: CriterionResult | None, undefined: str) -> VerdictCell:
    if found is None:
        return VerdictCell(None, value_text(None), NO_LIMIT, '', NOT_JUDGED)
    why_dash = undefined if found.value is None else ''
    text = value_text(found.value)
    return VerdictCell(found.value, text, found.state, _floor_text(found), why_dash)


def _floor_text(found: CriterionResult) -> str:
    """Return the least at any lock time where it exceeds the limit, else at that of the run."""
    if found.least_at_any_lock is not None:
        return f'least at all {value_text(found.least_at_any_lock)}'
    return '' if found.least is None else f'least {value_text(found.least)}'
