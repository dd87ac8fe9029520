"""The tables of scores on the page: Table 5.1 beside ours, and every metric."""

from collections.abc import Sequence
from dataclasses import dataclass

from ddct_bringup.report.runs import ReportRun
from ddct_bringup.report.typeset import number_text
from ddct_bringup.thesis.predictions import predicted_range
from ddct_bringup.thesis.table_5_1 import PREDICTED, ThesisRow, is_thesis_run, thesis_row
from ddct_plant.program.table import Figure


@dataclass(frozen=True)
class Cell:
    """A metric of one run, with the thesis's figure where it has one."""

    value: float | None
    text: str
    share: float = 0.0
    """Length of the bar, 0 to 1."""
    thesis: float | None = None
    thesis_text: str = ''
    thesis_share: float = 0.0
    """Where the thesis's figure is along the bar."""
    difference: str = ''
    """Ours against the thesis's, signed."""
    spread: str = ''
    """Range over the admissible scenarios, of a predicted figure."""
    verdict: str = ''
    """Hit or miss, of a predicted figure of a valid run."""


def comparable_rows(runs: Sequence[ReportRun]) -> list[ThesisRow | None]:
    """Return for each run the row of Table 5.1 beside which it may be set."""
    return [
        thesis_row(run.entry['controller'])
        if run.settings is not None and is_thesis_run(run.settings)
        else None
        for run in runs
    ]


def metric_cells(
    column: Figure, runs: Sequence[ReportRun], rows: Sequence[ThesisRow | None]
) -> list[Cell]:
    """Return one cell per run; bars share the scale of the largest figure, ours or printed."""
    values = [run.entry['metrics'][column.key] for run in runs]
    printed = [row if row is not None and column.key in row.figures() else None for row in rows]
    figures = [row.figures()[column.key] for row in printed if row is not None]
    largest = max((abs(value) for value in (*values, *figures) if value is not None), default=0.0)
    return [
        _cell(column, value, row, largest or 1.0, valid=run.entry['valid'])
        for run, value, row in zip(runs, values, printed, strict=True)
    ]


def _cell(
    column: Figure,
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
    thesis = row.figures()[column.key]
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
