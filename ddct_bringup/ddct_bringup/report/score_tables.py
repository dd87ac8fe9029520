# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of scores on the page: comparison with Table 5.1, figures, metrics, and limits."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from ddct_bringup.documents.page_parts import number_text, value_text
from ddct_bringup.metrics.catalogue import FIGURES, JERK_OVER_LEAST, METRICS, OTHERS, TABLE_5_1
from ddct_bringup.metrics.metric import Metric
from ddct_bringup.scores.scored_recording import ScoredRecording
from ddct_bringup.thesis.table_5_1 import PREDICTED, ThesisRow, is_thesis_run, thesis_row
from ddct_bringup.verdict.limits import LimitResult
from ddct_plant.program.table import Quantity

_OVER_LEAST = {
    'peak_jerk_over_least': 'peak_jerk_m_s3',
    'friction_work_over_least': 'friction_work_j',
}
"""Ratios to a least, each beside the figure that it is the ratio of."""
_PLACES = {each.key: place for place, each in enumerate(FIGURES)}


@dataclass(frozen=True)
class MetricCell:
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
    verdict: str = ''
    """Hit or miss, for a predicted value of a valid run."""
    why_dash: str = ''
    """Reason why there is no value, empty where there is one."""
    yardstick: str = ''
    """Why the least of a ratio is no bound for the run, in words after its name; else empty."""


def comparable_rows(runs: Sequence[ScoredRecording]) -> list[ThesisRow | None]:
    """Return for each run the row of Table 5.1 that it is comparable with."""
    return [
        thesis_row(run.scores.label)
        if run.settings is not None and is_thesis_run(run.settings)
        else None
        for run in runs
    ]


def metric_cells(
    column: Metric, runs: Sequence[ScoredRecording], rows: Sequence[ThesisRow | None]
) -> list[MetricCell]:
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
        _cell(column, run, row, largest or 1.0) for run, row in zip(runs, printed, strict=True)
    ]


def _cell(
    column: Metric, run: ScoredRecording, row: ThesisRow | None, largest: float
) -> MetricCell:
    scores = run.scores
    value = scores.metrics[column.key]
    cell = MetricCell(
        value,
        number_text(value, column.form),
        0.0 if value is None else abs(value) / largest,
        why_dash=scores.null_reasons.get(column.key, '') if value is None else '',
        yardstick=scores.outside if column is JERK_OVER_LEAST else '',
    )
    if row is None:
        return cell
    thesis = row.printed_values()[column.key]
    predicted = row.use == PREDICTED
    return replace(
        cell,
        thesis=thesis,
        thesis_text=f'{thesis:.2f}',
        thesis_share=thesis / largest,
        difference='' if value is None else f'{100.0 * (value / thesis - 1.0):+.0f} %',
        verdict=row.verdict(column.key, value) if predicted and scores.valid else '',
    )


@dataclass(frozen=True)
class MetricColumn:
    """One metric of all runs."""

    metric: Metric
    cells: tuple[MetricCell, ...]
    reasons: str
    """Reasons why valid runs have no value, empty where all have one."""


def table_5_1_columns(
    runs: Sequence[ScoredRecording], rows: Sequence[ThesisRow | None]
) -> list[MetricColumn]:
    """
    Return the columns of Table 5.1 for a page with comparable runs, or with no clutch that locks.

    None for any other page: the time of the final lock is there in place of t_a.
    """
    sticking = any(run.recording and run.recording.trajectory.phase_events for run in runs)
    return [_column(each, runs, rows) for each in TABLE_5_1 if any(rows) or not sticking]


def figure_columns(runs: Sequence[ScoredRecording]) -> list[MetricColumn]:
    """Return the figures that these runs are judged by, each ratio beside its figure."""
    ordered = sorted(FIGURES, key=lambda each: _PLACES[_OVER_LEAST.get(each.key, each.key)])
    return [_column(each, runs) for each in ordered if _has(each, runs)]


def other_columns(
    runs: Sequence[ScoredRecording], shown: Sequence[MetricColumn]
) -> list[MetricColumn]:
    """Return the metrics that are neither `shown` elsewhere nor update times."""
    elsewhere = {each.metric.key for each in shown}
    return [
        _column(each, runs)
        for each in OTHERS
        if each.key not in elsewhere and not each.from_timing and _has(each, runs)
    ]


def _has(metric: Metric, runs: Sequence[ScoredRecording]) -> bool:
    """Return whether the runs are of a kind that can have a metric."""
    return not metric.of_shift or any(run.scores.is_shift for run in runs)


def _column(
    metric: Metric,
    runs: Sequence[ScoredRecording],
    rows: Sequence[ThesisRow | None] | None = None,
) -> MetricColumn:
    cells = metric_cells(metric, runs, rows or [None] * len(runs))
    return MetricColumn(metric, tuple(cells), _reasons(cells, runs))


def _reasons(cells: 'Sequence[MetricCell | LimitCell]', runs: Sequence[ScoredRecording]) -> str:
    of_valid = (cell.why_dash for cell, run in zip(cells, runs, strict=True) if run.scores.valid)
    return '; '.join(dict.fromkeys(filter(None, of_valid)))


@dataclass(frozen=True)
class LimitCell:
    """A limited metric of one run."""

    value: float | None
    text: str
    beyond: bool
    """Whether its magnitude is larger than the limit."""
    why_dash: str
    """Reason why there is no value, empty where there is one."""


@dataclass(frozen=True)
class LimitColumn:
    """One metric that has a limit, for all runs."""

    metric: Quantity
    limit: str
    source: str
    convention: bool
    """Whether the limit is a convention rather than published."""
    cells: tuple[LimitCell, ...]
    reasons: str
    """Reasons why valid runs have no value, empty where all have one."""


def limit_columns(runs: Sequence[ScoredRecording]) -> list[LimitColumn]:
    """Return a column for each metric that has a limit, in the order of `scores.json`."""
    # All runs of a page have one scenario, so one limit applies to all; a log has no traction.
    found = {each.name: each for run in runs for each in run.scores.limits}
    return [_limit_column(found[key], runs) for key in METRICS if key in found]


def _limit_column(limit: LimitResult, runs: Sequence[ScoredRecording]) -> LimitColumn:
    cells = [_limit_cell(limit, run) for run in runs]
    return LimitColumn(
        metric=METRICS[limit.name],
        limit=value_text(limit.limit),
        source=limit.source,
        convention=limit.convention,
        cells=tuple(cells),
        reasons=_reasons(cells, runs),
    )


def _limit_cell(limit: LimitResult, run: ScoredRecording) -> LimitCell:
    value = run.scores.metrics[limit.name]
    if value is None:
        return LimitCell(
            None, value_text(None), False, run.scores.null_reasons.get(limit.name, '')
        )
    return LimitCell(value, value_text(value), abs(value) > limit.limit, '')
