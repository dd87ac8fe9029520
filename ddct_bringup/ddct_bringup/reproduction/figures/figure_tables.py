"""The tables of docs/figures.md."""

from collections.abc import Mapping, Sequence

from ddct_bringup.reproduction.figures.thesis_figure import DrawnFigure
from ddct_plant.program.table import Table


def page_tables(drawn: Sequence[DrawnFigure], not_drawn: Mapping[str, str]) -> dict[str, Table]:
    """Return the tables by name."""
    rows = [(entry.figure.number, entry.figure.title, entry.remark) for entry in drawn]
    headers = ('figure', 'shows', 'what agrees, what does not')
    return {
        'drawn': Table('Figures that are drawn', headers, rows),
        'not_drawn': Table(
            'Figures that are not drawn', ('figures', 'reason'), _by_reason(not_drawn)
        ),
    }


def _by_reason(not_drawn: Mapping[str, str]) -> tuple[tuple[str, str], ...]:
    """Return the numbers that share a reason, and the reason."""
    shared: dict[str, list[str]] = {}
    for number, reason in not_drawn.items():
        shared.setdefault(reason, []).append(number)
    return tuple((', '.join(numbers), reason) for reason, numbers in shared.items())
