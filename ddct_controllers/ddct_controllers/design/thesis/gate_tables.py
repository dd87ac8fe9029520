"""The gate's rows as tables of text, the same for the terminal and the page of documentation."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from ddct_controllers.design.thesis.gate import GateRow
from ddct_controllers.design.thesis.thesis_number import ERRATUM, VERDICTS, Value, is_number
from ddct_plant.printed import PrintedNumber

_CHAPTERS = ('1', '2', '3', '4', '5')
_HEADERS = ('section', 'item', 'printed', 'computed', 'unit', 'tolerance', 'verdict')


@dataclass(frozen=True)
class GateTable:
    """Rows of text, one cell per header."""

    title: str
    headers: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]


def summary_table(rows: Sequence[GateRow]) -> GateTable:
    """Return how many numbers of each chapter have each verdict."""
    counts = Counter((_chapter(row), row.number.verdict) for row in rows)
    totals = Counter(row.number.verdict for row in rows)
    lines = [
        (chapter, *(str(counts[chapter, verdict]) for verdict in VERDICTS))
        for chapter in _CHAPTERS
    ]
    total = ('all', *(str(totals[verdict]) for verdict in VERDICTS))
    return GateTable('Printed numbers by verdict', ('chapter', *VERDICTS), [*lines, total])


def errata_table(rows: Sequence[GateRow]) -> GateTable:
    """Return the errata with their reasons."""
    lines = [
        (
            row.number.section,
            row.number.item,
            row.number.printed,
            computed_text(row),
            row.number.unit,
            row.number.reason,
        )
        for row in rows
        if row.number.verdict == ERRATUM
    ]
    headers = ('section', 'item', 'printed', 'computed', 'unit', 'what is wrong')
    return GateTable('Errata of the thesis', headers, lines)


def chapter_tables(rows: Sequence[GateRow], *, reasons: bool) -> dict[str, GateTable]:
    """Return one table per chapter by the name `chapter_N`, with the reasons if asked for."""
    headers = (*_HEADERS, 'reason') if reasons else _HEADERS
    return {
        f'chapter_{chapter}': GateTable(
            f'Chapter {chapter}',
            headers,
            [_line(row, reasons) for row in rows if _chapter(row) == chapter],
        )
        for chapter in _CHAPTERS
    }


def page_tables(rows: Sequence[GateRow]) -> dict[str, GateTable]:
    """Return every table of the documentation page by name."""
    return {
        'summary': summary_table(rows),
        'errata': errata_table(rows),
        **chapter_tables(rows, reasons=True),
    }


def computed_text(row: GateRow) -> str:
    """Return the computed value, a number with one digit more than is printed; - without one."""
    value: Value | None = row.computed
    if value is None or isinstance(value, str):
        return value or '-'
    stated = [text for text in (row.number.printed, row.number.ours) if text and is_number(text)]
    digits = [PrintedNumber('', text).half_unit for text in stated]
    return _rounded(value, min(digits) / 5.0)


def _rounded(value: float, unit: float) -> str:
    """Return the value rounded to a power of ten, without needless zeros."""
    return f'{round(value / unit) * unit:.7g}'


def _line(row: GateRow, reasons: bool) -> tuple[str, ...]:
    number = row.number
    tolerance = number.absolute_tolerance
    cells = (
        number.section,
        number.item,
        number.printed,
        computed_text(row),
        number.unit,
        '-' if tolerance is None else f'{tolerance:.3g}',
        number.verdict,
    )
    return (*cells, number.reason) if reasons else cells


def _chapter(row: GateRow) -> str:
    return row.number.section[:1]
