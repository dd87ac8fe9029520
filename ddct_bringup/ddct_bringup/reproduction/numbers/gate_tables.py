"""The gate's rows as tables of text, the same for the terminal and the page of documentation."""

from collections import Counter, defaultdict
from collections.abc import Sequence

from ddct_bringup.reproduction.numbers.gate import OUTCOMES, GateRow
from ddct_bringup.reproduction.numbers.groups import fact_outcome
from ddct_bringup.reproduction.numbers.thesis_number import ERRATUM, Finding, Value, is_number
from ddct_plant.models.printed import PrintedNumber
from ddct_plant.program.table import Table

_CHAPTERS = ('1', '2', '3', '4', '5', '6')
_HEADERS = ('section', 'item', 'printed', 'computed', 'unit', 'tolerance', 'verdict')


def summary_table(rows: Sequence[GateRow]) -> Table:
    """Return how many numbers of each chapter have each verdict."""
    counts = Counter((_chapter(row), row.outcome) for row in rows)
    totals = Counter(row.outcome for row in rows)
    lines = [
        (chapter, *(str(counts[chapter, outcome]) for outcome in OUTCOMES))
        for chapter in _CHAPTERS
    ]
    total = ('all', *(str(totals[outcome]) for outcome in OUTCOMES))
    return Table('Printed numbers by verdict', ('chapter', *OUTCOMES), [*lines, total])


def facts_table(rows: Sequence[GateRow]) -> Table:
    """Return how many distinct facts the numbers are, by what each comes to."""
    numbers, facts = Counter(row.outcome for row in rows), count_facts(rows)
    lines = [(outcome, str(numbers[outcome]), str(facts[outcome])) for outcome in OUTCOMES]
    total = ('all', str(len(rows)), str(facts.total()))
    headers = ('verdict', 'entries', 'distinct facts')
    return Table('Entries and distinct facts', headers, [*lines, total])


def count_facts(rows: Sequence[GateRow]) -> Counter[str]:
    """Return the number of groups by outcome; a group with one miss is a miss."""
    outcomes: dict[str, list[str]] = defaultdict(list)
    for row in rows:
        outcomes[row.number.fact].append(row.outcome)
    return Counter(fact_outcome(found) for found in outcomes.values())


def errata_table(rows: Sequence[GateRow]) -> Table:
    """Return the errata with their reasons."""
    lines = [
        (
            row.number.section,
            row.number.item,
            row.number.printed,
            computed_text(row),
            row.number.unit,
            row.number.group or '-',
            row.number.reason,
        )
        for row in rows
        if row.number.verdict == ERRATUM
    ]
    headers = ('section', 'item', 'printed', 'computed', 'unit', 'group', 'what is wrong')
    return Table('Errata of the thesis', headers, lines)


def chapter_tables(rows: Sequence[GateRow], *, reasons: bool) -> dict[str, Table]:
    """Return one table per chapter by the name `chapter_N`, with groups and reasons if asked."""
    headers = (*_HEADERS, 'group', 'reason') if reasons else _HEADERS
    return {
        f'chapter_{chapter}': Table(
            f'Chapter {chapter}',
            headers,
            [_line(row, reasons) for row in rows if _chapter(row) == chapter],
        )
        for chapter in _CHAPTERS
    }


def page_tables(rows: Sequence[GateRow]) -> dict[str, Table]:
    """Return every table of the documentation page by name."""
    return {
        'facts': facts_table(rows),
        'summary': summary_table(rows),
        'errata': errata_table(rows),
        **chapter_tables(rows, reasons=True),
    }


def computed_text(row: GateRow) -> str:
    """Return the computed value, a number with one digit more than is printed; - without one."""
    value: Value | None = row.computed
    if isinstance(value, Finding):
        return value.figures
    if value is None or isinstance(value, str):
        return value or '-'
    if not row.hit and row.number.verdict != ERRATUM:
        return f'{value:.5g}'
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
        row.outcome,
    )
    return (*cells, number.group or '-', number.reason) if reasons else cells


def _chapter(row: GateRow) -> str:
    return row.number.section[:1]
