"""The table of verdicts: a criterion per row with its limit, a run per column."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ddct_bringup.report.runs import ReportRun
from ddct_bringup.report.typeset import number_text
from ddct_bringup.scores.scoring import NOT_COMPUTED
from ddct_bringup.verdict.criteria import CRITERIA, Criterion
from ddct_bringup.verdict.verdict import NO_LIMIT

NOT_JUDGED = 'the run failed or cannot be read'


@dataclass(frozen=True)
class VerdictCell:
    """A criterion of one run."""

    value: float | None
    text: str
    state: str
    """`within`, `beyond` or `no_limit`."""
    why_dash: str
    """Why there is no value, empty where there is one."""


@dataclass(frozen=True)
class VerdictRow:
    """A criterion over all runs."""

    criterion: Criterion
    limit: str
    """Empty where no limit applies."""
    source: str
    cells: tuple[VerdictCell, ...]

    @property
    def undefined(self) -> bool:
        """Whether a run that was judged has no value."""
        return any(cell.why_dash == self.criterion.undefined for cell in self.cells)


def verdict_rows(runs: Sequence[ReportRun]) -> list[VerdictRow]:
    """Return one row per criterion; a run that was not judged has a value in none."""
    judged = [{each['name']: each for each in run.entry['verdict']['criteria']} for run in runs]
    reasons = [run.entry.get(NOT_COMPUTED, {}) for run in runs]
    return [
        _row(
            criterion,
            [each.get(criterion.key) for each in judged],
            [each.get(criterion.key, criterion.undefined) for each in reasons],
        )
        for criterion in CRITERIA
    ]


def value_text(value: float | None) -> str:
    """Return four digits, and of values up to a million every digit before the point."""
    large = value is not None and 1e4 <= abs(value) < 1e6
    return number_text(value, '.0f' if large else '.4g')


def _row(
    criterion: Criterion, found: Sequence[dict[str, Any] | None], reasons: Sequence[str]
) -> VerdictRow:
    # All runs of a page are of one scenario, so one limit applies to all.
    limited = next((each for each in found if each and each['limit'] is not None), None)
    return VerdictRow(
        criterion=criterion,
        limit=value_text(limited['limit']) if limited else '',
        source=limited['source'] if limited else '',
        cells=tuple(_cell(*each) for each in zip(found, reasons, strict=True)),
    )


def _cell(found: dict[str, Any] | None, undefined: str) -> VerdictCell:
    if found is None:
        return VerdictCell(None, value_text(None), NO_LIMIT, NOT_JUDGED)
    value = found['value']
    why_dash = undefined if value is None else ''
    return VerdictCell(value, value_text(value), found['state'], why_dash)
