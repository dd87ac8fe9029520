"""The tables of docs/figures.md."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ddct_controllers.design.thesis_figures.thesis_figure import DrawnFigure


@dataclass(frozen=True)
class FigureTable:
    """A table of the documentation."""

    headers: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


def page_tables(
    drawn: Sequence[DrawnFigure], not_drawn: Mapping[str, str]
) -> dict[str, FigureTable]:
    """Return the tables by name."""
    rows = tuple((entry.figure.number, entry.figure.title, entry.remark) for entry in drawn)
    return {
        'drawn': FigureTable(('figure', 'shows', 'what agrees, what does not'), rows),
        'not_drawn': FigureTable(('figures', 'reason'), _by_reason(not_drawn)),
    }


def _by_reason(not_drawn: Mapping[str, str]) -> tuple[tuple[str, str], ...]:
    """Return the numbers that share a reason, and the reason."""
    shared: dict[str, list[str]] = {}
    for number, reason in not_drawn.items():
        shared.setdefault(reason, []).append(number)
    return tuple((', '.join(numbers), reason) for reason, numbers in shared.items())
